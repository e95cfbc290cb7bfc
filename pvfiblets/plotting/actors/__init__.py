"""What the actors of all drawables share: life, place, colours, shading, and attributes of PyVista scripts.

It names no drawable. Start with ``registry.py``, then ``coloured.py``.
"""
