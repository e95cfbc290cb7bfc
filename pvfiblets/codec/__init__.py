"""The codec: streamlines to fiblets and back. NumPy and compiled kernels; no OpenGL, no VTK."""
