"""All lines of a pixel, not only the nearest: sums of them, and layers behind the nearest.

It knows nothing of what sums are shown for. Start with ``lines_behind.py``.
"""
