"""Settings of actors, and the arguments of ``add_...``: declared once, for properties, arguments, docs and pages.

They know no actor. Start with ``settings.py``.
"""
