"""Regions of space: shapes, surfaces and labels, joined by words, and what of a segment lies in them.

They know positions only, no streamlines. Start with ``region.py``.
"""
