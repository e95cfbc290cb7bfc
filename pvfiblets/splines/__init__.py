"""Spline tubes: tubes of varying radius around Hermite splines (Russig et al. 2020). NumPy; no OpenGL, no VTK."""
