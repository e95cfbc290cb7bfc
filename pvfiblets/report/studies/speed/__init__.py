"""The studies of speed: frames of every drawable on a bare context, lines in windows beside VTK's, reading of files.

They need moderngl, NumPy and numba; what needs more is left out where it is missing. Start with :mod:`.cells`.
"""
