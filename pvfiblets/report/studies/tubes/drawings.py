"""The methods of drawing spline tubes that their study compares: each draws a picture and returns the visible tubes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

import numpy as np
import numpy.typing as npt

from pvfiblets.tubes import SplineTubes

from ...cameras import Camera
from ...drawing import data_bytes
from ...timing import Turns, turns_of
from .pictures import reversed_depth_of
from .tessellated import TessellatedTubes

if TYPE_CHECKING:
    import moderngl

SIDES = ((6, 6), (12, 12), (30, 30), (6, 30))

VisibleDepths = tuple[npt.NDArray[np.float64], npt.NDArray[np.bool_]]


class Drawing(Protocol):
    """One method of drawing one set of tubes."""

    method: str
    setting: str
    ours: bool
    default: bool
    nbytes: int

    @property
    def turns(self) -> Turns:
        """Calls that take turns, timed by the clock that measures its frames."""
        ...

    def draw(self, camera: Camera) -> None:
        """Draw a picture and wait for it."""
        ...

    def visible(self, camera: Camera) -> VisibleDepths:
        """Return mm in front of the eye, ``(n,)``, of the last picture's pixels, and which of them show a tube."""
        ...

    def release(self) -> None:
        """Give everything back."""
        ...


class CastTubes:
    """Ray casting, as this program has it, by one solver, of tubes that are not widened."""

    method = "ray cast"

    def __init__(self, ctx: moderngl.Context, tubes: SplineTubes, solver: str = "auto") -> None:
        from pvfiblets.engine.tubes import TubeRenderer

        self._ctx, self._renderer = ctx, TubeRenderer(ctx, tubes, solver=solver)
        self.setting = self._renderer.solver
        self.ours = self.setting != "bisection"
        self.default = solver == "auto"
        self.nbytes = data_bytes(self._renderer.explain())

    @property
    def turns(self) -> Turns:
        """Calls that take turns, timed by the context's clock."""
        return turns_of(self._ctx)

    def draw(self, camera: Camera) -> None:
        """Draw a G-buffer, if the camera is not that of the last one."""
        from pvfiblets.engine import View
        from pvfiblets.engine.tubes import TubeStyle

        self._gbuffer = self._renderer.render(View(camera.size, camera.model_view_projection), TubeStyle(min_width=0.0))
        self._ctx.finish()

    def visible(self, camera: Camera) -> VisibleDepths:
        """Return what the G-buffer's keys mean."""
        from pvfiblets.engine.gbuffer import EMPTY

        keys = np.frombuffer(self._gbuffer.depth.read(), np.uint32)
        return camera.distance(reversed_depth_of(keys)), keys != EMPTY

    def release(self) -> None:
        """Give everything back."""
        self._renderer.release()


class MeshedTubes:
    """Hardware tessellation with so many sides at least and at most."""

    method, ours, default = "tessellated", False, False

    def __init__(
        self, ctx: moderngl.Context, tubes: SplineTubes, size: tuple[int, int], sides: tuple[int, int]
    ) -> None:
        self._ctx, self._tubes = ctx, TessellatedTubes(ctx, tubes, size, sides=sides)
        self.setting = f"{sides[0]} sides" if sides[0] == sides[1] else f"{sides[0]} to {sides[1]} sides by size"
        self.nbytes = self._tubes.nbytes

    @property
    def turns(self) -> Turns:
        """Calls that take turns, timed by the context's clock."""
        return turns_of(self._ctx)

    def draw(self, camera: Camera) -> None:
        """Draw it, whatever was drawn last."""
        self._tubes.render(camera.model_view_projection)
        self._ctx.finish()

    def visible(self, camera: Camera) -> VisibleDepths:
        """Return what the depth buffer means."""
        depth = self._tubes.depth().ravel()
        return camera.distance(1.0 - depth), depth < 1.0

    def release(self) -> None:
        """Give everything back."""
        self._tubes.release()


def drawings(ctx: moderngl.Context, tubes: SplineTubes, size: tuple[int, int]) -> list[Callable[[], Drawing]]:
    """Return what makes each method, the program's default first."""
    from pvfiblets.engine.tubes import SOLVERS

    default, *others = SOLVERS

    def cast(solver: str) -> Callable[[], Drawing]:
        return lambda: CastTubes(ctx, tubes, "auto" if solver == default else solver)

    def meshed(sides: tuple[int, int]) -> Callable[[], Drawing]:
        return lambda: MeshedTubes(ctx, tubes, size, sides)

    return [cast(default), *map(meshed, SIDES), *map(cast, others)]
