"""Coding and decoding by NumPy alone, in the arithmetic of the kernels: for sets too small to load a compiler for.

Start with ``array_coder.py``; ``codec/small_sets.py`` decides which sets are coded here.
"""
