"""The scene of one session: a document, and the plotter that is kept in step with it.

It knows nothing of pages and browsers. Start with ``scene.py``, then ``layers.py``.
"""
