"""Smooth edges of the lines that a renderer shows: `pvfiblets.engine.effects.antialias_coverage` in VTK's own picture.

Mappers of lines ask `pvfiblets.mappers.frames.scene.smoothers` whether edges are wanted, and note what they have drawn;
when the picture is complete, it is smoothed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from vtkmodules.vtkRenderingCore import vtkActor

from pvfiblets.engine.effects.antialias_coverage import Coverage, SmoothedLines
from pvfiblets.engine.effects.picture import Attachment
from pvfiblets.mappers.engine_mapper import EngineMapper
from pvfiblets.mappers.frames.scene import items_of, smoothers, weak

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkProp, vtkRenderer

__all__ = ["EdgeSmoothing"]


class EdgeSmoothing:
    """What is smoothed in one renderer's picture, while this exists and `release` has not been called."""

    def __init__(self, renderer: vtkRenderer) -> None:
        self._renderer = weak(renderer)
        self._address: str = renderer.GetAddressAsString("")
        self._noted: dict[str, SmoothedLines] = {}
        # Whether the picture is one of many whose mean is shown (`antialias_refinement.py`). Lines take those pixels
        # whose middles they cover: none is widened to a pixel, and OpenGL's rule for thin lines, which makes slanted
        # ones thinner, does not count.
        self.sample = False
        self.smooths = False  # whether edges are smoothed: of no sample, nor where the mean of all is shown instead
        self.widened = False  # whether any is drawn otherwise in the picture of one sample: mappers say so
        # Returns what a mapper shows in the frame instead of its picture: its part of a layer of samples.
        self.layer: Callable[[Any], Any] | None = None
        smoothers[self._address] = self

    def begin(self, *, sample: bool = False, smooths: bool = True) -> None:
        """Forget what was drawn: another picture begins."""
        self._noted.clear()
        self.sample, self.smooths, self.widened = sample, smooths, False

    def note(self, mapper: Any, buffer: Any, narrower: float, rectangle: tuple[int, int, int, int]) -> None:
        """Remember what a mapper has drawn for this picture, and in which part of it that may be."""
        if buffer.edges is not None:
            self._noted[mapper.GetAddressAsString("")] = SmoothedLines(buffer, narrower, rectangle)

    @property
    def pending(self) -> bool:
        """Whether there is anything to smooth."""
        return bool(self._noted)

    def smooth(
        self, effects: Coverage, colour: Attachment, depth: Attachment, viewport: tuple[int, int, int, int]
    ) -> None:
        """Smooth the picture, once."""
        noted, self._noted = list(self._noted.values()), {}
        effects.smooth(colour, depth, viewport, noted, alike=not self.others)

    @property
    def others(self) -> bool:
        """Whether anything is shown that may cover some samples of a pixel and not the others: no drawable does."""
        return not all(_is_ours(prop) for prop in self._shown())

    @property
    def only_surfaces(self) -> bool:
        """Whether all others are surfaces or volumes: VTK's lines and points are thinner without multisampling."""
        return all(_is_ours(prop) or prop.IsA("vtkVolume") or _is_surface(prop) for prop in self._shown())

    def at_once(self) -> tuple[list[Any], list[Any]]:
        """Return lines whose samples can be drawn at once, and all else that is shown; none if that is in the way."""
        renderer: Any = self._renderer.Get()
        shown = self._shown()
        lines = [prop for prop in shown if _is_ours(prop) and prop.GetMapper().layers_samples(renderer)]
        others = [prop for prop in shown if prop not in lines]
        return (lines, others) if all(map(_hides_by_depth, others)) else ([], [])

    def _shown(self) -> list[Any]:
        """Return what is visible but for what lies over the picture."""
        renderer: Any = self._renderer.Get()
        props = items_of(renderer.GetViewProps())
        return [p for p in props if p.GetVisibility() and not (p.IsA("vtkActor2D") or p.IsA("vtkContextActor"))]

    def release(self) -> None:
        """Have mappers leave edges alone; twice is harmless."""
        self._noted.clear()
        if smoothers.get(self._address) is self:
            del smoothers[self._address]


def _is_surface(prop: vtkProp) -> bool:
    if not isinstance(prop, vtkActor):
        return False
    mapper: Any = prop.GetMapper()
    data = mapper.GetInput() if hasattr(mapper, "GetInput") else None
    if data is None or not data.IsA("vtkPolyData") or data.GetNumberOfLines() or data.GetNumberOfVerts():
        return False
    look = prop.GetProperty()
    whole = not (look.GetEdgeVisibility() or look.GetVertexVisibility())
    return whole and look.GetRepresentationAsString() == "Surface"


def _hides_by_depth(prop: vtkProp) -> bool:
    """Whether each sample of a prop is either opaque or not there, with single samples of a pixel."""
    # Lines of VTK are thinner without multisampling, but along rows and columns of pixels.
    hides = _is_ours(prop) or _is_surface(prop) or getattr(prop, "along_pixels", False)
    return hides and not prop.HasTranslucentPolygonalGeometry()


def _is_ours(prop: vtkProp) -> bool:
    return isinstance(prop, vtkActor) and isinstance(prop.GetMapper(), EngineMapper)
