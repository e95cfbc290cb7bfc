"""Error against run time of ray-cast spline tubes: how far off hits and silhouettes are, and what that costs.

In one run: every solver by its number of iterations, on rays and halves alone; whole pictures of the paper's five sets
(Russig et al. 2020, section 4); sweeps of one ratio each to where float32 no longer suffices; and the quadratic halves
against the cubics. What is right is computed in float64 by another method (``pvfiblets.tubes.reference``)::

    python benchmarks/tube_errors.py --output docs/benchmarks

writes ``tube-errors-CARD.json``, ``.md`` and ``.png``, named after the card. ``--quick`` measures a little of each.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

import numpy as np
from orbit import card_slug, context, machine, write
from tube_error_pictures import NEAREST, measured
from tube_error_sweeps import ABOUT, LIMITS, PICTURES, approximation, holding, swept
from tube_ways import make_set

from pvfiblets.engine.tubes import SOLVERS, TubeRenderer
from pvfiblets.engine.tubes.solver_probe import SolverProbe
from pvfiblets.report.tubes_rays import CLASSES, GOAL, Rays, of_class, of_set

SETS = ("fibers", "hotroom", "bundle", "brain", "furball")
ITERATIONS = (1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40)
QUICK = {"sets": ["fibers", "brain"], "iterations": [1, 4, 12], "rays": 2048, "repeats": 2, "pixels": 2000, "frames": 1,
         "size": (480, 270), "segments": 2000, "seconds": 1.0}  # fmt: skip
Row = dict[str, Any]


def main() -> None:
    """Measure, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", nargs="*", default=list(SETS), help="or helices-N, N small tubes")
    parser.add_argument("--iterations", type=int, nargs="+", default=list(ITERATIONS))
    parser.add_argument("--rays", type=int, default=12288, help="at each class of halves and each set")
    parser.add_argument("--repeats", type=int, default=5, help="of timing, after one to warm up")
    parser.add_argument("--frames", type=int, default=3, help="of each view at most")
    parser.add_argument("--seconds", type=float, default=6.0, help="of drawing, after which no further frame is begun")
    parser.add_argument("--pixels", type=int, default=20000, help="that are looked at in a picture at most")
    parser.add_argument("--segments", type=int, default=50000, help="of a set that are held against cubics at most")
    parser.add_argument("--size", type=int, nargs=2, default=(1920, 1080))
    parser.add_argument("--quick", action="store_true", help="less of everything")
    parser.add_argument("--output", type=Path, default=Path())
    options = parser.parse_args()
    if options.quick:
        chosen = {key: getattr(options, key) for key in QUICK if getattr(options, key) != parser.get_default(key)}
        vars(options).update(QUICK | chosen)
    ctx = context()
    started = time.perf_counter()
    sets = {name: make_set(name) for name in options.sets}
    default = the_default(ctx)
    data = {name: of_class(name, options.rays) for name in CLASSES}
    data |= {name: of_set(tubes, options.rays, options.size) for name, tubes in sets.items()}
    found = {
        "solvers": alone(ctx, data, default, options),
        "pictures": [row for name, tubes in sets.items() for row in measured(ctx, name, tubes, options)],
        "sweeps": [row for way in (default, paper()) for row in swept(ctx, way, options)],
        "approximation": [row for name, tubes in sets.items() for row in approximation(name, tubes, options)],
    }
    about = {
        **machine(ctx), "size": list(options.size), "rays": options.rays, "pixels": options.pixels,
        "default": default[0], "default_iterations": default[3], "seconds": round(time.perf_counter() - started),
    }  # fmt: skip
    results = [{"part": part, **row} for part, rows in found.items() for row in rows]
    write(options.output / f"tube-errors-{card_slug(ctx)}", about, results, table(about, found), plot)


# ------------------------------------------------------------------------------------------------------ solvers alone


def the_default(ctx: Any) -> tuple[str, str, bool, int]:
    """Return the program's own way: its name, solver, whether by the chain of derivatives, iterations."""
    renderer = TubeRenderer(ctx, make_set("helices-1"))
    solver, iterations = renderer.solver, renderer.iterations
    renderer.release()
    return f"{solver}, loop", solver, False, iterations


def paper() -> tuple[str, str, bool, int]:
    """Return the paper's way."""
    return "bisection, chain", "bisection", True, SOLVERS["bisection"].iterations


def ways(iterations: list[int]) -> list[tuple[str, str, bool, int]]:
    """Return all ways: solvers by one loop and by the chain of derivatives, by numbers of iterations, their own too."""
    found = []
    for solver, about in SOLVERS.items():
        for chain in (False, True):
            if not chain and about.feature is None:
                continue  # the paper's is always by the chain
            name = f"{solver}, {'chain' if chain else 'loop'}"
            found += [(name, solver, chain, n) for n in sorted({*iterations, about.iterations})]
    return found


def alone(ctx: Any, data: dict[str, Rays], default: tuple[str, str, bool, int], options: Any) -> list[Row]:
    """Return a row for every set of rays and way: ns per ray, errors, whether it is on the front."""
    probes = {way: SolverProbe(ctx, way[1], way[3], chain=way[2]) for way in ways(options.iterations)}
    rows = []
    for name, rays in data.items():
        here = {
            way: {
                "of": name,
                "way": way[0],
                "solver": way[1],
                "chain": way[2],
                "iterations": way[3],
                "own": way[3] == SOLVERS[way[1]].iterations,
                "default": way == default,
            }
            for way in probes
        }
        times: dict[Any, list[float]] = {way: [] for way in probes}
        for turn in range(options.repeats + 1):
            for way, probe in probes.items():  # in turns: what else the machine does then disturbs all of them
                answer = probe.hits(rays.controls, rays.origins, rays.directions)
                if turn == 0:
                    here[way] |= rays.errors(*answer)
                else:
                    times[way].append(probe.seconds)
        for way, row in here.items():
            row["ns"] = 1e9 * float(np.median(times[way])) / len(rays.controls)
        mark_front(list(here.values()))
        rows += here.values()
        best = next(row for row in here.values() if row["default"])
        print(f"{name}: {best['ns']:.0f} ns, p99 {best['p99']:.1e}, p99.9 {best['p99.9']:.1e}", flush=True)
    for probe in probes.values():
        probe.release()
    return rows


def mark_front(rows: list[Row]) -> None:
    """Say of each row whether no other one is both faster and more exact, by the 99.9th percentile."""
    least = np.inf
    for row in sorted(rows, key=lambda row: (row["ns"], row["p99.9"])):
        row["front"] = row["p99.9"] < least
        least = min(least, row["p99.9"])


# -------------------------------------------------------------------------------------------------------------- table


def table(about: Row, found: dict[str, list[Row]]) -> str:
    """Return the results in Markdown."""
    lines = [
        f"# Error against run time of spline tubes on {about['card']}",
        "",
        f"{about['driver']}, {about['system']}, {about['cpus']} CPU cores, {about['date']}; {about['seconds']} s in "
        f"all. By default: {about['default']}, {about['default_iterations']} iterations at most. *r*: radius of the "
        "sphere that is met. Errors are in r: along the ray, where it meets the tube and should; where only one of "
        "both is so, the distance from the ray to the silhouette, which is what the radius would have to change by. "
        "*missed*, *false*: shares of such rays; "
        "*silhouette*: the largest of their distances. All against float64 by another method.",
        *alone_lines(found["solvers"]), *picture_lines(found["pictures"]), *sweep_lines(found["sweeps"]),
        *approximation_lines(found["approximation"]),
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def alone_lines(rows: list[Row]) -> list[str]:
    """Return the tables of solvers alone."""
    names, every = (list(dict.fromkeys(row[key] for row in rows)) for key in ("of", "way"))
    lines = [
        "", "## Solvers alone", "",
        "Rays that pass a sphere of a half within 1.15 r of its middle. *loop*: one loop for all minima; *chain*: the "
        f"paper's chain of derivatives. Least iterations (ns per ray) from which on 99 % are within {GOAL:g} r:", "",
        "| way | " + " | ".join(names) + " |", "|---|" + "---|" * len(names),
    ]  # fmt: skip
    for way in every:
        cells = []
        for name in names:
            # From the most iterations down to where the error first is too large.
            kept = None
            for row in sorted((row for row in rows if (row["of"], row["way"]) == (name, way)),
                              key=lambda row: -row["iterations"]):  # fmt: skip
                if row["p99"] > GOAL:
                    break
                kept = row
            cells.append("never" if kept is None else f"{kept['iterations']} ({kept['ns']:.0f})")
        lines.append(f"| {way} | " + " | ".join(cells) + " |")
    lines += [
        "", "Each way with its own number of iterations, and all others that no way beats in both time and 99.9th "
        "percentile (*front*). **Bold**: the program's default.", "",
        "| rays at | way | iterations | ns per ray | p50 | p99 | p99.9 | max | missed | false | silhouette | front |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    for row in sorted(rows, key=lambda row: (names.index(row["of"]), row["ns"])):
        if not (row["own"] or row["front"]):
            continue
        bold = "**" if row["default"] else ""
        lines.append(
            f"| {row['of']} | {bold}{row['way']}{bold} | {row['iterations']} | {row['ns']:.0f} | {numbers(row)} "
            f"| {row['missed']:.1e} | {row['false']:.1e} | {row['silhouette']:.1e} | {'yes' if row['front'] else ''} |"
        )
    return lines


def numbers(row: Row) -> str:
    """Return quantiles as cells."""
    return " | ".join(f"{row[key]:.1e}" for key in ("p50", "p99", "p99.9", "max"))


def picture_lines(rows: list[Row]) -> list[str]:
    """Return the tables of whole pictures."""
    if not rows:
        return []
    whole = [row for row in rows if row["default"]]
    lines = [
        "", "## Whole pictures", "",
        f"Default settings, {whole[0]['size'][0]}×{whole[0]['size'][1]}, 45° from top to bottom; each pixel against "
        "the very segment that it shows. *depth*: as stored, a key of 32 bits; *point*: where the ray "
        f"enters the sphere of the parameter stored; *>*: share of pixels off by more than {GOAL:g} r; *format*: what "
        "storing the right depth in float32 would cost alone, p99. *false*: the ray meets nothing of the segment "
        f"shown; *behind*: another one is nearer, by more than {GOAL:g} r, in such a share of up to {NEAREST} pixels, "
        "and by how many r at most; *holes*: share of as many empty pixels "
        "next to covered ones that the tubes do cover, and how deep in r.", "",
        "| set | view | ms | depth p50 | p99 | p99.9 | max | > | format | point p99 | p99.9 | max | > | false | behind "
        "| holes |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    for row in whole:
        depth, point = row["depth"], row["t"]
        lines.append(
            f"| {row['set']} | {row['view']} | {row['ms']:.0f} | {numbers(depth)} | {depth['above_goal']:.1e} "
            f"| {row['format']['p99']:.1e} | {point['p99']:.1e} | {point['p99.9']:.1e} | {point['max']:.1e} "
            f"| {point['above_goal']:.1e} | {depth['false']:.1e} | {row['not_nearest']:.1e}, "
            f"{row['not_nearest_by']:.1e} | {row['holes']:.1e}, {row['hole_depth']:.1e} |"
        )
    lines += ["", f"The goal, an error of no more than {GOAL:g} r in every pixel:", "", *map(verdict, whole)]
    size = next((row["size"] for row in rows if not row["default"]), (0, 0))
    lines += [
        "", f"Solvers with their own numbers of iterations in pictures of {size[0]}×{size[1]}:", "",
        "| set | view | solver | iterations | ms | depth p99 | p99.9 | point p99 | p99.9 | max | > |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    for row in rows:
        if not row["default"]:
            depth, point = row["depth"], row["t"]
            lines.append(
                f"| {row['set']} | {row['view']} | {row['solver']} | {row['iterations']} | {row['ms']:.0f} "
                f"| {depth['p99']:.1e} | {depth['p99.9']:.1e} | {point['p99']:.1e} | {point['p99.9']:.1e} "
                f"| {point['max']:.1e} | {point['above_goal']:.1e} |"
            )
    return lines


def verdict(row: Row) -> str:
    """Say whether a picture keeps to the goal, and else what it fails by."""
    depth, point, storing = row["depth"]["above_goal"], row["t"]["above_goal"], row["format"]["above_goal"]
    head = f"- {row['set']}, {row['view']}: "
    if depth == 0.0:
        return head + "kept."
    return head + (
        f"missed in {100 * depth:.3g} % of the pixels. Storing the right depth in float32 alone would miss it in "
        f"{100 * storing:.3g} %; the parameter stored, in {100 * point:.3g} %."
    )


def sweep_lines(rows: list[Row]) -> list[str]:
    """Return the tables of sweeps."""
    every = list(dict.fromkeys(row["way"] for row in rows))
    lines = ["", "## Stiff and extreme", ""]
    lines += ["float32 holds up to, by p99 of the error; in brackets the first ratio tried that fails:", ""]
    lines += ["| | way | " + " | ".join(f"{limit:g} r" for limit in LIMITS) + " |", "|---|---|" + "---|" * len(LIMITS)]
    parts: list[str] = []
    for key, text in ABOUT.items():
        for way in every:
            mine = [row for row in rows if (row["sweep"], row["way"]) == (key, way)]
            cells = []
            for limit in LIMITS:
                held, failed = holding(mine, limit)
                shown = "none" if held is None else f"{held:g}"
                cells.append(shown if failed is None else f"{shown} (not {failed:g})")
            lines.append(f"| {text} | {way} | " + " | ".join(cells) + " |")
        mine = [row for row in rows if row["sweep"] == key]
        stored = "; format p99" if key in PICTURES else ""
        parts += ["", f"{text.capitalize()}: p50, p99{stored}; missed and false, silhouette.", ""]
        parts += ["| | " + " | ".join(every) + " |", "|---|" + "---|" * len(every)]
        for ratio in dict.fromkeys(row["ratio"] for row in mine):
            cells = []
            for way in every:
                row = next(row for row in mine if (row["ratio"], row["way"]) == (ratio, way))
                stored = f"; {row['format_p99']:.0e}" if key in PICTURES else ""
                flipped = row["missed"] + row["false"]
                wrong = f"; {flipped:.1e}, {row['silhouette']:.0e}" if flipped else ""
                cells.append(f"{row['p50']:.0e}, {row['p99']:.0e}{stored}{wrong}")
            parts.append(f"| {ratio:g} | " + " | ".join(cells) + " |")
    return lines + parts


def approximation_lines(rows: list[Row]) -> list[str]:
    """Return the table of the halves against the cubics."""
    if not rows:
        return []
    lines = [
        "", "## Two quadratics for a cubic", "",
        "How far they lie apart, position and radius added up, over the least radius of the segment. 1/4 is the "
        "default, 1/3 the paper's.", "", "| set | segments | share c | p50 | p99 | max |", "|---|---|---|---|---|---|",
    ]  # fmt: skip
    for row in rows:
        share = "1/4" if row["share"] == 0.25 else "1/3"
        lines.append(
            f"| {row['set']} | {row['segments']:,} | {share} | {row['p50']:.1e} | {row['p99']:.1e} | {row['max']:.1e} |"
        )
    return lines


# --------------------------------------------------------------------------------------------------------------- plot


def plot(about: Row, results: list[Row], path: Path) -> None:
    """Draw error against time for each class and set, and against the ratio of each sweep."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    solvers = [row for row in results if row["part"] == "solvers"]
    sweeps = [row for row in results if row["part"] == "sweeps"]
    names, every = (list(dict.fromkeys(row[key] for row in solvers)) for key in ("of", "way"))
    keys = list(ABOUT)
    columns = 4
    upper, lower = -(-len(names) // columns), -(-len(keys) // columns)
    figure, axes = plt.subplots(
        upper + lower, columns, figsize=(4.2 * columns, 3.2 * (upper + lower)), layout="constrained", squeeze=False
    )
    for axis in [*axes.ravel()[len(names) : columns * upper], *axes.ravel()[columns * upper + len(keys) :]]:
        axis.set_axis_off()
    shared = axes[0][0]
    for axis, name in zip(axes.ravel(), names, strict=False):
        if axis is not shared:
            axis.sharex(shared)
            axis.sharey(shared)
        axis.set_title(f"rays at {name}", size="small")
        axis.set_xlabel("ns per ray", size="small")
        axis.set_ylabel("error / r", size="small")
        for colour, way in enumerate(every):
            rows = sorted((row for row in solvers if (row["of"], row["way"]) == (name, way)),
                          key=lambda row: row["iterations"])  # fmt: skip
            time_ = [row["ns"] for row in rows]
            for quantile, style in (("p99", "-"), ("p99.9", ":")):
                axis.plot(time_, [max(row[quantile], 1e-9) for row in rows], style, color=f"C{colour}", lw=1,
                          label=way if style == "-" else None)  # fmt: skip
            front = [row for row in rows if row["front"]]
            axis.plot([row["ns"] for row in front], [max(row["p99.9"], 1e-9) for row in front], ".", color=f"C{colour}")
            for row in rows:
                if row["default"]:
                    for quantile in ("p99", "p99.9"):
                        axis.plot(row["ns"], max(row[quantile], 1e-9), "*", color="black", ms=10, zorder=3)
        axis.axhline(GOAL, color="grey", lw=0.5)
    shared.set_xscale("log")
    shared.set_yscale("log")
    shared.legend(fontsize="xx-small")
    for axis, key in zip(axes.ravel()[columns * upper :], keys, strict=False):
        for way in dict.fromkeys(row["way"] for row in sweeps):
            rows = [row for row in sweeps if (row["sweep"], row["way"]) == (key, way)]
            (line,) = axis.plot(range(len(rows)), [max(row["p99"], 1e-9) for row in rows], label=way)
            axis.plot(range(len(rows)), [max(row["p50"], 1e-9) for row in rows], "--", lw=0.7, color=line.get_color())
            axis.set_xticks(range(len(rows)), [f"{row['ratio']:g}" for row in rows], rotation=60, size="x-small")
        for limit in LIMITS:
            axis.axhline(limit, color="grey", lw=0.5)
        axis.set_yscale("log")
        axis.set_xlabel(ABOUT[key], size="small")
        axis.set_ylabel("error / r", size="small")
        axis.legend(fontsize="xx-small")
    figure.suptitle(
        f"{about['card']}; above: p99, dotted p99.9, dots on its front, stars the default; below: p99, dashed p50"
    )
    figure.savefig(path, dpi=90)
    plt.close(figure)


if __name__ == "__main__":
    main()
