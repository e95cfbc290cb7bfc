"""What streamlines add up to in the voxels of a grid.

It knows nothing of drawing. Start with ``volume.py``.
"""
