"""Selecting streamlines: by regions they pass, end or stay in, by an area of the screen, or by similar ends.

``query/regions`` defines regions. Start with ``predicates.py`` and ``passing.py``.
"""
