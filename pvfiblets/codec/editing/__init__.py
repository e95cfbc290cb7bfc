"""Sets made of sets: parts, joined parts, copies, and values added to points. Records are copied, not coded again.

It reads and writes no files. Start with ``restrict.py``.
"""
