"""OpenGL itself: contexts, capabilities, shaders, bindings, uniform blocks, passes and queries.

It knows nothing of fiblets, tubes, halos or volumes. Start with ``shaders.py`` and ``bindings.py``.
"""
