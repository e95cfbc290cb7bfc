"""Effects on lines, as pieces of the resolve with textures and uniforms: shading, density, tubes, highlights.

They know no actor. Start with ``shader_effects.py``, then ``shading.py``.
"""
