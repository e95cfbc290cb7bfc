"""Which streamlines: those that pass, end or stay in regions, lie under an area of the screen, or end like others.

What a region is is said in ``query/regions``. Start with ``predicates.py`` and ``passing.py``.
"""
