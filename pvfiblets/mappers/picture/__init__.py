"""Effects on the finished image of a renderer: depth of field, tones and antialiasing.

They see pixels, not lines. Start with ``picture.py``.
"""
