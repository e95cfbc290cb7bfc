"""Whole pictures of spline tubes against float64: how far off their depth is, and whether they show what is nearest."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from pvfiblets.engine import View
from pvfiblets.engine.gbuffer import EMPTY
from pvfiblets.engine.tubes import SOLVERS, TubeRenderer, TubeStyle
from pvfiblets.report.cameras import Lens, orbit
from pvfiblets.report.tubes_rays import GOAL, clearance, radius_at, share, summary
from pvfiblets.tubes import curves
from pvfiblets.tubes.reference import ENTRY, EXIT, MISS, hits

BLOCK = 8192
REDUCED = 4  # times smaller each way: the pictures in which all solvers are compared
NEAREST = 1000  # pixels whose nearest tube is looked for among all
LIKE_DEFAULT = 4000  # pixels that solvers are compared by


class Picture:
    """What a picture shows, by its pixels in rows from below.

    Attributes
    ----------
    covered : numpy.ndarray
        (n,) bool.
    owner : numpy.ndarray
        (n,) segments.
    place : numpy.ndarray
        (n,) parameter of the segment, 0 to 1.
    """

    def __init__(self, gbuffer: Any, lens: Lens) -> None:
        keys = np.frombuffer(gbuffer.depth.read(), np.uint32)
        self.lens, self.covered = lens, keys != EMPTY
        self.owner = np.frombuffer(gbuffer.owner.read(), np.uint32).astype(np.int64)
        self.place = np.frombuffer(gbuffer.position.read(), np.float32).reshape(-1, 2)[:, 0].astype(np.float64)
        self._farness = (EMPTY - keys.astype(np.float64)) / EMPTY

    def along(self, pixels: np.ndarray, forwards: np.ndarray) -> np.ndarray:
        """Return mm along each pixel's ray to the depth as stored."""
        return self.lens.distance(self._farness[pixels]) / forwards

    @property
    def rim(self) -> np.ndarray:
        """Empty pixels next to covered ones, holes among them."""
        width, height = self.lens.size
        grid = np.pad(self.covered.reshape(height, width), 1)
        near = grid[:-2, 1:-1] | grid[2:, 1:-1] | grid[1:-1, :-2] | grid[1:-1, 2:]
        return np.flatnonzero(near.ravel() & ~self.covered)


def widened(tubes: Any, segments: np.ndarray, lens: Lens, min_width: float = 1.0) -> np.ndarray:
    """Return (k, 2, 3, 4) halves as the picture has them: control radii of so many pixels at least."""
    found = curves.controls(tubes, segments)
    least = 0.5 * min_width * lens.pixel
    for half, control in ((0, 0), (0, 1), (1, 1), (1, 2)):
        ball = found[:, half, control]
        ball[:, 3] = np.maximum(ball[:, 3], least * np.maximum((ball[:, :3] - lens.eye) @ -lens.backwards, 0.0))
    found[:, 0, 2, 3] = found[:, 1, 0, 3] = 0.5 * (found[:, 0, 1, 3] + found[:, 1, 1, 3])
    return found


def compared(tubes: Any, picture: Picture, pixels: np.ndarray, min_width: float = 1.0) -> tuple[dict[str, Any], Any]:
    """Return errors of covered pixels against the very segments that they show, and these: pixels, l and radius, mm.

    ``depth`` is the error of the depth as stored; ``t`` that of the point where the ray enters the sphere of the
    parameter stored; ``format`` what storing the right depth in float32 would cost alone. Pixels whose ray begins
    inside of the segment are counted and left out.
    """
    lens = picture.lens
    directions, forwards = lens.rays(pixels)
    both = widened(tubes, picture.owner[pixels], lens, min_width)
    limits = {"start": lens.near / forwards, "end": lens.far / forwards * (1.0 + 1e-6)}
    met = [hits(both[:, half], lens.eye, directions, **limits) for half in (0, 1)]
    which = np.where(np.nan_to_num(met[1].l, nan=np.inf) < np.nan_to_num(met[0].l, nan=np.inf), 1, 0)
    l, t, kind = (np.choose(which, [getattr(one, name) for one in met]) for name in ("l", "t", "kind"))  # noqa: E741
    inside, false = kind == EXIT, kind == MISS
    rows = np.arange(len(pixels))
    radius = radius_at(both[rows, which], t)
    off = np.abs(apart(both[false], lens, directions[false]))
    w = picture.along(pixels, forwards)
    stored = lens.depth(l * forwards).astype(np.float32).astype(np.float64)
    ideal = lens.distance(1.0 - stored) / forwards
    second = picture.place[pixels] >= 0.5
    sphere = curves.evaluate(both[rows, second.astype(int)], 2.0 * picture.place[pixels] - second)
    to = sphere[:, :3] - lens.eye
    h = np.einsum("ni,ni->n", to, directions)
    aside = np.linalg.norm(to - h[:, None] * directions, axis=1)
    point = h - np.sqrt(np.maximum(sphere[:, 3] ** 2 - aside**2, 0.0))
    result: dict[str, Any] = {"inside": share(inside), "pixels": int((~inside).sum())}
    for name, value in (("depth", w), ("t", point), ("format", ideal)):
        error = np.abs(value - l) / radius
        error[false] = off / radius[false]
        result[name] = summary(error[~inside], np.zeros(int((~inside).sum()), bool), false[~inside])
    entered = np.flatnonzero(kind == ENTRY)
    return result, (pixels[entered], l[entered], radius[entered])


def apart(both: np.ndarray, lens: Lens, directions: np.ndarray) -> np.ndarray:
    """Return (n,) mm from rays to their segments, (n, 2, 3, 4) halves; negative where they meet."""
    eyes = np.broadcast_to(lens.eye, directions.shape)
    return np.minimum(*(clearance(both[:, half], eyes, directions) for half in (0, 1)))


def nearest(tubes: Any, lens: Lens, pixels: np.ndarray, end: np.ndarray, min_width: float = 1.0) -> Any:
    """Return of the nearest entry before `end`, (n,) mm, of all halves: l, infinite if none; radius; segment or -1."""
    directions, forwards = lens.rays(pixels)
    tangents = -(directions @ lens.axes[:2].T) / (directions @ lens.axes[2])[:, None]
    order = np.argsort(tangents[:, 0])
    sorted_x = tangents[order, 0]
    found = np.full(len(pixels), np.inf)
    radius, segment = np.ones(len(pixels)), np.full(len(pixels), -1)
    for first in range(0, tubes.n_segments, BLOCK // 2):
        chosen = np.arange(first, min(first + BLOCK // 2, tubes.n_segments))
        halves = widened(tubes, chosen, lens, min_width).reshape(-1, 3, 4)
        centre = halves[..., :3].mean(axis=1)
        reach = (np.linalg.norm(halves[..., :3] - centre[:, None], axis=2) + halves[..., 3]).max(axis=1)
        reach *= 1.0 + 1e-9
        local = (centre - lens.eye) @ lens.axes.T
        low_x, high_x = _tangents(local[:, 0], -local[:, 2], reach)
        low_y, high_y = _tangents(local[:, 1], -local[:, 2], reach)
        begin, stop = np.searchsorted(sorted_x, low_x), np.searchsorted(sorted_x, high_x, "right")
        count = np.where(reach - local[:, 2] > lens.near, stop - begin, 0)
        half = np.repeat(np.arange(len(halves)), count)
        ray = order[np.arange(len(half)) - np.repeat(np.cumsum(count) - count, count) + begin[half]]
        y = tangents[ray, 1]
        keep = (y >= low_y[half]) & (y <= high_y[half])
        half, ray = half[keep], ray[keep]
        away = centre[half] - lens.eye
        along = np.einsum("ni,ni->n", away, directions[ray])
        beside = np.linalg.norm(away - along[:, None] * directions[ray], axis=1)
        keep = (beside <= reach[half]) & (along - reach[half] < np.minimum(end, found)[ray])
        half, ray = half[keep], ray[keep]
        met = hits(halves[half], lens.eye, directions[ray], start=lens.near / forwards[ray], end=end[ray])
        entered = np.flatnonzero(met.kind == ENTRY)
        entered = entered[np.lexsort((met.l[entered], ray[entered]))]
        entered = entered[np.diff(ray[entered], prepend=-1) != 0]
        entered = entered[met.l[entered] < found[ray[entered]]]
        at = ray[entered]
        found[at], segment[at] = met.l[entered], chosen[half[entered] // 2]
        radius[at] = radius_at(halves[half[entered]], met.t[entered])
    return found, radius, segment


def _tangents(x: np.ndarray, w: np.ndarray, reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return between which tangents spheres are seen."""
    distance = np.hypot(x, w)
    with np.errstate(invalid="ignore", divide="ignore"):
        wide = np.arcsin(np.minimum(reach / distance, 1.0))
        middle = np.arctan2(x, w)
        low, high = middle - wide, middle + wide
    behind = ~(distance > reach)
    edge = np.pi / 2 - 1e-6
    return (
        np.where(behind | (low < -edge), -np.inf, np.tan(np.clip(low, -edge, edge))),
        np.where(behind | (high > edge), np.inf, np.tan(np.clip(high, -edge, edge))),
    )


def whole(tubes: Any, picture: Picture, count: int, rng: Any) -> dict[str, Any]:
    """Return all that is measured of a picture by default settings, by so many of its pixels at most."""
    covered = np.flatnonzero(picture.covered)
    result, (pixels, l, radius) = compared(tubes, picture, some(covered, count, rng))  # noqa: E741
    few = some(np.arange(len(pixels)), NEAREST, rng)
    first, _, _ = nearest(tubes, picture.lens, pixels[few], l[few])
    gap = np.where(np.isfinite(first), l[few] - first, 0.0) / radius[few]
    rim = some(picture.rim, NEAREST, rng)
    limit = picture.lens.far / picture.lens.rays(rim)[1]
    first, around, segment = nearest(tubes, picture.lens, rim, limit)
    holes = np.flatnonzero(np.isfinite(first))
    directions = picture.lens.rays(rim[holes])[0]
    both = widened(tubes, segment[holes], picture.lens)
    deep = -apart(both, picture.lens, directions) / around[holes]
    return result | {
        "covered": int(picture.covered.sum()),
        "not_nearest": share(gap > GOAL), "not_nearest_by": float(gap.max(initial=0.0)), "nearest_pixels": len(few),
        "holes": share(np.isfinite(first)), "hole_depth": float(deep.max(initial=0.0)), "rim_pixels": len(rim),
    }  # fmt: skip


def some(pixels: np.ndarray, count: int, rng: Any) -> np.ndarray:
    """Return so many of some numbers at most, each once."""
    return pixels if len(pixels) <= count else np.sort(rng.choice(pixels, count, replace=False))


def frames(ctx: Any, renderer: Any, lenses: list[Lens], count: int, seconds: float) -> tuple[list[float], Picture]:
    """Draw lenses in turn; return ms of each picture, and the last one."""
    took: list[float] = []
    for lens in lenses[:count]:
        view = View(lens.size, lens.matrix)
        begin = time.perf_counter()
        gbuffer = renderer.render(view, TubeStyle())
        ctx.finish()
        took.append(1e3 * (time.perf_counter() - begin))
        if sum(took) > 1e3 * seconds:
            break
    return took, Picture(gbuffer, lens)


def measured(ctx: Any, name: str, tubes: Any, options: Any) -> list[dict[str, Any]]:
    """Return a row for each view by default settings, and one for each view and solver in small pictures."""
    rows = []
    size = tuple(options.size)
    small = tuple(max(16, n // REDUCED) for n in size)
    rng = np.random.default_rng(1)
    lenses = {
        (view, this): [Lens.of(camera) for camera in orbit(tubes, view, max(options.frames, 2), this)]
        for view in ("far", "close")
        for this in (size, small)
    }
    for solver in ("auto", *SOLVERS):
        renderer = TubeRenderer(ctx, tubes, solver=solver)
        try:
            for view in ("far", "close"):
                frames(ctx, renderer, lenses[view, small][1:], 1, 0.0)  # what is compiled when first drawn
                chosen = lenses[view, size if solver == "auto" else small]
                took, picture = frames(ctx, renderer, chosen, options.frames, options.seconds)
                if solver == "auto":
                    found = whole(tubes, picture, options.pixels, rng)
                else:
                    covered = np.flatnonzero(picture.covered)
                    found, _ = compared(tubes, picture, some(covered, min(LIKE_DEFAULT, options.pixels), rng))
                rows.append({
                    "set": name, "view": view, "solver": renderer.solver, "iterations": renderer.iterations,
                    "default": solver == "auto", "size": list(picture.lens.size), "frames": len(took),
                    "ms": float(np.median(took)), **found,
                })  # fmt: skip
                ms, error = rows[-1]["ms"], found["depth"]["p99.9"]
                print(f"{name}, {view}, {solver}: {ms:.0f} ms, p99.9 {error:.1e}", flush=True)
        finally:
            renderer.release()
    return rows
