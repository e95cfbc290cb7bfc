"""Streamlines to fiblets: resampled, ordered, cut, coded and laid out in records.

It reads no files and decodes nothing. Start with ``compress.py``, then ``encode.py``.
"""
