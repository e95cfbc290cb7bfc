"""Spline tubes: tubes of varying radius around Hermite splines (Russig et al. 2020). NumPy; no OpenGL, no VTK."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..support.lazy_imports import names_from

if TYPE_CHECKING:
    from .build import as_spline_tubes
    from .spline_tubes import NodeValues, SplineTubes

__all__ = ["NodeValues", "SplineTubes", "as_spline_tubes"]

_HOME = {"NodeValues": "spline_tubes", "SplineTubes": "spline_tubes", "as_spline_tubes": "build"}

__getattr__, __dir__ = names_from(__name__, _HOME)
