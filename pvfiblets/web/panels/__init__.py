"""Panels around the picture: bar, layers, tabs and dialogs, with the actions of their controls.

It knows nothing of connections and processes. Start with ``layout.py`` and ``tabs.py``.
"""
