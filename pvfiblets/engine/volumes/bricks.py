"""Where the voxels of a volume lie that no 3-D texture takes: in bricks (``shaders/volumes/bricks.glsl``).

Their slices are layers of 2-D textures, which have many more texels along an axis than 3-D ones, mostly 16,384 to
32,768 for 2,048 to 16,384. Within a layer the hardware interpolates, and between two of them the shader does. Bricks
share the voxels at their faces within layers, so that each cell lies in one brick; from layer to layer nothing need be
shared. If memory cannot be had in one piece, bricks are dealt out to several textures, the pages.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

MOST_PAGES = 8  # textures of one volume

PIECE = 1 << 24
"""Voxels that are handed to OpenGL at a time, at the most, if a slice has no more: what a volume takes of the host's
memory beside itself."""

Range = tuple[slice, slice, slice]  # A box of voxels


@dataclass(frozen=True)
class BrickLayout:
    """A volume in bricks."""

    shape: tuple[int, int, int]  # voxels of the volume
    # voxels of a brick. The last along the first two axes is the first of the next brick, if there is one.
    size: tuple[int, int, int]
    counts: tuple[int, int, int]  # bricks along each axis
    in_page: tuple[int, int]  # columns and rows of bricks in a page
    pages: int

    @property
    def steps(self) -> tuple[int, int, int]:
        """Voxels from one brick to the next along each axis."""
        (w, h, d), (bx, by, _) = self.size, self.counts
        return w - (bx > 1), h - (by > 1), d

    @property
    def page_shape(self) -> tuple[int, int, int]:
        """Texels and layers of each page."""
        return self.in_page[0] * self.size[0], self.in_page[1] * self.size[1], self.size[2]

    def bricks(self) -> Iterator[tuple[int, tuple[int, int], Range]]:
        """Yield of each brick its page, its corner in texels there, and its voxels."""
        per_page = self.in_page[0] * self.in_page[1]
        bx, by, bz = self.counts
        for number in range(bx * by * bz):
            page, slot = divmod(number, per_page)
            row, column = divmod(slot, self.in_page[0])
            at = (number % bx, number // bx % by, number // (bx * by))
            x, y, z = (
                slice(first * step, min(first * step + size, n))
                for first, step, size, n in zip(at, self.steps, self.size, self.shape, strict=True)
            )
            yield page, (column * self.size[0], row * self.size[1]), (x, y, z)


def lay_out(shape: tuple[int, int, int], side: int, layers: int, voxels: float) -> BrickLayout | None:
    """Lay a volume out."""
    (bx, w), (by, h) = (_shared(n, side) for n in shape[:2])
    most = min(layers, int(min(voxels // (w * h), shape[2])))
    if most < 1:
        return None
    bz = -(-shape[2] // most)
    d = -(-shape[2] // bz)
    bricks = bx * by * bz
    room = int(min(voxels // (w * h * d), bricks))
    columns = min(side // w, room)
    rows = min(side // h, room // columns, -(-bricks // columns))
    pages = -(-bricks // (columns * rows))
    return BrickLayout(shape, (w, h, d), (bx, by, bz), (columns, rows), pages) if pages <= MOST_PAGES else None


def voxels_of_page(shape: tuple[int, int, int], side: int, layers: int, pages: int) -> int:
    """Return how many voxels a page has if there are so many, none larger than it must be."""
    (bx, w), (by, h) = (_shared(n, side) for n in shape[:2])
    d = min(layers, -(-shape[2] // pages))
    bricks = bx * by * -(-shape[2] // d)
    return w * h * d * -(-bricks // pages)


def pieces(box: Range, axis: int, most: int = PIECE) -> Iterator[Range]:
    """Cut a box of voxels across an axis into pieces of so many voxels at most, but of a slice at least."""
    lengths = [part.stop - part.start for part in box]
    others = lengths[(axis + 1) % 3] * lengths[(axis + 2) % 3]
    thick = max(1, most // max(others, 1))
    for start in range(box[axis].start, box[axis].stop, thick):
        cut = slice(start, min(start + thick, box[axis].stop))
        x, y, z = (cut if k == axis else part for k, part in enumerate(box))
        yield x, y, z


def _shared(n: int, side: int) -> tuple[int, int]:
    """Bricks along an axis and voxels of each, whose outermost are shared."""
    if n <= side:
        return 1, n
    bricks = -(-(n - 1) // (side - 1))
    return bricks, -(-(n - 1) // bricks) + 1
