"""The front server: the public port, who may ask for what, and one process for each session.

It knows nothing of scenes, VTK or trame. Start with ``front.py``, then ``launcher.py`` and ``relay.py``.
"""
