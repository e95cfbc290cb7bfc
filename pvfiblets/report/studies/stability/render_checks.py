"""What the cases that draw share: cameras in float64, pictures read back, and where lines must show.

A thin line is drawn from pixel centre to pixel centre. How far that may lead away from the true line is worked out in
``shaders/fiblets/segments/thin_line_rule.glsl``: √5/2 pixels, and the shift of the grid, √2 · 23/256. ``OFF_LINE`` is
their sum.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.gbuffer import EMPTY

from ..card.lines import part_in_view

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.codec.fibletset import FibletSet

Array = npt.NDArray[np.float64]

OFF_LINE = 5.0**0.5 / 2.0 + 2.0**0.5 * 23.0 / 256.0
EVERY_POINT = FibletStyle(tolerance=0.0)
SAMPLES = 8  # places on a line for each pixel it crosses
REACH = 3  # pixels within which lines and pixels are looked for


def camera(
    size: tuple[int, int],
    *,
    eye: npt.ArrayLike = (0.0, -260.0, 60.0),
    target: npt.ArrayLike = (0.0, 0.0, 0.0),
    up: npt.ArrayLike = (0.0, 0.0, 1.0),
    near: float = 20.0,
    far: float = 600.0,
    angle: float = 40.0,
    height: float | None = None,
) -> Array:
    """Return data coordinates to clip coordinates, ``(4, 4)``: perspective, or parallel if a height in mm is given."""
    there, at = np.asarray(eye, np.float64), np.asarray(target, np.float64)
    z = (there - at) / np.linalg.norm(there - at)
    x = np.cross(np.asarray(up, np.float64), z)
    x /= np.linalg.norm(x)
    view = np.eye(4)
    view[:3, :3] = x, np.cross(z, x), z
    view[:3, 3] = -view[:3, :3] @ there
    aspect = size[0] / size[1]
    projection = np.zeros((4, 4))
    if height is None:
        t = 1.0 / np.tan(np.radians(angle) / 2.0)
        projection[0, 0], projection[1, 1] = t / aspect, t
        projection[2, 2:] = -(far + near) / (far - near), -2.0 * far * near / (far - near)
        projection[3, 2] = -1.0
    else:
        projection[0, 0], projection[1, 1] = 2.0 / (height * aspect), 2.0 / height
        projection[2, 2:] = -2.0 / (far - near), -(far + near) / (far - near)
        projection[3, 3] = 1.0
    return projection @ view


def moved_camera(matrix: Array, scale: float, shift: float) -> Array:
    """Return a camera that sees of data at ``scale * x + shift`` what another sees of x."""
    back = np.eye(4)
    back[:3, :3] /= scale
    back[:3, 3] = -shift / scale
    return matrix @ back


@dataclass(frozen=True, eq=False)
class Picture:
    """Contents of a G-buffer of fiblets; arrays are ``(height, width, …)``, row 0 at the bottom."""

    key: npt.NDArray[np.uint32]
    ids: npt.NDArray[np.uint32]
    position: npt.NDArray[np.float32]
    owner: npt.NDArray[np.uint32]

    @property
    def there(self) -> npt.NDArray[np.bool_]:
        """Whether anything is."""
        return self.key != EMPTY

    @property
    def sound(self) -> bool:
        """Whether all pixels that show something name it, by finite numbers, and no others do."""
        there = self.there
        return bool(((self.owner != EMPTY) == there).all() and np.isfinite(self.position[there][:, 0]).all())

    def differs(self, other: Picture) -> int:
        """Count pixels that are not the same, bit by bit."""
        unlike = (self.key != other.key) | (self.owner != other.owner)
        both = self.there & other.there
        unlike |= both & (self.ids != other.ids).any(axis=-1)
        unlike |= both & (self.position.view(np.uint32) != other.position.view(np.uint32)).any(axis=-1)
        return int(unlike.sum())


def read(buffer: Any) -> Picture:
    """Read a G-buffer back."""
    width, height = buffer.size

    def get(texture: Any, dtype: str) -> npt.NDArray[Any]:
        return np.frombuffer(texture.read(), dtype).reshape(height, width, -1)

    return Picture(
        get(buffer.depth, "<u4")[..., 0],
        get(buffer.ids, "<u4"),
        get(buffer.position, "<f4"),
        get(buffer.owner, "<u4")[..., 0],
    )


@contextmanager
def drawing(ctx: moderngl.Context, fiblets: FibletSet, **options: Any) -> Iterator[FibletRenderer]:
    """Give a renderer that is released afterwards."""
    renderer = FibletRenderer(ctx, fiblets, **options)
    try:
        yield renderer
    finally:
        renderer.release()


def drawn(
    ctx: moderngl.Context, fiblets: FibletSet, view: View, style: FibletStyle = EVERY_POINT, **options: Any
) -> Picture:
    """Draw one picture with a renderer of its own."""
    with drawing(ctx, fiblets, **options) as renderer:
        return read(renderer.render(view, style))


def samples(lines: Sequence[npt.NDArray[Any]], matrix: Array, size: tuple[int, int]) -> Array:
    """Return places along polylines in the window, ``(n, 2)`` pixels from the lower left corner, evenly there."""
    rows = [np.empty((0, 2))]
    for line in lines:
        clip = np.column_stack([line, np.ones(len(line))]) @ matrix.T
        a, b = (clip, clip) if len(clip) == 1 else (clip[:-1], clip[1:])
        for p, q, low, high in zip(a, b, *part_in_view(a, b), strict=True):
            if low > high:
                continue
            ends = np.array([p + low * (q - p), p + high * (q - p)])
            if not (ends[:, 3] > 0.0).all():
                continue
            window = (ends[:, :2] / ends[:, 3:] + 1.0) / 2.0 * size
            steps = int(np.abs(window[1] - window[0]).max() * SAMPLES) + 2
            rows.append(window[0] + np.linspace(0.0, 1.0, steps)[:, None] * (window[1] - window[0]))
    return np.concatenate(rows)


def off_lines(shown: Picture, lines: Sequence[npt.NDArray[Any]], matrix: Array, size: tuple[int, int]) -> float:
    """Return the largest distance in pixels between the picture and the lines in float64, either way."""
    # Of a drawn pixel's centre from the nearest place on a line, and of a place on a line from the nearest drawn
    # pixel's; inf beyond `REACH`, or where there is none.
    places = samples(lines, matrix, size)
    there = shown.there
    if not len(places) or not there.any():
        return np.inf
    width, height = size
    nearest = np.full((height + 2 * REACH, width + 2 * REACH), np.inf)  # of each pixel, the nearest place
    drawn_near = np.pad(there, REACH)
    found = np.full(len(places), np.inf)  # of each place, the nearest pixel drawn
    cell = np.clip(np.floor(places).astype(np.int64), 0, np.array(size) - 1)
    for dy in range(-REACH, REACH + 1):
        for dx in range(-REACH, REACH + 1):
            apart = np.hypot(cell[:, 0] + dx + 0.5 - places[:, 0], cell[:, 1] + dy + 0.5 - places[:, 1])
            at = cell[:, 1] + dy + REACH, cell[:, 0] + dx + REACH
            np.minimum.at(nearest, at, apart)
            found = np.where(drawn_near[at], np.minimum(found, apart), found)
    # A place in the outermost pixels may have moved out of the picture.
    inner = np.minimum(places, np.array(size, np.float64) - places).min(axis=1) >= 1.0
    pixels = nearest[REACH:-REACH, REACH:-REACH][there]
    return float(max(pixels.max(), found[inner].max(initial=0.0)))


def pixel_rays(matrix: Array, size: tuple[int, int]) -> tuple[Array, Array]:
    """Return where the rays through all pixels' centres leave the near plane, and unit directions, ``(h · w, 3)``."""
    width, height = size
    y, x = np.mgrid[:height, :width] + 0.5
    back = np.linalg.inv(matrix)
    ends = []
    for depth in (-1.0, 1.0):
        clip = np.stack([2.0 * x / width - 1.0, 2.0 * y / height - 1.0, np.full_like(x, depth), np.ones_like(x)], -1)
        at = clip.reshape(-1, 4) @ back.T
        ends.append(at[:, :3] / at[:, 3:])
    directions = ends[1] - ends[0]
    return ends[0], directions / np.linalg.norm(directions, axis=1, keepdims=True)
