"""VTK files of poly data, legacy and XML: their sizes are checked before memory is spent.

Start with ``legacy.py`` and ``vtp.py``.
"""
