"""Pictures of lines and points with halos: their data, camera and samples, and their errors."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from pvfiblets.engine import View
from pvfiblets.engine.gbuffer import EMPTY
from pvfiblets.engine.halos import HaloDrawStyle
from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
from pvfiblets.halos.spacing import default_widths

from ...cameras import SLANT, Camera, circling

if TYPE_CHECKING:
    from pvfiblets.engine.gbuffer import GBuffer

DEGREES_PER_FRAME = 1.14  # Schertzer et al. 2022, section 4.5: 90 degrees a second at 80 frames
MOST_PIXELS = 1 << 24  # of one rendering; larger ones are drawn in tiles
WIDTH_CUE = 0.5  # the plotter's own
WRONG = 0.25  # of black and white: pixels that are off by more are counted

Singles = npt.NDArray[np.float32]


class Viewpoint(Protocol):
    """The camera of a picture, or a matrix alone."""

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
        ...

    @property
    def model_view_projection(self) -> npt.NDArray[np.float64]:
        """``(4, 4)``: mm to clip coordinates."""
        ...


def helices(count: int, vertices: int = 40) -> HaloLines:
    """Return helices about one axis."""
    t = np.linspace(0.0, 4.0 * np.pi, vertices)
    shift = 2.0 * np.pi * np.arange(count)[:, None] / count
    points = np.stack(np.broadcast_arrays(np.cos(t + shift), np.sin(t + shift), 0.3 * t), axis=2)
    return HaloLines(points.reshape(-1, 3), vertices * np.arange(count + 1))


def look_of(drawn: HaloLines | HaloPoints, **more: Any) -> HaloStyle:
    """Return the look that the plotter gives data by default."""
    line, strip, displacement = default_widths(drawn)
    if isinstance(drawn, HaloPoints):
        more["n_tapered"] = 0
    return HaloStyle(line, strip, displacement, **{"width_cue": WIDTH_CUE, **more})


def orbit(
    drawn: HaloLines | HaloPoints,
    places: int,
    frames: int,
    size: tuple[int, int],
    degrees: float = DEGREES_PER_FRAME,
) -> list[list[Camera]]:
    """Return cameras that have the data fill the window, all from one distance."""
    centre = np.array(drawn.bounds).reshape(3, 2).mean(axis=1)
    points = drawn.points[:: max(1, drawn.n_points // 50_000)]
    extreme = np.concatenate([drawn.points.argmin(axis=0), drawn.points.argmax(axis=0)])
    points = np.concatenate([points, drawn.points[extreme]]).astype(np.float64) - centre
    narrow = SLANT * np.array([size[0] / size[1], 1.0])
    starts = 0.3 + 2.0 * np.pi * np.arange(places)[:, None] / places
    turns = (starts + np.radians(degrees * np.arange(-1, frames))).ravel()
    seen = [points @ camera.axes.T for camera in circling(np.zeros(3), 1.0, turns, size, 0.5, 2.0)]
    radius = float(np.linalg.norm(points, axis=1).max())
    # A point is in the picture where the eye is at least so far from the centre.
    distance = 1.01 * max(float((p[:, 2] + (abs(p[:, :2]) / narrow).max(axis=1)).max()) for p in seen)
    nearest = distance - max(float(p[:, 2].max()) for p in seen)
    near, far = max(nearest - 0.05 * radius, 1e-3 * radius), distance + 1.05 * radius
    cameras = circling(centre, distance, turns, size, near, far)
    return [cameras[i : i + frames + 1] for i in range(0, len(cameras), frames + 1)]


def finer(look: HaloStyle, times: int) -> HaloDrawStyle:
    """Return the style of so many samples along a pixel's side: the least width is in pixels of the picture."""
    return HaloDrawStyle(look=dataclasses.replace(look, min_width=look.min_width * times))


def averaged(samples: Singles, times: int) -> Singles:
    """Return the means of so many samples along a pixel's side: ``(height, width)`` float32."""
    height, width = (side // times for side in samples.shape)
    return samples.reshape(height, times, width, times).mean(axis=(1, 3), dtype=np.float32)


def darkness_of(gbuffer: GBuffer) -> Singles:
    """Return a G-buffer as black lines with white halos: (height, width) float32, 1 where it is black."""
    width, height = gbuffer.size
    keys = np.frombuffer(gbuffer.depth.read(), np.uint32).reshape(height, width)
    assert gbuffer.across is not None  # lines have their ink there
    ink = np.frombuffer(gbuffer.across.read(), np.float16).reshape(height, width)
    return np.where(keys != EMPTY, ink, np.float16(0.0)).astype(np.float32)


def picture(renderer: Any, camera: Viewpoint, look: HaloStyle, times: int, most: int = MOST_PIXELS) -> Singles:
    """Return a picture of so many samples along a pixel's side, averaged."""
    width, height = camera.size
    # Tiles are all as large as each other and of whole pixels.
    possible = [n for n in range(1, min(width, height) + 1) if width % n == height % n == 0]
    tiles = next((n for n in possible if width * height * times**2 <= most * n**2), None)
    if tiles is None:
        raise ValueError(
            f"a picture of {width} x {height} pixels, {times}x{times} samples each, has no tiles of {most} samples or "
            "fewer; choose a width and a height with more common divisors"
        )
    style = finer(look, times)
    size = (width // tiles * times, height // tiles * times)
    rows = []
    for j in range(tiles):
        row = []
        for i in range(tiles):
            crop = np.diag([tiles, tiles, 1.0, 1.0])
            crop[:2, 3] = tiles - 1 - 2 * i, tiles - 1 - 2 * j
            fine = darkness_of(renderer.render(View(size, crop @ camera.model_view_projection), style))
            row.append(averaged(fine, times))
        rows.append(row)
    return np.block(rows)


def differences(pictures: Sequence[Singles], truth: Sequence[Singles]) -> dict[str, float]:
    """Return by how much pixels differ, as shares of the difference between black and white."""
    off = np.abs(np.stack(pictures) - np.stack(truth))
    return {
        "mean": float(off.mean()),
        "rms": float(np.sqrt((off**2).mean())),
        "p99": float(np.percentile(off, 99)),
        "max": float(off.max()),
        "wrong": float((off > WRONG).mean()),
    }
