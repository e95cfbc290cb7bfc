"""The study of ray-cast spline tubes: solvers by iterations, whole pictures, float32's limits, and stored depth."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pvfiblets.tubes import curves

from .cameras import VIEWS, Lens, by_turns, orbit
from .drawing import Part, clock_of, run_parts, timing, turns_of
from .record import FRAME, Axes, Figure, LeftOut, Record
from .study import Options
from .tubes_drawings import CastTubes, Drawing, drawings
from .tubes_pictures import FORMATS, Truth, helices
from .tubes_rays import CLASSES, Rays, of_class
from .tubes_sweeps import SWEEPS

__all__ = ["STUDY", "TubesStudy"]

ITERATIONS = (1, 2, 3, 4, 6, 8, 12, 16, 24)  # besides each solver's own
QUICK_ITERATIONS = (2, 4, 8)
QUICK_CLASSES = ("thin", "usual", "cone")
RAYS, QUICK_RAYS = 8192, 2048
SIZE, QUICK_SIZE = (480, 270), (160, 90)
TUBES = 6  # helices of 24 segments each
RANGES = (10.0, 1e2, 1e3, 1e4, 1e5, 1e6)  # far over near
QUICK_RANGES = (10.0, 1e3, 1e6)
SEGMENTS = 20_000  # of a set that are held against their cubics
LATE = "the time given was used up"



@dataclass(frozen=True)
class Way:
    """A solver, whether by the chain of derivatives, and how many iterations of one search it is given."""

    solver: str
    chain: bool
    iterations: int
    default: bool

    @property
    def name(self) -> str:
        """As it is told."""
        return f"{self.solver}, {'chain' if self.chain else 'loop'}"

    @property
    def setting(self) -> str:
        """As it is told."""
        return f"{self.iterations} iteration{'s' if self.iterations > 1 else ''}"


def ways(quick: bool) -> list[Way]:
    """Return all solvers, by loop and the paper's by chain, in a whole report all by both, by numbers of iterations."""
    from pvfiblets.engine.tubes import SOLVERS

    default = next(iter(SOLVERS))
    found = []
    for solver, about in SOLVERS.items():
        paper = about.feature is None  # always by the chain
        for chain in (True,) if paper else (False,) if quick else (False, True):
            for n in sorted({*(QUICK_ITERATIONS if quick else ITERATIONS), about.iterations}):
                own = n == about.iterations
                found.append(Way(solver, chain, n, default=own and solver == default and not chain))
    return found


# ----------------------------------------------------------------------------------------------------------- the parts


def solvers(ctx: Any, options: Options, left_out: list[LeftOut]) -> Iterator[Record]:
    """Yield records of solvers alone, on rays at halves of each class."""
    classes = QUICK_CLASSES if options.quick else tuple(CLASSES)
    clock, clock_name = clock_of(ctx)
    with _Probes(ctx, clock) as probes:
        for way in ways(options.quick):
            probes.made(way)
        options = replace(options, budget=options.budget.share())  # no measurement takes as long as compiling did
        for name in classes:
            rays = of_class(name, QUICK_RAYS if options.quick else RAYS, options.seed)
            done: list[tuple[Way, Record, list[float]]] = []
            late: list[str] = []
            for way in ways(options.quick):
                if not options.budget.allows():
                    late.append(f"{way.name} {way.setting}")
                    continue
                answer, _ = probes.hits(way, rays)
                record = Record(
                    data=f"rays at {name} tubes",
                    group="rays",
                    approximation="where a ray meets a tube",
                    way=way.name,
                    setting=way.setting,
                    errors=hit_errors(rays.errors(*answer)),
                    ours=way.solver != "bisection",
                    default=way.default,
                    machine=options.machine,
                )
                done.append((way, record, []))
            for turn in range(options.repeats):
                for way, _, seconds in done:
                    if turn == 0 or options.budget.allows():  # each has a time at least
                        seconds.append(probes.hits(way, rays)[1])
            for _, record, seconds in done:
                record.times["hit"] = timing(seconds, len(rays.controls), "ray", clock_name)
                yield record
            if late:
                left_out.append(LeftOut(f"rays at {name} tubes: {', '.join(late)}", LATE))
            options.log(f"tubes: {name}: {len(done)} ways")


def hit_errors(found: dict[str, float]) -> dict[str, Figure]:
    """Return what is told of rays' errors."""
    told = {f"hit {name}": Figure(found[name], "radii") for name in ("p50", "p99", "p99.9", "max")}
    return told | {"missed": Figure(100.0 * found["missed"], "%"), "false": Figure(100.0 * found["false"], "%")}


def sweeps(ctx: Any, options: Options, left_out: list[LeftOut]) -> Iterator[Record]:
    """Yield records of errors by ratios that end where float32 does: our way and the paper's."""
    chosen = [way for way in ways(True) if way.default or (way.solver == "bisection" and way.iterations == 20)]
    with _Probes(ctx, clock_of(ctx)[0]) as probes:
        for name, (about, ratios, make) in SWEEPS.items():
            shown = [ratio for ratio in ratios if ratio > 0.0]  # the axis is logarithmic
            if not options.budget.allows():
                left_out.append(LeftOut(f"sweep of {about}", LATE))
                continue
            errors: dict[Way, dict[str, Figure]] = {way: {} for way in chosen}
            for ratio in shown[:: 3 if options.quick else 1]:
                rays = make(ratio, QUICK_RAYS // 2, np.random.default_rng([options.seed, 3]))
                for way in chosen:
                    found = rays.errors(*probes.hits(way, rays)[0])
                    errors[way][f"p99 at ratio {ratio:g}"] = Figure(found["p99"], "radii")
            for way in chosen:
                yield Record(
                    about, "stiff", f"rays by {name}", way.name, way.setting, errors[way], ours=way.default,
                    machine=options.machine,
                )  # fmt: skip


class _Probes(AbstractContextManager["_Probes"]):
    """Solvers on one context, one program for each however many iterations."""

    def __init__(self, ctx: Any, clock: Callable[[], float]) -> None:
        self._ctx, self._clock = ctx, clock
        self._made: dict[tuple[str, bool], Any] = {}

    def __exit__(self, *_: object) -> None:
        for probe in self._made.values():
            probe.release()

    def made(self, way: Way) -> Any:
        """Return a way's solver, which is compiled when first asked for."""
        from pvfiblets.engine.tubes.solver_probe import SolverProbe

        key = way.solver, way.chain
        if key not in self._made:
            self._made[key] = SolverProbe(self._ctx, way.solver, chain=way.chain, clock=self._clock)
        self._made[key].limit(way.iterations)
        return self._made[key]

    def hits(self, way: Way, rays: Rays) -> tuple[Any, float]:
        """Return a way's answer, and the seconds that it took."""
        probe = self.made(way)
        answer = probe.hits(rays.controls, rays.origins, rays.directions)
        return answer, probe.seconds


def pictures(ctx: Any, options: Options, left_out: list[LeftOut]) -> Iterator[Record]:
    """Yield records of whole pictures: silhouettes and depths against float64, and what a picture takes."""
    size = QUICK_SIZE if options.quick else SIZE
    tubes = helices(TUBES)
    for view in VIEWS:
        name = f"{TUBES} helices, {view}"
        if not options.budget.allows():
            left_out.append(LeftOut(name, LATE))
            continue
        camera = orbit(tubes, view, 2, size)[0]
        lens = Lens.of(camera)
        truth = Truth.of(tubes, lens)
        options.log(f"tubes: {name}: {int(truth.there.sum())} of {len(truth.there)} pixels show tubes")
        within = options.budget.share()  # the reference took longer than pictures do
        turns, done, late = turns_of(ctx), [], 0
        made: list[Drawing] = []
        try:
            for make in drawings(ctx, tubes, size):
                if not within.allows():
                    late += 1
                    continue
                drawn = make()
                made.append(drawn)
                drawn.draw(camera)
                found = truth.errors(*drawn.shown(lens))
                units = {"silhouette": "pixels", "depth p50": "radii", "depth p99": "radii"}
                record = Record(
                    data=name,
                    group="pictures",
                    approximation="a picture of tubes",
                    way=drawn.way,
                    setting=drawn.setting,
                    errors={key: Figure(value, units[key]) for key, value in found.items()},
                    costs={"geometry": Figure(float(drawn.nbytes), "bytes")},
                    ours=drawn.ours,
                    default=drawn.default,
                    machine=options.machine,
                )
                done.append((record, turns.add(by_turns(drawn.draw, [camera]))))
            turns.run(options.repeats, within.allows)
            for record, number in done:
                record.times["draw"] = turns.timing(number, 1.0, FRAME)
                yield record
        finally:
            for drawn in made:
                drawn.release()
        if late:
            left_out.append(LeftOut(f"{name}: {late} further ways of drawing", LATE))


def stored(ctx: Any, options: Options, left_out: list[LeftOut]) -> Iterator[Record]:
    """Yield records of depth by what it is stored as, and by how far the near and the far plane lie apart."""
    tubes, size = helices(2), QUICK_SIZE
    far = orbit(tubes, "far", 2, size)[0]
    lens = Lens.of(far)
    truth = Truth.of(tubes, lens)
    drawn = CastTubes(ctx, tubes)
    names = [f"p99 at far/near {ratio:g}" for ratio in (QUICK_RANGES if options.quick else RANGES)]
    errors: dict[str, dict[str, Figure]] = {name: {} for name in ("key of 32 bits, as drawn", *FORMATS)}
    try:
        for name, ratio in zip(names, QUICK_RANGES if options.quick else RANGES, strict=True):
            if not options.budget.allows():
                left_out.append(LeftOut(f"stored depth: {name}", LATE))
                continue
            camera = replace(far, near=far.far / ratio)
            seen = replace(truth, lens=Lens.of(camera))
            drawn.draw(camera)
            shown = seen.errors(*drawn.shown(seen.lens))["depth p99"]
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
                {"depth": Figure(bits / 8.0, "bytes/pixel")}, ours=kind.startswith("key"), machine=options.machine,
            )  # fmt: skip


def halves(ctx: Any, options: Options, left_out: list[LeftOut]) -> Iterator[Record]:  # noqa: ARG001 - as other parts
    """Yield records of how far the two quadratics of a segment are from its cubic, by the share of a derivative."""
    from pvfiblets.synthetic.tubes import tube_set

    rng = np.random.default_rng([options.seed, 2])
    for name in ("fibers",) if options.quick else ("fibers", "hotroom", "bundle", "brain"):
        if not options.budget.allows():
            left_out.append(LeftOut(f"quadratics for cubics: {name}", LATE))
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
                ours=share == curves.MIDDLE, machine=options.machine,
            )  # fmt: skip


PARTS: dict[Part, float] = {solvers: 3.0, pictures: 5.0, sweeps: 2.0, stored: 1.0, halves: 1.0}
"""What is measured, and by what weight each part has its share of the time."""


class TubesStudy:
    """Ray-cast spline tubes beside the paper's solver and beside tessellation."""

    name = "tubes"
    title = "Ray-cast spline tubes"
    approximates = (
        "Where rays meet tubes of varying radius, found in float32 by a bounded number of steps: solvers by "
        "iterations, beside the paper's; whole pictures, beside tessellation; depth, by what it is stored as."
    )
    axes = (
        Axes("hit-p99", "times/hit", "errors/hit p99", "ns per ray", "99th percentile of errors, radii"),
        Axes("hit-max", "times/hit", "errors/hit max", "ns per ray", "largest error, radii"),
        Axes("silhouette", "times/draw", "errors/silhouette", "ms per frame", "silhouettes off, pixels"),
        Axes("depth", "times/draw", "errors/depth p50", "ms per frame", "median of depth errors, radii"),
        Axes("ratio", "", "errors/p99 at ratio ", "ratio that the title names", "99th percentile, radii", series=True),
        Axes("stored", "", "errors/p99 at far/near ", "far over near plane", "99th percentile, radii", series=True),
    )
    notes = (
        "What is right is found in float64 by another method (pvfiblets/tubes/reference.py: eigenvalues of companion "
        "matrices, nothing is bracketed). Errors are in radii of the sphere that is met: along the ray, where it meets "
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
        "*stored depth*: what rounding the right depth to a format costs, and the depths of a picture as drawn and "
        "stored, as a key of 32 bits; the near plane moves towards the eye. Where software draws, times are of the "
        "processor, of all threads; those of cards are by the clock.",
    )

    def run(self, options: Options, left_out: list[LeftOut]) -> Iterator[Record]:
        """Yield records part by part, each with its share of what time is left."""
        return run_parts(PARTS, options, left_out)


STUDY = TubesStudy()
