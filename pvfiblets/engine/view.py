"""What is drawn from where (`View`) and how (`Style`): small frozen values that a redraw is decided on."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

__all__ = ["Style", "View"]


@dataclass(frozen=True, eq=False)
class View:
    """A picture's size and camera.

    Parameters
    ----------
    size : tuple of int
        Width and height in pixels, each at least 1.
    model_view_projection : array_like
        ``(4, 4)`` float64: data coordinates in mm (column vectors) to OpenGL clip coordinates. Perspective or
        parallel; any actor placement belongs in it.

    Raises
    ------
    ValueError
        If the size is not positive, or the matrix is not 4 x 4 and finite.
    """

    size: tuple[int, int]
    model_view_projection: npt.NDArray[np.float64]
    _key: tuple[int, int, bytes] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        width, height = (int(n) for n in self.size)
        if width < 1 or height < 1:
            raise ValueError(f"size is {self.size}; give a width and a height of at least one pixel")
        matrix = np.array(self.model_view_projection, np.float64)
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
            raise ValueError(f"model_view_projection must be a finite (4, 4) matrix, got {matrix.tolist()}")
        matrix.flags.writeable = False
        object.__setattr__(self, "size", (width, height))
        object.__setattr__(self, "model_view_projection", matrix)
        object.__setattr__(self, "_key", (width, height, matrix.tobytes()))

    def __eq__(self, other: object) -> bool:
        return self._key == other._key if isinstance(other, View) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key)


@dataclass(frozen=True)
class Style:
    """How fiblets become pixels.

    Parameters
    ----------
    line_width : float
        Pixels, at least 1. Exactly 1 draws thin lines as OpenGL does; more draws round brushes of that diameter.
    values : str, optional
        The per-point value to write beside each pixel: ``'curvature'`` (1/mm), ``'arc_length'`` (mm from the
        streamline's first point), or the name of an array in ``FibletSet.per_point``. None costs nothing.

    Raises
    ------
    ValueError
        If the line width is below 1 or not finite.
    """

    line_width: float = 1.0
    values: str | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.line_width) and self.line_width >= 1.0):
            raise ValueError(f"line_width is {self.line_width}; give a finite number of pixels, 1 or more")
