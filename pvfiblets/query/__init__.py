"""Spatial queries of positions and of compressed streamlines: inside, distance, length. No OpenGL, no VTK."""
