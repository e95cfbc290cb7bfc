"""The codec's compiled kernels, and the distance of points from lines.

They know arrays only; what fiblets mean is said in ``codec/reference.py``. Start with ``direction_kernels.py``.
"""
