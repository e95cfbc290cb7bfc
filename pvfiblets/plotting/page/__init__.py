"""A plotter as a page that draws in the browser: its surfaces, cuts and values as `pvfiblets.page` has them.

It writes no HTML. Start with ``page_scene.py``.
"""
