"""Files of the page: opened, uploaded, exported, and sessions.

What a file holds is read by the scene. Start with ``opening.py``.
"""
