"""Numbers of streamlines and of their points: measures, tables, profiles, and values of images.

It knows nothing of drawing. Start with ``measures.py``.
"""
