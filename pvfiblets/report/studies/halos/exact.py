"""Errors of pictures of halos: a float64 reference of every pixel, and the widths of gaps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from pvfiblets.engine.gbuffer import EMPTY
from pvfiblets.halos import HaloLines, HaloStyle
from pvfiblets.halos.widths import halo_width

from ...cameras import Camera
from ...record import Figure
from .pictures import Singles
from .reference import HALO, LINE, NOTHING, Picture

if TYPE_CHECKING:
    from pvfiblets.engine.gbuffer import GBuffer

PIXEL = 0.25  # mm, of the picture of crossings
LINE_WIDTH, STRIP_WIDTH, DEEPEST = 2.0, 8.0, 8.0  # mm
DEPTHS = (1.0, 2.3, 3.1, 4.05, 5.2, 6.35, 7.4, 9.0)  # mm from the lines in front to the lines behind
APART = 12.0  # mm between neighbours: more than strips are wide
IN_FRONT = 12

Floats = npt.NDArray[np.float64]


def kinds(gbuffer: GBuffer) -> tuple[npt.NDArray[np.int64], Floats]:
    """Return what a G-buffer's pixels show, as the reference names it, and their window depth."""
    width, height = gbuffer.size
    keys, owner = (
        np.frombuffer(texture.read(), "<u4").reshape(height, width) for texture in (gbuffer.depth, gbuffer.owner)
    )
    shown = np.where(owner != EMPTY, LINE, HALO)
    return np.where(keys == EMPTY, NOTHING, shown), keys / float(EMPTY)


def pixel_errors(gbuffer: GBuffer, darkness: Singles, truth: Picture, camera: Camera) -> dict[str, Figure]:
    """Compare a picture of one sample a pixel with the reference's."""
    kind, depth = kinds(gbuffer)
    same = (kind == truth.kind) & (kind != NOTHING)

    def distance(window: Floats) -> Floats:
        return camera.far * camera.near / (camera.far - window * (camera.far - camera.near))

    off = np.abs(distance(depth[same]) - distance(truth.depth[same]))
    return {
        "mean": Figure(100.0 * float(np.abs(darkness - truth.ink).mean()), "%"),
        "kind": Figure(100.0 * float((kind != truth.kind).mean()), "%"),
        "depth": Figure(float(np.percentile(off, 99)) if off.size else 0.0, "mm"),
    }


@dataclass(frozen=True, eq=False)
class Crossings:
    """Upright lines in front, and level ones some way behind, in parallel projection: every crossing has a gap."""

    lines: HaloLines
    look: HaloStyle
    size: tuple[int, int]
    model_view_projection: Floats  # What is drawn, and how it is seen
    # Pixels: where the axes of lines in front, not at whole ones, and behind are
    columns: Floats
    rows: Floats
    truth: Floats  # Of each line behind, how wide a gap shows on either side of a line in front, pixels (appendix A)


def crossings() -> Crossings:
    """Make lines whose places within pixels are evenly spread, so that no number of samples is favoured."""
    pitch = APART / PIXEL
    rows = np.array([pitch * (i + 1) for i in range(len(DEPTHS))], np.float64)
    columns = np.array([pitch * (i + 1) + i / IN_FRONT for i in range(IN_FRONT)], np.float64)
    size = int(columns[-1] + pitch), int(rows[-1] + pitch)
    width, height = (PIXEL * side for side in size)
    ahead = [[[PIXEL * x, 0.0, 0.0], [PIXEL * x, height, 0.0]] for x in columns]
    behind = [[[0.0, PIXEL * y, -depth], [width, PIXEL * y, -depth]] for y, depth in zip(rows, DEPTHS, strict=True)]
    points = np.array(ahead + behind, np.float64).reshape(-1, 3)
    look = HaloStyle(LINE_WIDTH, STRIP_WIDTH, DEEPEST, n_tapered=0, min_width=0.0)
    matrix = np.diag([2.0 / width, 2.0 / height, -1.0 / 20.0, 1.0])
    matrix[:2, 3] = -1.0
    truth = halo_width(DEPTHS, LINE_WIDTH, STRIP_WIDTH, DEEPEST) / PIXEL
    return Crossings(HaloLines(points, 2 * np.arange(len(points) // 2 + 1)), look, size, matrix, columns, rows, truth)


def gaps(darkness: Singles, made: Crossings) -> dict[str, Figure]:
    """Measure gaps on either side of lines in front, and compare them with appendix A."""
    # What is white along a line behind, from half way to the next crossing, is the gap on both sides.
    half = int(APART / PIXEL / 2)
    off = []
    for row, truth in zip(made.rows, made.truth, strict=True):
        for column in made.columns:
            middle = int(np.floor(column))
            white = 1.0 - darkness[int(row) - 1 : int(row) + 1, middle - half + 1 : middle + half]
            off.append(abs(float(white.sum(axis=1).mean()) / 2.0 - truth))
    return {"gap": Figure(float(np.mean(off)), "px"), "gap max": Figure(float(max(off)), "px")}
