"""Pictures of fiblets: their contents, differences and cameras."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.engine import View
from pvfiblets.engine.gbuffer import EMPTY

from ...cameras import circling, fitting
from ...record import Figure

DISTANCES = {"far": 1.0, "close": 1.0 / 3.0, "inside": 0.06}
"""Distances of the eye from the middle, by the distance from which the whole set fits the picture."""

NEAR = 2e-3  # of the set's radius

Floats = npt.NDArray[np.float64]
Singles = npt.NDArray[np.float32]
Words = npt.NDArray[np.uint32]


@dataclass(frozen=True, eq=False)
class Visible:
    """The contents of a picture's pixels."""

    streamline: npt.NDArray[np.int64]  # `(height, width)` int64; -1 where there is none
    # `(height, width)` uint32, directions as the G-buffer packs them; without meaning where there is no streamline
    tangent: Words


def views(bounds: Sequence[float], kind: str, degrees: float, frames: int, size: tuple[int, int]) -> list[View]:
    """Return views from around a set's middle, so many degrees apart."""
    box = np.array(bounds, np.float64).reshape(3, 2)
    centre, radius = box.mean(axis=1), 0.5 * float(np.linalg.norm(box[:, 1] - box[:, 0])) or 1.0
    distance = DISTANCES[kind] * fitting(radius, size)
    near, far = max(distance - 1.02 * radius, NEAR * radius), distance + 1.02 * radius
    turns = np.radians(141.0 + degrees * np.arange(frames))
    return [View(size, one.model_view_projection) for one in circling(centre, distance, turns, size, near, far)]


def streamlines_of(picture: Any) -> npt.NDArray[np.int64]:
    """Return the streamline that each pixel of a G-buffer shows, -1 where none: ``(height, width)`` int64."""
    return visible(picture).streamline


def visible(picture: Any) -> Visible:
    """Read a G-buffer."""
    width, height = picture.size
    depth = np.frombuffer(picture.depth.read(), "<u4").reshape(height, width)
    ids = np.frombuffer(picture.ids.read(), "<u4").reshape(height, width, 2)
    return Visible(np.where(depth == EMPTY, -1, ids[..., 0].astype(np.int64)), ids[..., 1].copy())


def directions(words: npt.ArrayLike) -> Floats:
    """Return unit vectors, ``(..., 3)`` float64, that the G-buffer's words stand for: an octahedron about x."""
    packed = np.asarray(words, np.uint32)
    y, z = (np.asarray(half, np.uint16).view(np.int16) / 32767.0 for half in (packed & 0xFFFF, packed >> 16))
    x = 1.0 - np.abs(y) - np.abs(z)
    folded = (1.0 - np.abs(z)) * np.where(y < 0.0, -1.0, 1.0), (1.0 - np.abs(y)) * np.where(z < 0.0, -1.0, 1.0)
    found = np.stack([x, *(np.where(x < 0.0, f, p) for f, p in zip(folded, (y, z), strict=True))], axis=-1)
    return np.asarray(found / np.linalg.norm(found, axis=-1, keepdims=True), np.float64)


def colours(picture: Visible) -> Singles:
    """Return a picture coloured by direction, |x|, |y|, |z| on black: ``(height, width, 3)`` float32."""
    found = np.zeros((*picture.streamline.shape, 3), np.float32)
    there = picture.streamline >= 0
    found[there] = np.abs(directions(picture.tangent[there]))
    return found


def averaged(picture: Singles, times: int) -> Singles:
    """Return the mean of every ``times`` by ``times`` samples: ``(height / times, width / times, 3)``."""
    height, width = (side // times for side in picture.shape[:2])
    return picture.reshape(height, times, width, times, 3).mean(axis=(1, 3))


def difference(pictures: Sequence[Singles], truth: Sequence[Singles]) -> Figure:
    """Return how far colours are apart, mean over the pixels in which either shows anything, in percent of white."""
    total, pixels = 0.0, 0
    for one, other in zip(pictures, truth, strict=True):
        total += float(np.abs(one - other).mean(axis=2).sum(dtype=np.float64))
        pixels += int((one.any(axis=2) | other.any(axis=2)).sum())
    return Figure(100.0 * total / max(pixels, 1), "%")


def errors(pictures: Sequence[Visible], truth: Sequence[Visible]) -> dict[str, Figure]:
    """Return how far pictures are from the right ones, as shares of the pixels in which those show a streamline."""
    wrong = coverage = covered = 0
    for one, other in zip(pictures, truth, strict=True):
        a, b = one.streamline, other.streamline
        wrong += int((a != b).sum())
        coverage += int(((a >= 0) != (b >= 0)).sum())
        covered += int((b >= 0).sum())
    share = 100.0 / max(covered, 1)
    return {"wrong": Figure(share * wrong, "%"), "coverage": Figure(share * coverage, "%")}
