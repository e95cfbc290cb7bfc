"""Tabs on the right of the page: for each, its widgets and the actions of its controls.

They change the scene through its methods only. Start with ``tabs.py``, then ``clip_tab.py``.
"""
