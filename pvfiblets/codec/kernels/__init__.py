"""The codec's compiled kernels, and the distance of points from lines.

They know arrays only; ``codec/layout.py`` explains fiblets. Start with ``direction_kernels.py``.
"""
