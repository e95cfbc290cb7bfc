"""Where a region begins and ends along rays through a volume: what ``shaders/volumes/parts.glsl`` reads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import moderngl

    from ...volumes.volume import RaycastVolume
    from ..gl.moderngl_extras import GLExtras
    from ..gl.shaders import Programs
    from ..regions.ray_intervals import RegionIntervals
    from ..view import View

__all__ = ["VolumeRegionIntervals"]

TOP = 1 << 16
"""Steps of the lattice over the volume's bounds of which one point is the origin of local coordinates."""


class VolumeRegionIntervals:
    """The boundaries of a view's region, which fiblets are cut by, too (:mod:`pvfiblets.engine.regions.ray_intervals`).

    Nothing is on the GPU, and nothing imported, while views have no region.

    Parameters
    ----------
    ctx : moderngl.Context
    gl : GLExtras
    programs : Programs
    volume : RaycastVolume
    """

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs, volume: RaycastVolume) -> None:
        self._made_of = ctx, gl, programs
        self._cutter: RegionIntervals | None = None
        bounds = np.array(volume.bounds).reshape(3, 2)
        self._origin, self._scale = bounds[:, 0], np.ptp(bounds, axis=1) / TOP

    def update(self, view: View) -> list[str]:
        """Bring the boundaries up to date and return the features of programs that look at them."""
        if view.region is None:
            self.release()
            return []
        if self._cutter is None:
            from ..regions.ray_intervals import RegionIntervals

            self._cutter = RegionIntervals(*self._made_of)
        self._cutter.prepare(view, self._origin, self._scale, TOP)
        return ["CLIP_REGION"]

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
