"""Files of a scene: which of them may be opened, their kinds, and layers read from them.

It makes no actors. Start with ``loading.py``.
"""
