"""What each pixel of a picture with halos shows, in float64 and with no thought for the GPU: what shaders are held to.

Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009), sections 3.2 to 3.6 and appendix A.

Every fragment is worked out at its pixel's centre from the projected axis alone: the foot of the centre on it, how far
it is away on the screen, and what holds there. Nothing is widened, rasterised or interpolated between corners.
In clip coordinates ``(X, Y, Z, W)`` a length of 1 mm beside a point takes ``k = s / W`` pixels. With the half widths
``l`` of the line and ``h`` of its strip in mm, and the mask ``m`` of tapering, a fragment at ``r`` half widths of the
strip from the axis is there where ``r <= m``; it is line where ``r <= (l / h) m``, else halo, behind the axis by
``max_displacement * f(r)`` mm along the view axis (equation 3). The nearest fragment of all shows.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt

from .displacement import displaced
from .look import Look
from .things import HaloLines, HaloPoints

__all__ = ["HALO", "LINE", "NOTHING", "Picture", "mask", "picture", "places_along", "rates"]

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]

NOTHING, LINE, HALO = range(3)

SHORT = 1e-3
"""Pixels: a segment that takes no more of the screen has no direction there."""

SHARPEST = 0.5
"""Cosine of the sharpest bend that is mitred."""

OPEN = -np.finfo(np.float64).tiny
"""Pixels within: not there, and yet as near to it as can be."""

PLATEAU = 0.2
"""Places along the mask from where on it is as wide as the strip."""


@dataclass(frozen=True, eq=False)
class Picture:
    """What the pixels show; all are ``(height, width)``, row 0 at the bottom.

    Attributes
    ----------
    kind : numpy.ndarray
        int64: ``NOTHING`` 0, ``LINE`` 1 (points too), ``HALO`` 2.
    owner : numpy.ndarray
        int64 point, or first point of the segment, that the fragment belongs to; -1 where there is nothing.
    t : numpy.ndarray
        float64 place along that segment, 0..1; 0 of points.
    depth : numpy.ndarray
        float64 window depth, 0..1; 1 where there is nothing.
    ink : numpy.ndarray
        float64: 1 on a line, 0 elsewhere, and between where edges are smooth.
    margin : numpy.ndarray
        float64 pixels, to first order: how far the pixel's centre is from where a fragment begins, ends or turns from
        line into halo that would change what shows. Inf away from all of them.
    gap : numpy.ndarray
        float64 window depth between what shows and what is next behind it. Inf where nothing else is.
    slack : numpy.ndarray
        float64 window depth: by how much `depth` may be another where a strip is mitred, and it is open which place on
        the axis a pixel beside it is at. `margin` and `gap` allow for that.
    """

    kind: Ints
    owner: Ints
    t: Array
    depth: Array
    ink: Array
    margin: Array
    gap: Array
    slack: Array


def picture(
    drawn: HaloLines | HaloPoints,
    look: Look,
    matrix: npt.ArrayLike,
    size: tuple[int, int],
    *,
    clip_planes: npt.ArrayLike = (),
) -> Picture:
    """Work out a picture, one segment or point after the other.

    Parameters
    ----------
    drawn : HaloLines or HaloPoints
    look : Look
    matrix : array_like
        ``(4, 4)``: data coordinates in mm to OpenGL's clip coordinates. What of an axis is not between its near and
        far planes is not there; halos that reach behind the far plane stay on it.
    size : tuple of int
        Width and height in pixels.
    clip_planes : array_like, optional
        ``(k, 4)`` planes (a, b, c, d), mm: of axes, only what lies where ax + by + cz + d >= 0 for all is there.

    Returns
    -------
    Picture

    Raises
    ------
    KeyError
        If ``look.filter_by`` names no values.
    """
    camera = _Camera(np.asarray(matrix, np.float64), size, drawn.bounds, look)
    points = np.asarray(drawn.points, np.float64)
    planes = np.asarray(clip_planes, np.float64).reshape(-1, 4)
    clip = points @ camera.matrix[:, :3].T + camera.matrix[:, 3]
    heights = np.concatenate([_depths(clip), points @ planes[:, :3].T + planes[:, 3]], axis=1)
    numbers = None
    if look.filter_by is not None:
        numbers = _singles(drawn.values[look.filter_by])
        low, high = _singles((look.low, look.high)).tolist()
        look = replace(look, low=low, high=high)
    if isinstance(drawn, HaloPoints):
        fragments = _discs(camera, look, clip, heights, numbers)
    else:
        fragments = _strips(camera, look, drawn, clip, heights, numbers)
    return _nearest(list(fragments), camera, look)


def mask(x: Array) -> Array:
    """Width of the mask over the strip's, by how far along its round end a place is, 0 at the tip to 1."""
    x = np.clip(x, 0.0, 1.0)
    return np.sqrt(x * (2.0 - x))


def places_along(count: int, n_tapered: int, t_tapered: float) -> Array:
    """Places ``u`` along the mask of the vertices of a line (section 3.4), rounded to 16 bits.

    Parameters
    ----------
    count : int
        Vertices of the line.
    n_tapered : int
        Over as many the ends narrow, at least 1.
    t_tapered : float
        Where vertex ``n_tapered`` is; the last vertices mirror the first ones.
    """
    i = np.arange(count, dtype=np.float64)
    i = np.minimum(i, count - 1 - i)
    # The middle of a line that is longer than both its ends runs on from t to 1 - t; before, it is at i of n.
    span = max(count - 1 - 2 * n_tapered, 1)
    inner = t_tapered + (1.0 - 2.0 * t_tapered) * (i - n_tapered) / span
    u = np.where(i <= n_tapered, i / n_tapered * t_tapered, inner)
    if count % 2:
        u[count // 2] = 0.5
    u = np.where(np.arange(count) > (count - 1) / 2, 1.0 - u, u)
    stored = np.round(u * 65535.0)
    stored[1:-1] = np.clip(stored[1:-1], 1.0, 65534.0)
    return stored / 65535.0


def rates(points: Array, offsets: Ints, numbers: Array) -> Array:
    """Change of numbers per mm at the vertices: the mean over the segments beside each, 0 where there is none.

    Segments without length, or with a NaN, do not count.
    """
    first = _firsts(offsets)
    with np.errstate(divide="ignore", invalid="ignore"):
        steep = np.abs(numbers[first + 1] - numbers[first]) / np.linalg.norm(points[first + 1] - points[first], axis=1)
    first, steep = first[np.isfinite(steep)], steep[np.isfinite(steep)]
    ends = np.concatenate([first, first + 1])
    sums = np.bincount(ends, np.tile(steep, 2), len(points))
    return sums / np.maximum(np.bincount(ends, minlength=len(points)), 1)


def _singles(numbers: npt.ArrayLike) -> Array:
    """Numbers as float32 has them, in which shaders compare them: what equals a threshold shall pass."""
    with np.errstate(over="ignore"):
        return np.asarray(numbers).astype(np.float32).astype(np.float64)


def _firsts(offsets: Ints) -> Ints:
    """First points of all segments."""
    last = np.zeros(int(offsets[-1]) + 1, bool)
    last[offsets[1:] - 1] = True  # a line without points marks what another one does, or the entry that falls away
    return np.flatnonzero(~last[:-1])


# ------------------------------------------------------------------------------------------------------- the camera


class _Camera:
    """A matrix, and how wide things are at a depth."""

    def __init__(self, matrix: Array, size: tuple[int, int], bounds: tuple[float, ...], look: Look) -> None:
        self.matrix, self.size, self._look = matrix, size, look
        x, y, z, w = matrix[:, :3]
        self.perspective = bool(w.any())
        toward = w if self.perspective else z
        length = np.linalg.norm(toward)
        self._axis = np.append(toward, matrix[3 if self.perspective else 2, 3]) / (length or 1.0)
        unit = self._axis[:3]
        rows = (row - (row @ unit) * unit for row in (x, y))
        self._scale = float(np.mean([n / 2.0 * np.linalg.norm(row) for n, row in zip(size, rows, strict=True)]))
        self._rates = float(z @ unit), float(w @ unit)
        corners = np.array(np.meshgrid(*np.reshape(bounds, (3, 2)))).reshape(3, -1).T
        along = corners @ unit + self._axis[3]
        self._first, self._last = along.min(), along.max()
        if self.perspective:
            self._first = max(self._first, 0.0)

    def pixels(self, clip: Array) -> Array:
        """Where clip coordinates are in the window."""
        return (clip[..., :2] / clip[..., 3:] + 1.0) / 2.0 * self.size

    def depth(self, clip: Array, behind: Array | float = 0.0) -> Array:
        """Window depth some mm behind a place."""
        z, w = clip[..., 2] + behind * self._rates[0], clip[..., 3] + behind * self._rates[1]
        return np.clip((z / w + 1.0) / 2.0, 0.0, 1.0)

    def widths(self, clip: Array) -> tuple[Array, Array]:
        """Half widths of line and strip, pixels."""
        look = self._look
        z, w = clip[..., 2], clip[..., 3]
        k = self._scale / w
        # Along the view axis Z of a parallel and W of a perspective projection grow evenly.
        along = w / self._rates[1] if self.perspective else (z - self.matrix[2, 3]) / (self._rates[0] or 1.0)
        along = along if self.perspective else along + self._axis[3]
        span = self._last - self._first
        cue = 1.0 - look.width_cue * (np.clip((along - self._first) / span, 0.0, 1.0) if span > 0.0 else 0.0)
        own = cue * look.line_width / 2.0 * k
        line = np.maximum(own, look.min_width / 2.0)
        return line, look.strip_width / 2.0 * k + line - own


def _depths(clip: Array) -> Array:
    """How far places are behind the near and before the far plane; both are negative nowhere in the view."""
    return np.stack([clip[:, 3] + clip[:, 2], clip[:, 3] - clip[:, 2]], axis=1)


def _kept(a: Array, b: Array) -> tuple[float, float]:
    """From where to where a segment is on the kept side of everything, by the heights of its ends; 1, 0 for nowhere."""
    if (np.minimum(a, b) >= 0.0).all():
        return 0.0, 1.0
    if (np.maximum(a, b) < 0.0).any():
        return 1.0, 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a / (a - b)
    return float(np.where(a < 0.0, at, 0.0).max()), float(np.where(b < 0.0, at, 1.0).min())


# ---------------------------------------------------------------------------------------------------- the fragments


@dataclass(frozen=True, eq=False)
class _Fragments:
    """Fragments of one segment or point, and pixels that it misses; arrays of one length."""

    pixel: Ints
    owner: Ints
    t: Array
    axis: Array  # (n, 4) clip coordinates of the place on the axis
    away: Array  # pixels from the axis
    mask: Array
    slope: Array  # of the mask, per pixel along the axis
    inside: Array  # pixels from where the axis lets it end; negative beyond
    wide: Array  # by how much the mask may be another, where it is open which place on the axis counts
    deep: Array  # by how much window depth may


def _box(camera: _Camera, corners: Array, reach: float) -> tuple[Ints, Array]:
    """Numbers and centres of the pixels that are no farther from the corners' box."""
    low = np.maximum(np.floor(corners.min(axis=0) - reach), 0.0)
    high = np.minimum(np.ceil(corners.max(axis=0) + reach), camera.size)
    if not (low < high).all():
        return np.zeros(0, np.int64), np.zeros((0, 2))
    y, x = np.mgrid[int(low[1]) : int(high[1]), int(low[0]) : int(high[0])]
    return (y * camera.size[0] + x).ravel(), np.stack([x, y], axis=-1).reshape(-1, 2) + 0.5


def _discs(camera: _Camera, look: Look, clip: Array, heights: Array, numbers: Array | None) -> Iterator[_Fragments]:
    kept = (heights >= 0.0).all(axis=1) & (clip[:, 3] > 0.0)
    if numbers is not None:
        kept &= (numbers >= look.low) & (numbers <= look.high)
    for i in np.flatnonzero(kept):
        centre, half = camera.pixels(clip[i]), float(camera.widths(clip[i])[1])
        pixel, at = _box(camera, centre[None], half + 2.0)
        none = np.zeros(len(pixel))
        axis = np.broadcast_to(clip[i], (len(pixel), 4))
        away = np.linalg.norm(at - centre, axis=1)
        yield _Fragments(pixel, np.full(len(pixel), i), none, axis, away, none + 1.0, none, none + np.inf, none, none)


@dataclass(frozen=True, eq=False)
class _Along:
    """What varies along one segment, by its two ends."""

    look: Look
    u: Array
    numbers: Array | None
    steep: Array  # of the numbers, per mm

    def mask(self, t: Array) -> Array:
        """How wide the strip is there, over its whole width."""
        u = _between(self.u, t)
        m = mask(np.minimum(u, 1.0 - u) / PLATEAU)
        if self.numbers is None or self.look.filter_taper == 0.0:
            return m
        fall = _between(self.steep, t) * self.look.filter_taper
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.minimum(m, mask(np.where(fall > 0.0, self._room(t) / fall, 1.0)))

    def _room(self, t: Array) -> Array:
        """How far numbers are from the nearer threshold; negative where they do not pass."""
        assert self.numbers is not None
        value = _between(self.numbers, t)
        return np.minimum(value - self.look.low, self.look.high - value)

    def passes(self, t: Array, change: Array) -> Iterator[Array]:
        """Yield pixels from where numbers cease to pass, negative beyond; `change` is that of t per pixel."""
        if self.numbers is not None:
            yield _in_pixels(self._room(t), change * abs(self.numbers[1] - self.numbers[0]))


def _strips(
    camera: _Camera, look: Look, lines: HaloLines, clip: Array, heights: Array, numbers: Array | None
) -> Iterator[_Fragments]:
    u = np.full(len(clip), 0.5)
    if look.n_tapered:
        for a, b in zip(lines.offsets[:-1], lines.offsets[1:], strict=True):
            u[a:b] = places_along(int(b - a), look.n_tapered, look.t_tapered)
    steep = np.zeros(len(clip))
    if numbers is not None:
        steep = rates(np.asarray(lines.points, np.float64), lines.offsets, numbers)
    directions = {int(i): _direction(camera, clip[i : i + 2], heights[i : i + 2, :2]) for i in _firsts(lines.offsets)}
    for i, own in directions.items():
        both = slice(i, i + 2)
        kept = _kept(heights[i], heights[i + 1])
        # What has no direction, the ends of its neighbours show.
        if kept[0] > kept[1] or not own.any() or (numbers is not None and np.isnan(numbers[both]).any()):
            continue
        # Only what has no place on the screen is cut off before.
        start, end = (0.0, 1.0) if (clip[both, 3] > 0.0).all() else _kept(heights[i, :2], heights[i + 1, :2])
        before = _end(directions.get(i - 1), own, whole=start == 0.0)
        after = _end(directions.get(i + 1), own, whole=end == 1.0)
        ends = np.stack([_between(clip[both], t) for t in (start, end)])
        pixel, part, change, away, inside = _strip(camera, ends, own, before, after)
        places, change = start + (end - start) * part, (end - start) * change
        along = _Along(look, u[both], None if numbers is None else numbers[both], steep[both])
        masks = along.mask(places)
        for passes in (*along.passes(places, change), *_pixels_past(kept, places, change)):
            unknown = (passes >= 0.0).any(axis=0) != (passes >= 0.0).all(axis=0)
            # Beyond the ends nothing else matters.
            inside = np.where(inside < 0.0, inside, np.minimum(inside, np.where(unknown, OPEN, passes[0])))
        axes, t, step = _between(clip[both], places), places[0], 0.02 * change
        slope = (along.mask(np.minimum(t + step, 1.0)) - along.mask(np.maximum(t - step, 0.0))) / 0.04
        owner = np.full(len(t), i)
        wide, deep = np.ptp(masks, axis=0), np.ptp(camera.depth(axes), axis=0)
        yield _Fragments(pixel, owner, t, axes[0], away, masks[0], slope, inside, wide, deep)


def _pixels_past(kept: tuple[float, float], t: Array, change: Array) -> Iterator[Array]:
    """Yield pixels from where a segment is cut, at each end that is; `change` is that of t per pixel."""
    for room in ([t - kept[0]] if kept[0] > 0.0 else []) + ([kept[1] - t] if kept[1] < 1.0 else []):
        yield _in_pixels(room, change)


def _in_pixels(room: Array, per_pixel: Array) -> Array:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(per_pixel > 0.0, room / per_pixel, np.where(room >= 0.0, np.inf, -np.inf))


def _between(ends: Array, t: Array | float) -> Array:
    """Linear between two numbers, or rows."""
    t = np.asarray(t).reshape(np.shape(t) + (1,) * (ends.ndim - 1))
    return (1.0 - t) * ends[0] + t * ends[1]


def _direction(camera: _Camera, clip: Array, heights: Array) -> Array:
    """Unit direction of a segment on the screen, by its part in view; zeros if it has none."""
    start, end = _kept(*heights)
    if start > end:
        return np.zeros(2)
    a, b = (camera.pixels(_between(clip, t)) for t in (start, end))
    length = np.linalg.norm(b - a)
    return (b - a) / length if length > SHORT else np.zeros(2)


def _end(neighbour: Array | None, own: Array, *, whole: bool) -> Array | None:
    """Return what a strip ends at, the normal of a straight edge through its vertex, or None for a half disc."""
    if neighbour is None or not whole:
        return own
    if own @ neighbour < SHARPEST:
        return None
    return (own + neighbour) / np.linalg.norm(own + neighbour)


def _strip(
    camera: _Camera, ends: Array, own: Array, before: Array | None, after: Array | None
) -> tuple[Ints, Array, Array, Array, Array]:
    """Return pixels about a strip, and of each: t, its change per pixel, distances from axis and ends.

    Where a strip is mitred its sides are not as long as its axis. Places along it then count from end to end by how
    long it is at the pixel; t has two more rows, by how long either side is. Those differ by bend times half a width.
    """
    (a, b), w = camera.pixels(ends), ends[:, 3]
    line, half = camera.widths(ends)
    pixel, at = _box(camera, np.stack([a, b]), 1.2 * (half + line).max() + 2.0)
    n = len(pixel)
    left = np.array([-own[1], own[0]])
    from_a, from_b = at - a, at - b
    along, across = from_a @ own, from_a @ left
    away, length = np.abs(across), max(float(np.linalg.norm(b - a)), np.finfo(float).tiny)
    slants, beyond = [], np.full((2, n), np.inf)
    for k, (edge, vector) in enumerate(((before, from_a), (after, -from_b))):
        if edge is None:
            away = np.where(vector @ own < 0.0, np.linalg.norm(vector, axis=1), away)
        else:
            beyond[k] = vector @ edge
        slants.append(0.0 if edge is None else -(left @ edge) / (own @ edge))
    reach, more = half.max(), slants[1] - slants[0]
    lengths = np.stack([length + more * np.clip(across, -reach, reach), *np.full((2, n), length + more * reach)])
    lengths[2] = length - more * reach
    # Where the two ends cross before the strip's side is reached, it is open whether it is there between them.
    crossed, between = lengths[0] <= 0.0, (beyond[0] < 0.0) & (beyond[1] < 0.0)
    either = np.where(between, OPEN, -np.abs(beyond).min(axis=0))
    inside = np.where(crossed, np.minimum(either, reach - away), beyond.min(axis=0))
    part = np.clip((along - slants[0] * across) / np.where(lengths > 0.0, lengths, np.inf), 0.0, 1.0)
    part[1:, (lengths <= 0.0).any(axis=0)] = np.array([[0.0], [1.0]])
    # Evenly along the segment on the screen is not evenly along it in space.
    ratio = w[1] + part * (w[0] - w[1])
    change = np.where((part[0] > 0.0) & (part[0] < 1.0), w[0] * w[1] / ratio[0] ** 2 / length, 0.0)
    return pixel, part * w[0] / ratio, change, away, inside


# -------------------------------------------------------------------------------------------------------- the picture


def _nearest(fragments: list[_Fragments], camera: _Camera, look: Look) -> Picture:
    """Choose the nearest fragment of each pixel, and say how far that choice is from another."""
    shape = camera.size[::-1]
    n = shape[0] * shape[1]
    kind, owner, t = np.zeros(n, np.int64), np.full(n, -1), np.zeros(n)
    depth, ink, margin, gap, slack = np.ones(n), np.zeros(n), np.full(n, np.inf), np.full(n, np.inf), np.zeros(n)
    if fragments:
        every = _Fragments(
            *(np.concatenate([getattr(f, field.name) for f in fragments]) for field in fields(_Fragments))
        )
        line, half = camera.widths(every.axis)
        fits = (half * every.mask - every.away) / np.hypot(1.0, half * every.slope)
        inside = np.where(every.inside < 0.0, every.inside, np.minimum(every.inside, fits))
        inked = line * every.mask - every.away
        behind = look.max_displacement * displaced(every.away / half, look.displacement)
        at_axis = camera.depth(every.axis)
        at = np.where(inked >= 0.0, at_axis, camera.depth(every.axis, behind))
        there = np.flatnonzero(inside >= 0.0)
        there = there[np.lexsort((at[there], every.pixel[there]))]
        first = np.diff(every.pixel[there], prepend=-1) != 0
        shown, others = there[first], there[~first]
        where = every.pixel[shown]
        kind[where] = np.where(inked[shown] >= 0.0, LINE, HALO)
        owner[where], t[where], depth[where] = every.owner[shown], every.t[shown], at[shown]
        ink[where] = np.clip(0.5 + inked[shown], 0.0, 1.0) if look.smooth else inked[shown] >= 0.0
        np.minimum.at(gap, every.pixel[others], (at - every.deep)[others])
        gap[where] -= (at + every.deep)[shown]
        slack[where] = every.deep[shown]
        # Of what lies behind the pixel's depth even as line, no edge matters.
        matters = (kind[every.pixel] == NOTHING) | (at_axis - every.deep <= depth[every.pixel])
        edge = np.abs(inked) / np.hypot(1.0, line * every.slope) - line * every.wide
        near = np.minimum(np.abs(inside) - half * every.wide, np.where(inside > -1.0, edge, np.inf))
        np.minimum.at(margin, every.pixel[matters], np.maximum(near, 0.0)[matters])
    return Picture(*(a.reshape(shape) for a in (kind, owner, t, depth, ink, margin, gap, slack)))
