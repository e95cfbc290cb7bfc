"""How stiff a spline tube may be before float32 shows, by sweeps of one ratio each; and halves against their cubics."""

from __future__ import annotations

from typing import Any

import numpy as np
from tube_error_pictures import Picture, nearest

from pvfiblets import SplineTubes
from pvfiblets.engine import View
from pvfiblets.engine.tubes import TubeRenderer, TubeStyle
from pvfiblets.engine.tubes.solver_probe import SolverProbe
from pvfiblets.report.cameras import Lens, unit
from pvfiblets.report.tubes_rays import GOAL, clearance, share, summary
from pvfiblets.report.tubes_sweeps import SWEEPS
from pvfiblets.tubes import curves

LIMITS = (GOAL, 1e-2)  # of the radius
EXTENT = 24.0  # radii from the middle of the tubes that pictures sweep to their ends


EYES = (1.1, 1.5, 3.0, 10.0, *(10.0**k for k in range(2, 8)))
OFFSETS = (0.0, 1.0, *(10.0**k for k in range(1, 8)))
PICTURES = {"eye": ("distance of the eye over radius", EYES), "offset": ("distance from 0 over extent", OFFSETS)}
ABOUT = {name: sweep[0] for name, sweep in (SWEEPS | PICTURES).items()}


def swept(ctx: Any, way: tuple[str, str, bool, int], options: Any) -> list[dict[str, Any]]:
    """Return a row for each sweep and ratio by one way: its name, solver, whether by the chain, iterations."""
    name, solver, chain, iterations = way
    rows = []
    probe = SolverProbe(ctx, solver, iterations, chain=chain)
    for key, (_, ratios, make) in SWEEPS.items():
        for ratio in ratios:
            rays = make(ratio, options.rays // 4, np.random.default_rng(3))
            rows.append(
                {
                    "sweep": key,
                    "ratio": ratio,
                    "way": name,
                    **rays.errors(*probe.hits(rays.controls, rays.origins, rays.directions)),
                }
            )
    probe.release()
    for key, ratio, tubes, lens in pictures(options):
        renderer = TubeRenderer(ctx, tubes, solver=solver, iterations=iterations)
        try:
            picture = Picture(renderer.render(View(lens.size, lens.matrix), TubeStyle(min_width=0.0)), lens)
        finally:
            renderer.release()
        rows.append({"sweep": key, "ratio": ratio, "way": name, **judged(tubes, picture)})
    return rows


def pictures(options: Any) -> list[tuple[str, float, SplineTubes, Lens]]:
    """Return sweep, ratio, tubes and lens of the sweeps that need whole pictures: of the eye's place and the tubes'."""
    size = (96, 96) if options.rays >= 8192 else (48, 48)
    backwards = unit(np.array([0.2, 1.0, 0.3]))
    tubes = nine_tubes(np.zeros(3))
    found = []
    for ratio in EYES:
        # From far off through a long lens, so that the tubes fill the picture as they do from near.
        slant = min(EXTENT / ratio, 1.0)
        lens = Lens(size, ratio * backwards, backwards, slant, max(ratio - EXTENT, 0.5 * (ratio - 1.0)), ratio + EXTENT)
        found.append(("eye", ratio, tubes, lens))
    for ratio in OFFSETS:
        centre = 2.0 * EXTENT * ratio * unit(np.array([1.0, -0.7, 0.4]))
        lens = Lens(size, centre + 60.0 * backwards, backwards, EXTENT / 60.0, 60.0 - EXTENT, 60.0 + EXTENT)
        found.append(("offset", ratio, nine_tubes(centre), lens))
    return found


def nine_tubes(centre: np.ndarray) -> SplineTubes:
    """Return bent tubes beside each other, of a radius of about 1 and 10 long; the first is straight, in the middle."""
    rng = np.random.default_rng(5)
    grid = 11.0 * np.array([[x, y, 0.0] for y in (0, -1, 1) for x in (0, -1, 1)])
    frame = Lens((1, 1), np.zeros(3), unit(np.array([0.2, 1.0, 0.3])), 1.0, 1.0, 2.0).axes
    middles = grid @ frame
    run = 5.0 * unit(rng.normal(size=(9, 3)))
    run[0] = 5.0 * frame[0]
    bends = 2.0 * run[:, None] + rng.normal(0.0, 3.0, (9, 2, 3)) * (np.arange(9) > 0)[:, None, None]
    ends = np.stack([middles - run, middles + run], axis=1)
    radius = rng.uniform(0.8, 1.2, (9, 2))
    slopes = rng.normal(0.0, 0.3, (9, 2))
    radius[0], slopes[0] = 1.0, 0.0
    return SplineTubes(
        points=ends.reshape(-1, 3) + centre, segments=np.arange(18).reshape(9, 2), radius=radius.ravel(),
        tangents=bends.reshape(-1, 3), radius_slopes=slopes.ravel(), scaled=False, tubes=np.arange(9), n_tubes=9,
    )  # fmt: skip


def judged(tubes: SplineTubes, picture: Picture) -> dict[str, float]:
    """Return errors of all pixels of a picture, widened by nothing, against what is nearest in each."""
    lens = picture.lens
    pixels = np.arange(len(picture.covered))
    directions, forwards = lens.rays(pixels)
    true, radius, _ = nearest(tubes, lens, pixels, lens.far / forwards, 0.0)
    should, met = np.isfinite(true), picture.covered
    error = np.where(should & met, np.abs(picture.along(pixels, forwards) - np.where(should, true, 0.0)), 0.0)
    flipped = np.flatnonzero(should != met)
    if len(flipped):
        each = curves.controls(tubes).reshape(-1, 3, 4)
        eyes = np.broadcast_to(lens.eye, (len(each), 3))
        error[flipped] = [
            abs(clearance(each, eyes, np.broadcast_to(directions[pixel], (len(each), 3))).min()) for pixel in flipped
        ]
    touched = should | met
    result = summary((error / radius)[touched], (should & ~met)[touched], (met & ~should)[touched])
    stored = lens.depth(np.where(should, true, lens.far) * forwards).astype(np.float32).astype(np.float64)
    ideal = np.abs(lens.distance(1.0 - stored) / forwards - true)[should] / radius[should]
    return result | {"format_p99": float(np.quantile(ideal, 0.99))}


def holding(rows: list[dict[str, Any]], limit: float) -> tuple[float | None, float | None]:
    """Return the last ratio of a sweep up to which the 99th percentile keeps to a limit, and the first that fails."""
    held = None
    for row in rows:
        if row["p99"] > limit:
            return held, row["ratio"]
        held = row["ratio"]
    return held, None


def approximation(name: str, tubes: Any, options: Any) -> list[dict[str, Any]]:
    """Return how far halves are from cubics, over the least radius of their segment, by both shares of a derivative."""
    rng = np.random.default_rng(2)
    chosen = rng.permutation(tubes.n_segments)[: options.segments]
    radius = np.maximum(tubes.radius[tubes.segments[chosen]].min(axis=1), 1e-300)
    rows = []
    for middle in (curves.MIDDLE, 1.0 / 3.0):
        off = curves.deviations(tubes, chosen, middle, 32).sum(axis=1) / radius
        middle_, high, highest = (float(q) for q in np.quantile(off, (0.5, 0.99, 1.0)))
        rows.append({"set": name, "share": middle, "segments": len(chosen), "p50": middle_, "p99": high,
                     "max": highest, "above_goal": share(off > GOAL)})  # fmt: skip
    return rows
