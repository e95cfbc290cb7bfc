"""The region of a view, by which everything that the engine draws is cut."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import moderngl

    from ..gl.moderngl_extras import GLExtras
    from ..gl.shaders import Programs
    from ..view import View
    from .ray_intervals import RegionIntervals

Array = npt.NDArray[np.float64]
Place = tuple[Array, Array, int]  # origin of a lattice and mm per integer, `(3,)` float64, and the largest integer


class RegionCut:
    """Where a view's region begins and ends along rays (:mod:`.ray_intervals`); `place` is the data's lattice.

    Nothing is on the GPU, and nothing imported, while views have no region.
    """

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs, place: Place) -> None:
        self._made_of, self._place = (ctx, gl, programs), place
        self._cutter: RegionIntervals | None = None

    def update(self, view: View) -> list[str]:
        """Bring the boundaries up to date and return the features of programs that look at them."""
        if view.region is None:
            self.release()
            return []
        if self._cutter is None:
            from .ray_intervals import RegionIntervals

            self._cutter = RegionIntervals(*self._made_of)
        self._cutter.prepare(view, *self._place)
        return self.features

    @property
    def features(self) -> list[str]:
        """Features of programs that look at the boundaries."""
        return [] if self._cutter is None else ["CLIP_REGION"]

    def bind(self, program: Any) -> None:
        """Bind what a program looks at and tell it where that is."""
        if self._cutter is not None:
            self._cutter.bind(program)

    @property
    def sizes(self) -> dict[str, int]:
        """Bytes on the GPU, by name."""
        return {} if self._cutter is None else {"region": self._cutter.nbytes}

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        if self._cutter is not None:
            self._cutter.release()
            self._cutter = None
