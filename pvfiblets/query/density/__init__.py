"""Density maps: sums of streamlines in the voxels of a grid.

It knows nothing of drawing. Start with ``volume.py``.
"""
