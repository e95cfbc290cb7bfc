"""What each pixel of a picture with halos shows, in float64 and with no thought for the GPU: what shaders are held to.

Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009), sections 3.2 to 3.6 and appendix A.

Every fragment is worked out at its pixel's centre from the projected axis alone: the foot of the centre on it, how far
it is away on the screen, and what holds there (:mod:`.strips_reference`). Nothing is widened, rasterised or
interpolated between corners. With the half widths ``l`` of the line and ``h`` of its strip in pixels, and the mask
``m`` of tapering, a fragment at ``r`` half widths of the strip from the axis is there where ``r <= m``; it is line
where ``r <= (l / h) m``, else halo, behind the axis by ``max_displacement * f(r)`` mm along the view axis (equation 3).
The nearest fragment of all shows.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt

from pvfiblets.halos.displacement import displaced
from pvfiblets.halos.geometry import HaloLines, HaloPoints
from pvfiblets.halos.style import HaloStyle

from .camera_reference import Array, Camera, Fragments, Ints, box
from .strips_reference import strips

NOTHING, LINE, HALO = range(3)


@dataclass(frozen=True, eq=False)
class Picture:
    """The contents of the pixels; all are ``(height, width)``, row 0 at the bottom."""

    kind: Ints  # int64: `NOTHING` 0, `LINE` 1 (points too), `HALO` 2
    owner: Ints  # int64 point, or first point of the segment, that the fragment belongs to; -1 in empty pixels
    t: Array  # float64 place along that segment, 0..1; 0 of points
    depth: Array  # float64 window depth, 0..1; 1 in empty pixels
    ink: Array  # float64: 1 on a line, 0 elsewhere, and between where edges are smooth
    # float64 pixels, to first order: how far the pixel's centre is from where a fragment begins, ends or turns from
    # line into halo that would change the pixel. Inf away from all of them. 0 where a bend is so sharp for its
    # strip's width that it is open whether a nearer fragment is there.
    margin: Array
    gap: Array  # float64 window depth between the visible fragment and the next behind it. Inf without a second.
    # float64 window depth between the visible fragment and the next of the other kind: as `gap`, but for fragments that
    # would look alike, such as the ends of both segments at a bend
    other: Array
    # float64 pixels, to first order: at least so far is the pixel from where there may be nothing; 0 where there is
    # nothing. The bisector of a bend does not count where both segments are there.
    cover: Array


def picture(
    drawn: HaloLines | HaloPoints,
    look: HaloStyle,
    matrix: npt.ArrayLike,
    size: tuple[int, int],
    *,
    clip_planes: npt.ArrayLike = (),
) -> Picture:
    """Work out a picture, one segment or point after the other."""
    camera = Camera(np.asarray(matrix, np.float64), size, drawn.bounds, look)
    points = np.asarray(drawn.points, np.float64)
    planes = np.asarray(clip_planes, np.float64).reshape(-1, 4)
    clip = camera.clip(points)
    heights = np.concatenate([_depths(clip), points @ planes[:, :3].T + planes[:, 3]], axis=1)
    numbers = None
    if look.filter_by is not None:
        numbers = _singles(drawn.values[look.filter_by])
        low, high = _singles((look.low, look.high)).tolist()
        look = replace(look, low=low, high=high)
    if isinstance(drawn, HaloPoints):
        fragments = _discs(camera, look, points, clip, heights, numbers)
    else:
        fragments = strips(camera, look, drawn, clip, heights, numbers)
    return _nearest(list(fragments), camera, look)


def _singles(numbers: npt.ArrayLike) -> Array:
    """Numbers as float32 has them, in which shaders compare them: what equals a threshold shall pass."""
    # Those that are too large for it, as infinity is, count as its largest, so that there are numbers between.
    wide = np.asarray(numbers, np.float64)
    most = float(np.finfo(np.float32).max) / 2.0
    return np.clip(wide, -most, most).astype(np.float32).astype(np.float64)


def _depths(clip: Array) -> Array:
    """Return distances behind the near and before the far plane; both are negative nowhere in the view."""
    return np.stack([clip[:, 3] + clip[:, 2], clip[:, 3] - clip[:, 2]], axis=1)


def _discs(
    camera: Camera, look: HaloStyle, points: Array, clip: Array, heights: Array, numbers: Array | None
) -> Iterator[Fragments]:
    there = (heights >= 0.0).all(axis=1) & (clip[:, 3] > 0.0)
    if numbers is not None:
        there &= (numbers >= look.low) & (numbers <= look.high)
    cue = camera.cue(points)
    for i in np.flatnonzero(there):
        line, half = (float(n) for n in camera.widths(clip[i, 3], cue[i]))
        centre = camera.pixels(clip[i])
        pixel, at = box(camera, centre[None], half + 2.0)
        away = np.linalg.norm(at - centre, axis=1)
        foot = np.broadcast_to(clip[i], (len(pixel), 4))
        inside, inked = half - away, line - away
        owner, t, nowhere = np.full(len(pixel), i), np.zeros(len(pixel)), np.full(len(pixel), -1.0)
        yield Fragments(pixel, owner, t, foot, away / half, inside, nowhere, nowhere, inked, np.abs(inked))


def _nearest(fragments: list[Fragments], camera: Camera, look: HaloStyle) -> Picture:
    """Choose the nearest fragment of each pixel, and say how far that choice is from another."""
    shape = camera.size[::-1]
    n = shape[0] * shape[1]
    kind, owner, t = np.zeros(n, np.int64), np.full(n, -1), np.zeros(n)
    depth, ink, cover = np.ones(n), np.zeros(n), np.zeros(n)
    margin, gap, other = np.full(n, np.inf), np.full(n, np.inf), np.full(n, np.inf)
    if fragments:
        every = Fragments(*(np.concatenate([getattr(f, field.name) for f in fragments]) for field in fields(Fragments)))
        behind = look.max_displacement * displaced(every.r, look.displacement)
        at_axis = camera.depth(every.foot)
        line = every.inked >= 0.0
        at = np.where(line, at_axis, camera.depth(every.foot, behind))
        there = np.flatnonzero(every.inside >= 0.0)
        there = there[np.lexsort((at[there], every.pixel[there]))]
        first = np.diff(every.pixel[there], prepend=-1) != 0
        shown, rest = there[first], there[~first]
        where = every.pixel[shown]
        kind[where] = np.where(line[shown], LINE, HALO)
        owner[where], t[where], depth[where] = every.owner[shown], every.t[shown], at[shown]
        ink[where] = np.clip(0.5 + every.inked[shown], 0.0, 1.0) if look.smooth else line[shown]
        unlike = rest[np.where(line[rest], LINE, HALO) != kind[every.pixel[rest]]]
        for found, among in ((gap, rest), (other, unlike)):
            np.minimum.at(found, every.pixel[among], at[among])
            found -= depth
        np.maximum.at(cover, every.pixel[there], every.inside[there])
        # Close to a bisector rounding may choose either segment, in the room that both have.
        ends, starts = np.flatnonzero(every.at_end > 0.0), np.flatnonzero(every.at_start > 0.0)
        # Of the same pixel, and the same vertex: a segment's first, and the end of the segment before.
        before, after = every.pixel[ends] + n * (every.owner[ends] + 1), every.pixel[starts] + n * every.owner[starts]
        _, one, next_one = np.intersect1d(before, after, assume_unique=True, return_indices=True)
        one, next_one = ends[one], starts[next_one]
        np.maximum.at(cover, every.pixel[one], np.minimum(every.at_end[one], every.at_start[next_one]))
        # Edges behind the pixel's depth, even as line, do not matter.
        matters = (kind[every.pixel] == NOTHING) | (at_axis <= depth[every.pixel])
        near = np.minimum(np.abs(every.inside), np.where(every.inside > -1.0, every.edge, np.inf))
        np.minimum.at(margin, every.pixel[matters], near[matters])
    return Picture(*(a.reshape(shape) for a in (kind, owner, t, depth, ink, margin, gap, other, cover)))
