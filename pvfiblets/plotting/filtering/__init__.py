"""Lines that a user chose: filtered, cut, selected, and the regions that cut them.

It draws nothing: the engine gets masks and bits. Start with ``filtering.py``.
"""
