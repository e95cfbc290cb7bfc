"""Colours and opacities of lines by numbers: arrays by name, look-up tables, and labels of scalar bars.

It draws nothing. Start with ``scalars.py``.
"""
