"""A frame of a render window: its renderers, cameras and contexts, and the views and samples that it still needs.

It knows no drawable. Start with ``scene.py`` and ``windows.py``.
"""
