"""``.fiblets`` files: written, opened, converted to, and checked.

Other formats are in ``pvfiblets/formats``. Start with ``fiblets_file.py``.
"""
