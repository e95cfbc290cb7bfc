"""Coding and decoding by NumPy alone, in the arithmetic of the kernels: for sets too small to load a compiler for.

Start with ``array_coder.py``; who calls which is decided in ``codec/small_sets.py``.
"""
