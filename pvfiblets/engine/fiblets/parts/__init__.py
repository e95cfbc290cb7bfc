"""Sets drawn part by part: streamed to the GPU, shard by shard, or by the workers of a cluster.

How a part is drawn is the renderer's. Start with ``parts.py`` and ``streamed_renderer.py``.
"""
