"""Connectomes: the strength of connections between an atlas's parcels, and the parcels of streamlines.

Start with ``matrix.py``.
"""
