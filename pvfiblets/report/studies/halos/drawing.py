"""Two methods of drawing halos on a bare context: strips around lines or points, and halos of finished pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.effects import HaloPass, Projection
from pvfiblets.engine.gbuffer import EMPTY
from pvfiblets.engine.halos import HaloRenderer
from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle

from ...cameras import Camera
from ...drawing import data_bytes
from .pictures import Singles, Viewpoint, averaged, darkness_of, finer

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.engine.gbuffer import GBuffer


class Drawing(Protocol):
    """Something that draws halos, some samples a pixel."""

    def render(self, camera: Any, look: HaloStyle) -> Any:
        """Draw, and return what :meth:`read` takes."""
        ...

    def read(self, drawn: Any) -> Singles:
        """Return ``(height, width)`` float32, the mean of a pixel's samples, 1 black."""
        ...

    @property
    def nbytes(self) -> int:
        """Bytes on the GPU that grow with the data."""
        ...

    def release(self) -> None:
        """Give everything back."""
        ...


class Strips:
    """Lines or points with strips around them, some samples along a pixel's side."""

    def __init__(
        self, ctx: moderngl.Context, drawn: HaloLines | HaloPoints, times: int = 1, culling: str | None = "two-phase"
    ) -> None:
        self.renderer = HaloRenderer(ctx, drawn, culling=culling)
        self._times = times

    def render(self, camera: Viewpoint, look: HaloStyle) -> GBuffer:
        """Draw."""
        return self.renderer.render(_view(camera, self._times), finer(look, self._times))

    def read(self, drawn: Any) -> Singles:
        """Return how black pixels are."""
        return averaged(darkness_of(drawn), self._times)

    @property
    def nbytes(self) -> int:
        """Bytes on the GPU that grow with the data."""
        return data_bytes(self.renderer.explain())

    def release(self) -> None:
        """Give everything back."""
        self.renderer.release()


class FibletHalos:
    """Fiblets as tubes, whose pixels have halos.

    A line takes one of the samples along a pixel's side at least, whatever its look says.
    """

    def __init__(self, ctx: moderngl.Context, fiblets: FibletSet, times: int = 1) -> None:
        self._times = times
        self._renderer = FibletRenderer(ctx, fiblets)
        self._halos = HaloPass(ctx)

    def render(self, camera: Camera, look: HaloStyle) -> Any:
        """Draw."""
        view = _view(camera, self._times)
        buffer = self._renderer.render(view, FibletStyle(radius=0.5 * look.line_width))
        lens = Projection(view.size, camera.camera_to_clip)
        width = 0.5 * (look.strip_width - look.line_width)
        return buffer, self._halos.draw(buffer, lens, width=width, depth=look.max_displacement, nearest=camera.near)

    def read(self, drawn: Any) -> Singles:
        """Return how black pixels are."""
        buffer, halos = drawn
        width, height = buffer.size
        lines, hiding = (np.frombuffer(t.read(), "<u4").reshape(height, width) for t in (buffer.depth, halos))
        return averaged(((lines != EMPTY) & (hiding >= lines)).astype(np.float32), self._times)

    @property
    def nbytes(self) -> int:
        """Bytes on the GPU that grow with the data."""
        return data_bytes(self._renderer.explain(counts=False))

    def release(self) -> None:
        """Give everything back."""
        self._halos.release()
        self._renderer.release()


def _view(camera: Viewpoint, times: int) -> View:
    return View((times * camera.size[0], times * camera.size[1]), camera.model_view_projection)
