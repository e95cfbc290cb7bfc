"""Graphics cards: do they draw right, and how fast (``pvfiblets gl --check``); the first minutes of one (``study.py``).

Every part runs in a process of its own. Start with ``check.py``.
"""
