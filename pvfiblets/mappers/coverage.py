"""Smooth edges of the lines that a renderer shows: `pvfiblets.engine.effects.coverage` in VTK's own picture.

Mappers of lines ask `pvfiblets.mappers.scene.smoothers` whether edges are wanted, and note what they have drawn; when
the picture is complete, it is smoothed.
"""

from __future__ import annotations

from typing import Any

from pvfiblets.engine.effects.coverage import Coverage, SmoothedLines
from pvfiblets.engine.effects.picture import Attachment
from pvfiblets.mappers.engine_mapper import EngineMapper
from pvfiblets.mappers.scene import smoothers
from pvfiblets.mappers.windows import weak

__all__ = ["EdgeSmoothing"]


class EdgeSmoothing:
    """What is smoothed in one renderer's picture, while this exists and `release` has not been called.

    Parameters
    ----------
    renderer : vtkRenderer
    """

    def __init__(self, renderer: Any) -> None:
        self._renderer = weak(renderer)
        self._address: str = renderer.GetAddressAsString("")
        self._noted: dict[str, SmoothedLines] = {}
        smoothers[self._address] = self

    def begin(self) -> None:
        """Forget what was drawn: another picture begins."""
        self._noted.clear()

    def note(self, mapper: Any, buffer: Any, narrower: float, rectangle: tuple[int, int, int, int]) -> None:
        """Remember what a mapper has drawn for this picture, and in which part of it that may be."""
        if buffer.edges is not None:
            self._noted[mapper.GetAddressAsString("")] = SmoothedLines(buffer, narrower, rectangle)

    def pending(self, thin: bool = False) -> bool:
        """Say whether there is anything to smooth; with `thin`, lines that are thinner than a pixel."""
        return any(lines.narrower > 0.0 or not thin for lines in self._noted.values())

    def smooth(
        self,
        effects: Coverage,
        colour: Attachment,
        depth: Attachment,
        viewport: tuple[int, int, int, int],
        thin: bool = False,
    ) -> None:
        """Smooth the picture, once; with `thin`, lines that are thinner than a pixel only."""
        noted = [lines for lines in self._noted.values() if lines.narrower > 0.0 or not thin]
        self._noted = {}
        effects.smooth(colour, depth, viewport, noted, alike=not self._others())

    def _others(self) -> bool:
        """Say whether anything is shown that may cover some samples of a pixel and not the others: no drawable does."""
        renderer: Any = self._renderer.Get()
        props = renderer.GetViewProps()
        for index in range(props.GetNumberOfItems()):
            prop = props.GetItemAsObject(index)
            flat = prop.IsA("vtkActor2D") or prop.IsA("vtkContextActor")
            ours = prop.IsA("vtkActor") and isinstance(prop.GetMapper(), EngineMapper)
            if prop.GetVisibility() and not (flat or ours):
                return True
        return False

    def release(self) -> None:
        """Have mappers leave edges alone; twice is harmless."""
        self._noted.clear()
        if smoothers.get(self._address) is self:
            del smoothers[self._address]
