"""Pixels beyond the edge of a tile, for effects that read neighbours.

``vtkWindowToImageFilter``, and so ``screenshot(scale=2)``, makes a picture larger than its window of tiles, each a
render of its own. A blur that ends at a tile's edge would leave a seam, so the surroundings are drawn, too: by the same
renderer, with its camera's window shifted.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer


@dataclass(frozen=True)
class Margin:
    """Pixels around a renderer's part of a tile that belong to the same renderer's picture."""

    size: tuple[int, int]  # of that part
    low: tuple[int, int]  # pixels to the left of and below it, to the right of and above it
    high: tuple[int, int]

    @property
    def padded(self) -> tuple[int, int]:
        """Size with the surroundings."""
        return (
            self.low[0] + self.size[0] + self.high[0],
            self.low[1] + self.size[1] + self.high[1],
        )

    def corner(self, shift: tuple[int, int]) -> tuple[int, int]:
        """Return where, in the padded picture, one comes that was drawn with its window shifted by some pixels."""
        return self.low[0] + shift[0], self.low[1] + shift[1]

    def shifts(self) -> list[tuple[int, int]]:
        """Return by how many pixels to shift the window, so that all surroundings are seen."""
        across, up = (sorted({-low, high}) for low, high in zip(self.low, self.high, strict=True))
        return [(x, y) for x in across for y in up if (x, y) != (0, 0)]


def margin_of(renderer: vtkRenderer, reach: int) -> Margin | None:
    """Return the surroundings of what a renderer is about to draw."""
    window = renderer.GetRenderWindow()
    if tuple(window.GetTileScale()) == (1, 1) or renderer.GetPass() is not None:
        return None
    if renderer.GetLayer() != 0 or not renderer.GetErase() or renderer.GetPreserveColorBuffer():
        return None
    width, height, x, y = [0], [0], [0], [0]
    renderer.GetTiledSizeAndOrigin(width, height, x, y)
    size = width[0], height[0]
    if min(size) < 1:
        return None
    own, tile, whole = renderer.GetViewport(), window.GetTileViewport(), window.GetSize()
    low, high = [], []
    for axis in (0, 1):
        most = min(reach, size[axis] // 2)  # two windows shifted apart by more would leave a gap
        before = round((max(own[axis], tile[axis]) - own[axis]) * whole[axis])
        behind = round((own[axis + 2] - min(own[axis + 2], tile[axis + 2])) * whole[axis])
        low.append(min(most, max(before, 0)))
        high.append(min(most, max(behind, 0)))
    margin = Margin(size, (low[0], low[1]), (high[0], high[1]))
    return margin if margin.shifts() else None
