"""Images of a scene on slices: their panes, labels and glyphs, and regions that are painted on them.

It builds no page. Start with ``slicing.py``.
"""
