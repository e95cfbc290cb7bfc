"""Regions that are painted voxel by voxel, and which streamlines pass them, told while they are painted."""
