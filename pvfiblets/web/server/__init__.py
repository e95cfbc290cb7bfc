"""The front server: the public port, access control, and one process for each session.

It knows nothing of scenes, VTK or trame. Start with ``front.py``, then ``launcher.py`` and ``relay.py``.
"""
