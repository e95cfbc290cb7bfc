"""The fragments of strips in float64: the part of the reference of halos that lines need.

Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009), sections 3.2, 3.4 and 3.6.

The strip of a segment is all that is within half a strip's width of it in the window. Of a pixel, the foot is the
nearest place of the segment there, and everything is taken at the foot: depth and W, and linear along the segment in
space the mask's u, depth cueing, and the number that filters with how fast it changes. The axis ends square where a
line does, and where planes or the view cut it. Where two segments meet, either goes on round. At bends of up to 60
degrees a pixel belongs to the one on its side of the bisector; at sharper ones, and where a strip's half width changes
by more than half a pixel per pixel along either, to both, and the nearer shows. Segments without length on the screen
show nothing themselves.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from pvfiblets.halos.geometry import HaloLines
from pvfiblets.halos.style import HaloStyle

from .camera_reference import Array, Camera, Fragments, Ints, between, box, kept

SHORT = 1e-6  # pixels: a segment that takes no more of the screen has no direction there

SHARPEST = 0.5  # cosine of the sharpest bend that is divided by its bisector

STEEPEST = 0.5  # pixels of half width per pixel along a segment, up to which that is so

FOLDED = 1.5  # half widths from the axis: where bisectors cross before, it is open what of a strip is beyond them

CLOSE = 0.1  # pixels from a bisector within which it is noted whether both segments of the bend are there

OPEN = -np.finfo(np.float64).tiny  # pixels within: not there, and yet as near to it as can be

PLATEAU = 0.2  # places along the mask from where on it is as wide as the strip

STEP = 0.02  # pixels along the axis over which slopes are taken


def mask(x: Array) -> Array:
    """Width of the mask over the strip's, by how far along its round end a place is, 0 at the tip to 1."""
    x = np.clip(x, 0.0, 1.0)
    return np.sqrt(x * (2.0 - x))


def places_along(count: int, n_tapered: int, t_tapered: float) -> Array:
    """Places ``u`` along the mask of the vertices of a line (section 3.4), rounded to 16 bits."""
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
    """Change of numbers per mm at the vertices: the mean over the segments beside each, 0 where there is none."""
    # Segments without length, or with a NaN, do not count.
    first = _firsts(offsets)
    with np.errstate(divide="ignore", invalid="ignore"):
        steep = np.abs(numbers[first + 1] - numbers[first]) / np.linalg.norm(points[first + 1] - points[first], axis=1)
    first, steep = first[np.isfinite(steep)], steep[np.isfinite(steep)]
    ends = np.concatenate([first, first + 1])
    sums = np.bincount(ends, np.tile(steep, 2), len(points))
    return sums / np.maximum(np.bincount(ends, minlength=len(points)), 1)


def strips(
    camera: Camera, look: HaloStyle, lines: HaloLines, clip: Array, heights: Array, numbers: Array | None
) -> Iterator[Fragments]:
    """Yield the fragments of all segments."""
    points = np.asarray(lines.points, np.float64)
    cue, u, steep = camera.cue(points), np.full(len(clip), 0.5), np.zeros(len(clip))
    if look.n_tapered:
        for a, b in zip(lines.offsets[:-1], lines.offsets[1:], strict=True):
            u[a:b] = places_along(int(b - a), look.n_tapered, look.t_tapered)
    if numbers is not None:
        steep = rates(points, lines.offsets, numbers)
    firsts = _firsts(lines.offsets)
    known = set(firsts.tolist())
    for i in firsts.tolist():
        both = slice(i, i + 2)
        start, end = kept(heights[i], heights[i + 1])
        if start > end or (numbers is not None and np.isnan(numbers[both]).any()):
            continue
        before = _bend(camera, look, clip, i, i - 1, i) if start == 0.0 and i - 1 in known else None
        after = _bend(camera, look, clip, i + 1, i + 1, i) if end == 1.0 and i + 1 in known else None
        varying = _Varying(
            camera, look, clip[both], cue[both], u[both], None if numbers is None else numbers[both], steep[both]
        )
        yield from _strip(camera, varying, i, (start, end), (before, after))


def _firsts(offsets: Ints) -> Ints:
    """First points of all segments."""
    last = np.zeros(int(offsets[-1]) + 1, bool)
    last[offsets[1:] - 1] = True  # a line without points marks what another one does, or the entry that falls away
    return np.flatnonzero(~last[:-1])


# ------------------------------------------------------------------------------------------------------------- bends


def _bend(camera: Camera, look: HaloStyle, clip: Array, vertex: int, neighbour: int, own: int) -> Array:
    """Return the unit normal, along the line, of the bisector at a vertex between two segments; 0, 0 for none."""
    ways = [clip[i + 1] - clip[i] for i in (neighbour, own)]
    motions = [camera.motion(clip[vertex], way) for way in ways]
    lengths = [float(np.linalg.norm(motion)) for motion in motions]
    if min(lengths) <= SHORT:
        return np.zeros(2)
    change = look.strip_width / 2.0 * camera.scale / clip[vertex, 3] ** 2
    if any(change * abs(way[3]) > STEEPEST * n for way, n in zip(ways, lengths, strict=True)):
        return np.zeros(2)
    one, other = (motion / n for motion, n in zip(motions, lengths, strict=True))
    if one @ other < SHARPEST:
        return np.zeros(2)
    mean = one + other
    return np.asarray(mean / np.linalg.norm(mean))


# ------------------------------------------------------------------------------------------------------- one segment


@dataclass(frozen=True, eq=False)
class _Varying:
    """Quantities that vary along one segment, by its two ends."""

    camera: Camera
    look: HaloStyle
    clip: Array
    cue: Array
    u: Array
    numbers: Array | None
    steep: Array  # of the numbers, per mm

    def places(self, s: Array, part: tuple[float, float]) -> Array:
        """Places on the segment that are linearly s along a part of it in the window."""
        w = between(self.clip[:, 3], np.asarray(part))
        return part[0] + (part[1] - part[0]) * (s / w[1] / ((1.0 - s) / w[0] + s / w[1]))

    def half_widths(self, t: Array) -> tuple[Array, Array]:
        """Return the widths of line and strip without the mask, pixels."""
        return self.camera.widths(between(self.clip[:, 3], t), between(self.cue, t))

    def edges(self, t: Array) -> tuple[Array, Array, Array | None]:
        """Half widths that the mask leaves of line and strip, pixels, and how far the number is within thresholds."""
        m = self._mask(t)
        line, half = self.half_widths(t)
        return line * m, half * m, None if self.numbers is None else self._passes(self.numbers, t)

    def _mask(self, t: Array) -> Array:
        u = between(self.u, t)
        m = mask(np.minimum(u, 1.0 - u) / PLATEAU)
        if self.numbers is None or self.look.filter_taper == 0.0:
            return m
        fall = between(self.steep, t) * self.look.filter_taper
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.minimum(m, mask(np.where(fall > 0.0, self._passes(self.numbers, t) / fall, 1.0)))

    def _passes(self, numbers: Array, t: Array) -> Array:
        # The same number at both ends is that number between them, to the last digit.
        value = numbers[0] + t * (numbers[1] - numbers[0])
        return np.minimum(value - self.look.low, self.look.high - value)


def _strip(
    camera: Camera, varying: _Varying, owner: int, part: tuple[float, float], bends: tuple[Array | None, Array | None]
) -> Iterator[Fragments]:
    """Yield the fragments of the part of a segment, whose ends are square where there is no bend."""
    ends = between(varying.clip, np.asarray(part))
    if not (ends[:, 3] > 0.0).all():
        return
    a, b = camera.pixels(ends)
    length = float(np.linalg.norm(b - a))
    if length <= SHORT:
        return
    own = (b - a) / length
    # Widths are greatest at an end.
    reach = max(float(n.max()) for n in varying.half_widths(np.asarray(part)))
    pixel, at = box(camera, np.stack([a, b]), reach + 2.0)
    along = (at - a) @ own
    s = np.clip(along / length, 0.0, 1.0)
    away = np.linalg.norm(at - a - (length * s)[:, None] * own, axis=1)
    near = away < reach + 2.0
    pixel, at, along, s, away = pixel[near], at[near], along[near], s[near], away[near]
    t = varying.places(s, part)

    # By how much edges recede per pixel along the axis: nothing where the foot stays.
    later, earlier = (np.clip((along + step) / length, 0.0, 1.0) for step in (STEP, -STEP))
    span = np.maximum((later - earlier) * length, 1e-12)
    (line_1, half_1, passes_1), (line_0, half_0, passes_0) = (
        varying.edges(varying.places(place, part)) for place in (later, earlier)
    )
    line, half, passes = varying.edges(t)
    inked, room = line - away, half - away
    edge = np.abs(inked) / np.hypot(1.0, (line_1 - line_0) / span)
    room /= np.hypot(1.0, (half_1 - half_0) / span)
    if passes is not None and passes_1 is not None and passes_0 is not None:
        room = np.minimum(room, _in_pixels(passes, (passes_1 - passes_0) / span))
    if bends[0] is None:
        room = np.minimum(room, along)
    if bends[1] is None:
        room = np.minimum(room, length - along)
    none = np.full(len(pixel), np.inf)
    after = (at - a) @ bends[0] if bends[0] is not None and bends[0].any() else none
    before = (b - at) @ bends[1] if bends[1] is not None and bends[1].any() else none
    inside = np.minimum(np.minimum(room, after), before)
    at_start = np.where(np.abs(after) < CLOSE, np.minimum(room, before), -1.0)
    at_end = np.where(np.abs(before) < CLOSE, np.minimum(room, after), -1.0)
    if _folded(own, length, FOLDED * reach, bends):
        inside = np.where((room >= 0.0) & (inside < 0.0), OPEN, inside)
    foot, whole = between(varying.clip, t), varying.half_widths(t)[1]
    yield Fragments(pixel, np.full(len(pixel), owner), t, foot, away / whole, inside, at_start, at_end, inked, edge)


def _in_pixels(above: Array, per_pixel: Array) -> Array:
    """Distance along the axis at which a value so far above 0 reaches it; infinite if it does not change."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(per_pixel != 0.0, above / np.abs(per_pixel), np.where(above >= 0.0, np.inf, -np.inf))


def _folded(own: Array, length: float, reach: float, bends: tuple[Array | None, Array | None]) -> bool:
    """Return whether the edges across both ends of a strip meet within its reach."""
    left = np.array([-own[1], own[0]])
    start, end = (0.0 if bend is None or not bend.any() else float(left @ bend) / float(own @ bend) for bend in bends)
    return length < abs(end - start) * reach
