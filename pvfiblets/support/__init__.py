"""What every room uses and no room is about: memory, files that appear whole, progress, lazy imports, ragged arrays.

It knows nothing of streamlines, compression or drawing, and imports nothing else of the package.
"""
