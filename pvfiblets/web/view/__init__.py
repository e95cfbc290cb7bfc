"""The picture on the page: how it is streamed or drawn in the browser, how coarse, and what touches do to it.

It knows nothing of panels. Start with ``stream.py``.
"""
