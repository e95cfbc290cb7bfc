"""The study of ray-cast spline tubes: solvers by iterations, whole pictures, float32's limits, and stored depth."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from pvfiblets.tubes import SplineTubes, curves

from ...cameras import VIEWS, Camera, by_turns, orbit
from ...drawing import Part, WindowPart, run_parts
from ...record import Axes, Figure, Record
from ...study import LATE, Options, Study
from ...timing import Comparison
from .drawings import CastTubes, Drawing, drawings
from .pictures import FORMATS, Truth, helices, sampled
from .rays import GOAL
from .solvers import SET_SIZE, SETS, ray_sweeps, solvers
from .sweeps import PICTURE_SWEEPS

if TYPE_CHECKING:
    import moderngl

__all__ = ["STUDY"]

SIZE, QUICK_SIZE = (480, 270), (160, 90)
TUBES = 6  # helices of 24 segments each
RANGES = (10.0, 1e2, 1e3, 1e4, 1e5, 1e6)  # far over near
QUICK_RANGES = (10.0, 1e3, 1e6)
QUICK_SETS = ("fibers",)
SAMPLE, QUICK_SAMPLE = 1000, 200  # pixels of these that are compared with float64
SEGMENTS = 20_000  # of a set that are compared with their cubics


# ----------------------------------------------------------------------------------------------------------- the parts


def picture_sweeps(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
    """Yield records of whole small pictures by ratio: how far the eye is, and how far the tubes are from 0."""
    for name, (about, ratios, make) in PICTURE_SWEEPS.items():
        if not options.allows(f"sweep of {about}"):
            continue
        errors: dict[str, dict[str, Figure]] = {}
        for ratio in ratios[:: 3 if options.quick else 1]:
            tubes, camera = make(ratio)
            truth = Truth.from_tubes(tubes, camera)
            by = {}
            for solver in ("auto", "bisection"):
                drawn = CastTubes(ctx, tubes, solver)
                try:
                    drawn.draw(camera)
                    by[drawn.setting] = truth.errors(*drawn.visible(camera))["depth p99"]
                finally:
                    drawn.release()
            by["right, stored as float32"] = truth.stored(FORMATS["float32"])
            for solver, p99 in by.items():
                errors.setdefault(solver, {})[f"p99 at ratio {ratio:g}"] = Figure(p99, "radii")
        for number, (solver, found) in enumerate(errors.items()):
            yield Record(
                about, "stiff", f"pictures by {name}", "ray cast" if number < 2 else solver,
                solver if number < 2 else "", found, ours=number == 0,
            )  # fmt: skip


def pictures(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
    """Yield records of whole pictures: silhouettes and depths against float64, and what a picture takes."""
    yield from _helices("", partial(drawings, ctx), options)


def sets(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
    """Yield records of pictures of the paper's sets by every solver, against float64 in a sample of the pixels."""
    from pvfiblets.engine.tubes import SOLVERS

    def solvers_of(tubes: SplineTubes, _: tuple[int, int]) -> list[Callable[[], Drawing]]:
        return [partial(CastTubes, ctx, tubes, solver) for solver in ("auto", *list(SOLVERS)[1:])]

    yield from _sets("", solvers_of, options)


def in_windows(options: Options) -> Iterator[Record]:
    """Yield records of the same pictures in windows, beside VTK's meshes."""
    from .windows import window_drawings

    half = options.share(0.5)
    yield from _helices(", in a window", window_drawings, half)
    yield from _sets(", in a window", window_drawings, options)


Makers = Callable[[SplineTubes, tuple[int, int]], list[Callable[[], Drawing]]]


def _helices(where: str, makers: Makers, options: Options) -> Iterator[Record]:
    """Compare all pixels of pictures of helices."""
    size = QUICK_SIZE if options.quick else SIZE
    tubes = helices(TUBES)
    for view in VIEWS:
        name = f"{TUBES} helices, {view}{where}"
        if not options.allows(name):
            continue
        camera = orbit(tubes, view, 2, size)[0]
        truth = Truth.from_tubes(tubes, camera)
        within = options.share()  # the reference took longer than pictures do
        yield from _measured(name, "pictures", camera, makers(tubes, size), _errors_of(truth), within)


def _errors_of(truth: Truth) -> Callable[[Drawing], dict[str, Figure]]:
    units = {"silhouette": "pixels", "depth p50": "radii", "depth p99": "radii"}

    def errors(drawn: Drawing) -> dict[str, Figure]:
        return {key: Figure(value, units[key]) for key, value in truth.errors(*drawn.visible(truth.camera)).items()}

    return errors


def _sets(where: str, makers: Makers, options: Options) -> Iterator[Record]:
    """Compare some pixels of pictures of the paper's sets."""
    from pvfiblets.synthetic.tubes import tube_set

    size = QUICK_SIZE if options.quick else SET_SIZE
    for name in QUICK_SETS if options.quick else SETS:
        tubes = tube_set(name, options.seed)
        for view in VIEWS:
            camera = orbit(tubes, view, 2, size)[0]
            errors = _sampled_errors(tubes, camera, options)
            data = f"the set {name}, {view}{where}"
            yield from _measured(data, "sets", camera, makers(tubes, size), errors, options)


def _sampled_errors(tubes: SplineTubes, camera: Camera, options: Options) -> Callable[[Drawing], dict[str, Figure]]:
    """Return what compares pictures in pixels that are chosen by what the first of them shows."""
    truths: list[Truth] = []

    def errors(drawn: Drawing) -> dict[str, Figure]:
        shown, there = drawn.visible(camera)
        if not truths:
            rng = np.random.default_rng([options.seed, 1])
            count = QUICK_SAMPLE if options.quick else SAMPLE
            truths.append(Truth.from_tubes(tubes, camera, sampled(there.reshape(camera.size[::-1]), count, rng)))
        (truth,) = truths
        here, should = there[truth.pixels], truth.there
        off = truth.depth_errors(shown[truth.pixels], here)
        quantiles = np.quantile(off, (0.5, 0.99, 0.999)) if len(off) else (np.nan,) * 3
        found = {f"depth {q}": Figure(float(value), "radii")
                 for q, value in zip(("p50", "p99", "p99.9"), quantiles, strict=True)}  # fmt: skip
        found["depth p99 by storing"] = Figure(truth.stored(FORMATS["float32"]), "radii")
        for name, wrong, of in (("holes", should & ~here, ~here), ("false", here & ~should, here)):
            found[name] = Figure(100.0 * float(wrong.sum()) / max(int(of.sum()), 1), "%")
        found[f"off by {GOAL:g}"] = Figure(100.0 * float((off > GOAL).mean()) if len(off) else 0.0, "%")
        return found

    return errors


def _measured(
    data: str, group: str, camera: Camera, makers: list[Callable[[], Drawing]],
    errors: Callable[[Drawing], dict[str, Figure]], options: Options,
) -> Iterator[Record]:  # fmt: skip
    """Draw one picture by every method."""
    compared: Comparison | None = None
    made: list[Drawing] = []
    try:
        for number, make in enumerate(makers):
            if compared is None and not options.budget.allows():
                options.leave_out(f"{data}: everything", LATE)
                return
            if compared is not None and not compared.allows(f"method {number + 1}"):
                continue
            drawn = make()
            made.append(drawn)
            drawn.draw(camera)
            record = Record(
                data=data,
                group=group,
                approximation="a picture of tubes",
                method=drawn.method,
                setting=drawn.setting,
                errors=errors(drawn),
                costs={"geometry": Figure(float(drawn.nbytes), "bytes")},
                ours=drawn.ours,
                default=drawn.default,
            )
            compared = compared or Comparison(data, options, drawn.turns)
            compared.add(record, draw=by_turns(drawn.draw, [camera]))
        if compared is not None:
            yield from compared.finish()
    finally:
        for drawn in made:
            drawn.release()


def stored(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
    """Yield records of depth by its stored format, and by the distance between the near and the far plane."""
    tubes, size = helices(2), QUICK_SIZE
    far = orbit(tubes, "far", 2, size)[0]
    truth = Truth.from_tubes(tubes, far)
    drawn = CastTubes(ctx, tubes)
    names = [f"p99 at far/near {ratio:g}" for ratio in (QUICK_RANGES if options.quick else RANGES)]
    errors: dict[str, dict[str, Figure]] = {name: {} for name in ("key of 32 bits, as drawn", *FORMATS)}
    try:
        for name, ratio in zip(names, QUICK_RANGES if options.quick else RANGES, strict=True):
            if not options.allows(f"stored depth: {name}"):
                continue
            camera = replace(far, near=far.far / ratio)
            seen = replace(truth, camera=camera)
            drawn.draw(camera)
            shown = seen.errors(*drawn.visible(seen.camera))["depth p99"]
            errors["key of 32 bits, as drawn"][name] = Figure(shown, "radii")
            for kind, rounded in FORMATS.items():
                errors[kind][name] = Figure(seen.stored(rounded), "radii")
    finally:
        drawn.release()
    for kind, found in errors.items():
        if found:
            bits = 24 if "24" in kind else 32
            yield Record(
                "stored depth", "stored", "depth of a pixel", kind, "", found,
                {"depth": Figure(bits / 8.0, "bytes/pixel")}, ours=kind.startswith("key"),
            )  # fmt: skip


def halves(ctx: moderngl.Context, options: Options) -> Iterator[Record]:  # noqa: ARG001 - as other parts
    """Yield records of how far the two quadratics of a segment are from its cubic, by the share of a derivative."""
    from pvfiblets.synthetic.tubes import tube_set

    rng = np.random.default_rng([options.seed, 2])
    for name in QUICK_SETS if options.quick else SETS:
        if not options.allows(f"quadratics for cubics: {name}"):
            continue
        tubes = tube_set(name, options.seed)
        chosen = rng.permutation(tubes.n_segments)[:SEGMENTS]
        radius = np.maximum(tubes.radius[tubes.segments[chosen]].min(axis=1), 1e-300)
        for share, setting in ((curves.MIDDLE, f"c = {curves.MIDDLE:g}"), (1.0 / 3.0, "c = 1/3, the paper's")):
            off = curves.deviations(tubes, chosen, share, 32).sum(axis=1) / radius
            found = dict(zip(("p50", "p99", "max"), map(float, np.quantile(off, (0.5, 0.99, 1.0))), strict=True))
            yield Record(
                f"cubics of the set {name}", "", "a cubic segment", "two quadratics", setting,
                {f"apart {key}": Figure(value, "radii") for key, value in found.items()},
                ours=share == curves.MIDDLE,
            )  # fmt: skip


PARTS: dict[Part, float] = {
    solvers: 3.0, pictures: 5.0, sets: 4.0, ray_sweeps: 2.0, picture_sweeps: 1.0, stored: 1.0, halves: 1.0,
}  # fmt: skip
IN_WINDOWS: dict[WindowPart, float] = {in_windows: 4.0}  # measurements, and the weight of each part's share of the time


def run(options: Options) -> Iterator[Record]:
    """Yield records part by part, each with its share of what time is left."""
    return run_parts(PARTS, options, IN_WINDOWS)


STUDY = Study(
    name="tubes",
    title="Ray-cast spline tubes",
    approximates=(
        "Intersections of rays with tubes of varying radius, found in float32 by a bounded number of steps: solvers by "
        "iterations, beside the paper's; whole pictures, beside tessellation; depth, by its stored format."
    ),
    axes=(
        Axes("hit-p99", "times/hit", "errors/hit p99", "ns per ray", "99th percentile of errors, radii"),
        Axes("hit-max", "times/hit", "errors/hit max", "ns per ray", "largest error, radii"),
        Axes("silhouette", "times/draw", "errors/silhouette", "ms per frame", "silhouettes off, pixels"),
        Axes("depth", "times/draw", "errors/depth p50", "ms per frame", "median of depth errors, radii"),
        Axes("ratio", "", "errors/p99 at ratio ", "ratio that the title names", "99th percentile, radii", series=True),
        Axes("stored", "", "errors/p99 at far/near ", "far over near plane", "99th percentile, radii", series=True),
    ),
    notes=(
        "The right answer is found in float64 by another method (report/studies/tubes/reference.py: eigenvalues of "
        "companion matrices, nothing is bracketed). Errors are in radii of the sphere that is met: along the ray, "
        "where it meets "
        "the tube and should; where only one of both is so, by how much the radius would have to change to make the "
        "answer right; *missed* and *false* are such rays. Rays pass a sphere of a half segment within 1.15 radii of "
        "its middle. *loop*: one loop for all minima; *chain*: the paper's chain of derivatives "
        "(Russig et al. 2020), which its *bisection* always runs. Solvers end as soon as they are exact: their own "
        "numbers of iterations are bounds that few rays reach.",
        f"Pictures: {SIZE[0]}×{SIZE[1]}, quickly {QUICK_SIZE[0]}×{QUICK_SIZE[1]}, no anti-aliasing; *far* shows "
        "all, *close* is at a third of that distance. Ours draw a G-buffer with depth, place and tangent, not lit. "
        "*tessellated*: hardware tessellation with light (after Nunes et al. 2012), up to 6 steps along a segment; it "
        "draws the cubic itself, which this program's two quadratics differ from (the sets *cubics of*), and circles "
        "across the axis in place of spheres. *silhouettes off*: pixel middles between the picture's outline and the "
        "true one, over the true one's length. *depth* errors are along the ray, where a tube shows and should; "
        "their 99th percentile is that of inner outlines, where another tube shows.",
        f"Sets: the five of Russig et al. 2020, section 4, {SET_SIZE[0]}×{SET_SIZE[1]}; each solver against float64 in "
        f"{SAMPLE} pixels, half of them covered, half empty beside these. *holes*: empty pixels that a "
        "tube covers; *false*: covered pixels without a tube; *depth p99 by storing*: the error of the right depth "
        f"if stored as float32; *off by {GOAL:g}*: share of covered pixels with a larger error.",
        "*stored depth*: the error of rounding the right depth to a format, and the depths of a picture as drawn and "
        "stored, as a key of 32 bits; the near plane moves towards the eye. Where software draws, times are of the "
        "processor, of all threads; on a graphics card they are elapsed.",
        "*in a window*: the same pictures in PyVista windows with one light at the eye: `plotter.add_spline_tubes`, "
        "VTK's tube filter around the nodes' polylines, or around more samples of each segment, and VTK's lines shaded "
        "as tubes, as wide as the mean radius. Meshes of more than 12 million corners are left out.",
    ),
    run=run,
)
