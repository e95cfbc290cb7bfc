"""Sessions: a document of immutable values, its history, its files, and its script.

It knows nothing of browsers, and nothing of VTK. Start with ``document.py``.
"""
