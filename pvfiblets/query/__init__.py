"""Questions asked of positions and of compressed streamlines: which lie where, how near, how long. No GL, no VTK."""
