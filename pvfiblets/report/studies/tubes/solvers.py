"""Solvers of tubes alone: errors and times of rays by numbers of iterations."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...record import Figure, Record
from ...study import LATE, Options
from ...timing import clock_of, timing
from .rays import CLASSES, GOAL, Rays, of_class, of_set
from .sweeps import SWEEPS

if TYPE_CHECKING:
    import moderngl

__all__ = ["SETS", "SET_SIZE", "ray_sweeps", "solvers"]

ITERATIONS = (1, 2, 3, 4, 6, 8, 12, 16, 24)  # besides each solver's own
QUICK_ITERATIONS = (2, 4, 8)
QUICK_CLASSES = ("thin", "usual", "cone", "flat-ended")
RAYS, QUICK_RAYS = 8192, 2048
SETS = ("fibers", "hotroom", "bundle", "brain", "furball")  # Russig et al. 2020, section 4
SET_SIZE = (960, 540)  # of their pictures


@dataclass(frozen=True)
class Variant:
    """A solver, whether by the chain of derivatives, and how many iterations of one search it is given."""

    solver: str
    chain: bool
    iterations: int
    default: bool

    @property
    def name(self) -> str:
        """As records name it."""
        return f"{self.solver}, {'chain' if self.chain else 'loop'}"

    @property
    def setting(self) -> str:
        """As records name it."""
        return f"{self.iterations} iteration{'s' if self.iterations > 1 else ''}"


def variants(quick: bool) -> list[Variant]:
    """Return all solvers, by loop and the paper's by chain, in a whole report all by both, by numbers of iterations."""
    from pvfiblets.engine.tubes import SOLVERS

    default = next(iter(SOLVERS))
    found = []
    for solver, about in SOLVERS.items():
        paper = about.feature is None  # always by the chain
        for chain in (True,) if paper else (False,) if quick else (False, True):
            for n in sorted({*(QUICK_ITERATIONS if quick else ITERATIONS), about.iterations}):
                own = n == about.iterations
                found.append(Variant(solver, chain, n, default=own and solver == default and not chain))
    return found


def solvers(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
    """Yield records of solvers alone, on rays at halves of each class."""
    count = QUICK_RAYS if options.quick else RAYS
    data = {f"rays at {name} tubes": partial(of_class, name, count, options.seed)
            for name in (QUICK_CLASSES if options.quick else CLASSES)}  # fmt: skip
    if not options.quick:
        data |= {f"rays at the set {name}": partial(_rays_of, name, count, options.seed) for name in SETS}
    clock, clock_name = clock_of(ctx)
    with _Probes(ctx, clock) as probes:
        for variant in variants(options.quick):
            probes.made(variant)
        options = options.share()  # no measurement takes as long as compiling did
        for name, make in data.items():
            rays = make()
            done: list[tuple[Variant, Record, list[float]]] = []
            late: list[str] = []
            for variant in variants(options.quick):
                if not options.budget.allows():
                    late.append(f"{variant.name} {variant.setting}")
                    continue
                answer, _ = probes.hits(variant, rays)
                record = Record(
                    data=name,
                    group="rays",
                    approximation="where a ray meets a tube",
                    method=variant.name,
                    setting=variant.setting,
                    errors=hit_errors(rays.errors(*answer)),
                    ours=variant.solver != "bisection",
                    default=variant.default,
                )
                done.append((variant, record, []))
            for turn in range(options.repeats):
                for variant, _, seconds in done:
                    if turn == 0 or options.budget.allows():  # each has a time at least
                        seconds.append(probes.hits(variant, rays)[1])
            for _, record, seconds in done:
                record.times["hit"] = timing(seconds, len(rays.controls), "ray", clock_name)
                yield record
            if late:
                options.leave_out(f"{name}: {', '.join(late)}", LATE)
            options.log(f"tubes: {name}: {len(done)} variants")


def _rays_of(name: str, count: int, seed: int) -> Rays:
    from pvfiblets.synthetic.tubes import tube_set

    return of_set(tube_set(name, seed), count, SET_SIZE, seed)


def hit_errors(found: dict[str, float]) -> dict[str, Figure]:
    """Return the figures of rays' errors."""
    quantiles = {f"hit {name}": Figure(found[name], "radii") for name in ("p50", "p99", "p99.9", "max")}
    shares = {"missed": "missed", "false": "false", f"off by {GOAL:g}": "above_goal"}
    return quantiles | {name: Figure(100.0 * found[key], "%") for name, key in shares.items()}


def ray_sweeps(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
    """Yield records of errors by ratios that end where float32 does: ours and the paper's."""
    chosen = [v for v in variants(True) if v.default or (v.solver == "bisection" and v.iterations == 20)]
    with _Probes(ctx, clock_of(ctx)[0]) as probes:
        for name, (about, ratios, make) in SWEEPS.items():
            shown = [ratio for ratio in ratios if ratio > 0.0]  # the axis is logarithmic
            if not options.allows(f"sweep of {about}"):
                continue
            errors: dict[Variant, dict[str, Figure]] = {variant: {} for variant in chosen}
            for ratio in shown[:: 3 if options.quick else 1]:
                rays = make(ratio, QUICK_RAYS // 2, np.random.default_rng([options.seed, 3]))
                for variant in chosen:
                    found = rays.errors(*probes.hits(variant, rays)[0])
                    errors[variant][f"p99 at ratio {ratio:g}"] = Figure(found["p99"], "radii")
            for variant in chosen:
                yield Record(
                    about, "stiff", f"rays by {name}", variant.name, variant.setting, errors[variant],
                    ours=variant.default,
                )  # fmt: skip


class _Probes(AbstractContextManager["_Probes"]):
    """Solvers on one context, one program for each however many iterations."""

    def __init__(self, ctx: moderngl.Context, clock: Callable[[], float]) -> None:
        self._ctx, self._clock = ctx, clock
        self._made: dict[tuple[str, bool], Any] = {}

    def __exit__(self, *_: object) -> None:
        for probe in self._made.values():
            probe.release()

    def made(self, variant: Variant) -> Any:
        """Return a variant's solver, which is compiled when first asked for."""
        from .solver_probe import SolverProbe

        key = variant.solver, variant.chain
        if key not in self._made:
            self._made[key] = SolverProbe(self._ctx, variant.solver, chain=variant.chain, clock=self._clock)
        self._made[key].limit(variant.iterations)
        return self._made[key]

    def hits(self, variant: Variant, rays: Rays) -> tuple[Any, float]:
        """Return a variant's answer, and the seconds that it took."""
        probe = self.made(variant)
        answer = probe.hits(rays.controls, rays.origins, rays.directions)
        return answer, probe.seconds
