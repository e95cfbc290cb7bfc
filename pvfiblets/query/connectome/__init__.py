"""How strongly the parcels of an atlas are connected, and which parcels streamlines connect.

Start with ``matrix.py``.
"""
