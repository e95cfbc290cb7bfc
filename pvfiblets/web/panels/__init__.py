"""What surrounds the picture: bar, layers, tabs and dialogs, and what their controls do.

It knows nothing of connections and processes. Start with ``layout.py`` and ``tabs.py``.
"""
