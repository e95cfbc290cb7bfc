"""Helpers of every room: memory, files that appear whole, progress, lazy imports, ragged arrays.

It knows nothing of streamlines, compression or drawing, and imports nothing else of the package.
"""
