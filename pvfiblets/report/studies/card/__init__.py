"""The check of a graphics card, behind ``pvfiblets gl --check``: does it draw right, and how fast.

Every part runs in a process of its own. Start with ``check.py``.
"""
