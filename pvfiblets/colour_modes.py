"""The colour modes of lines: one name for Python, GLSL, pages and TypeScript.

A mode is a `ColourMode` of `MODES` and a file of ``shaders/colour`` that has ``line_colour()``. The resolve, the sums
of all lines of a pixel and pages include that file; `ColourMode.of_directions` is the same in NumPy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True)
class ColourMode:
    """The source of lines' colours."""

    name: str  # of `pvfiblets.mappers.Colouring.mode`
    doc: str
    # the things that have a number or a colour each; `''` where colours need none
    numbers: Literal["", "lines", "points", "pixels"] = ""
    table: bool = False  # whether a look-up table maps numbers
    # texture of the G-buffer that holds the number or the colour of a pixel
    reads: Literal["", "position", "colours"] = ""
    # file of `shaders/colour`; `name` by default. Colours of lines are mapped on the CPU, so their modes share one.
    shader: str = ""
    # `(n, 3)` unit vectors to `(n, 3)` colours from 0 to 1. `scalars` then takes `name`.
    of_directions: Callable[[npt.NDArray[Any]], npt.NDArray[Any]] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "shader", self.shader or self.name)

    @property
    def feature(self) -> str:
        """Switch of shaders."""
        return f"COLOUR_{self.shader.upper()}"


_ALL = (
    ColourMode("orientation", "the absolute tangent in data coordinates as RGB", of_directions=np.abs),
    ColourMode("solid", "one colour for all lines"),
    ColourMode("streamline_rgba", "an RGB or RGBA colour per line", "lines"),
    ColourMode("streamline_scalar", "a number per line through a table", "lines", table=True, shader="streamline_rgba"),
    ColourMode("point_scalar", "a number per point through a table", "points", table=True, reads="position"),
    ColourMode("point_rgba", "an RGBA colour per point, of tubes and halos", "points", reads="colours"),
    ColourMode("point_packed", "an RGB or RGBA colour per point, of fiblets", "points", reads="position"),
    ColourMode("pixel_count", "the lines of a pixel through a table", "pixels", table=True, shader="point_scalar"),
)

MODES = {mode.name: mode for mode in _ALL}  # every mode by its name

SHADERS = {mode.shader: MODES[mode.shader] for mode in _ALL}  # modes that have a file of shaders


def glsl_source() -> str:
    """Return ``colour/line_colour.glsl``, which includes the file of the mode of fiblets that is switched on."""
    return "".join(
        f'#if FEATURE_{mode.feature}\n#include "colour/{mode.name}.glsl"\n#endif\n'
        for mode in SHADERS.values()
        if mode.reads != "colours"
    )
