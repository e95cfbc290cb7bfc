"""Spline tubes: tubes of varying radius around Hermite splines (Russig et al. 2020). NumPy; no OpenGL, no VTK."""

from __future__ import annotations

from .build import as_spline_tubes
from .tubes import NodeValues, SplineTubes

__all__ = ["NodeValues", "SplineTubes", "as_spline_tubes"]
