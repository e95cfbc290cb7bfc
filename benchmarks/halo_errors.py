"""Error against run time of halos' edges: how far pictures are from finely sampled ones, and what samples cost.

A pixel is black, white or, at the edge of a line on its own halo, a gradual transition (``smooth``); lines that end at
another line's halo are as jagged as the pixels. More samples a pixel, averaged, cost time. Each picture is held against
one of 8x8 samples a pixel, all of them black or white; and that one against the same with transitions, which says how
far it may be off itself::

    python benchmarks/halo_errors.py --output docs/benchmarks

writes ``halo-errors-CARD.json``, ``.md`` and ``.png``, named after the card.
"""

from __future__ import annotations

import argparse
import dataclasses
import time
from pathlib import Path
from typing import Any

import numpy as np
from halo_ways import make_set
from orbit import card_slug, context, machine, write

from pvfiblets.engine import View
from pvfiblets.engine.halos import HaloRenderer
from pvfiblets.report.halos_pictures import WRONG, differences, finer, look_of, orbit, picture

SETS = ("fibres-subset", "office", "shape-small")
GRIDS = (1, 2, 3, 4)  # samples along a pixel's side
REFERENCE = 8


def main() -> None:
    """Measure, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", nargs="+", default=list(SETS), help="or lines-N and points-N, N small ones")
    parser.add_argument("--grids", type=int, nargs="+", default=list(GRIDS), help="samples along a pixel's side")
    parser.add_argument("--reference", type=int, default=REFERENCE, help="samples along a pixel's side")
    parser.add_argument("--places", type=int, default=3, help="around the data")
    parser.add_argument("--repeats", type=int, default=3, help="of timing at each place")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--size", type=int, nargs=2, default=(812, 600))
    parser.add_argument("--output", type=Path, default=Path())
    options = parser.parse_args()
    ctx = context()
    results = [row for name in options.sets for row in measured(ctx, name, options)]
    about = {**machine(ctx), "size": list(options.size), "places": options.places, "reference": options.reference}
    write(options.output / f"halo-errors-{card_slug(ctx)}", about, results, table(about, results), plot)


def measured(ctx: Any, name: str, options: Any) -> list[dict[str, Any]]:
    """Return a result for every number of samples, with and without transitions."""
    drawn = make_set(name, options.seed)
    cameras = [place[0] for place in orbit(drawn, options.places, 1, tuple(options.size))]
    renderer = HaloRenderer(ctx, drawn)
    try:
        return _measured(ctx, renderer, name, drawn, cameras, options)
    finally:
        renderer.release()


def _measured(ctx: Any, renderer: Any, name: str, drawn: Any, cameras: list[Any], options: Any) -> list[dict[str, Any]]:
    look = look_of(drawn)
    looks = {smooth: dataclasses.replace(look, smooth=smooth) for smooth in (False, True)}
    right, other = ([picture(renderer, camera, looks[smooth], options.reference) for camera in cameras]
                    for smooth in (False, True))  # fmt: skip
    common = {"set": name, "vertices": drawn.n_points}
    rows = [{**common, "reference": True, **differences(other, right)}]
    for grid in options.grids:
        for smooth, look in looks.items():
            pictures = [picture(renderer, camera, look, grid) for camera in cameras]
            times = [seconds(ctx, renderer, camera, look, grid) for _ in range(options.repeats) for camera in cameras]
            low, median, high = (1e3 * float(np.percentile(times, q)) for q in (10, 50, 90))
            rows.append({**common, "reference": False, "samples": grid**2, "smooth": smooth, "ms": median,
                         "ms_spread": [low, high], **differences(pictures, right)})  # fmt: skip
            print(rows[-1], flush=True)
    return rows


def seconds(ctx: Any, renderer: Any, camera: Any, look: Any, times: int) -> float:
    """Return how long a picture of so many samples along a pixel's side takes to draw, averaging left out."""
    style = finer(look, times)
    size = tuple(times * side for side in camera.size)
    away = View(size, np.diag([1.0, 1.0, 1.0, 1.001]) @ camera.model_view_projection)  # else nothing is drawn anew
    renderer.render(away, style)
    ctx.finish()
    start = time.perf_counter()
    renderer.render(View(size, camera.model_view_projection), style)
    ctx.finish()
    return time.perf_counter() - start


def table(about: dict[str, Any], results: list[dict[str, Any]]) -> str:
    """Return the results in Markdown."""
    width, height = about["size"]
    times = about["reference"]
    lines = [
        f"# Error against run time of halos on {about['card']}",
        "",
        f"{about['driver']}, {about['system']}, {about['cpus']} CPU cores, {about['date']}; {width}×{height}, "
        f"{about['places']} places around each set; the engine without VTK. Errors are differences of pixels to a "
        f"picture of {times}×{times} samples, all black or white, as shares of the difference between black and "
        f"white. *>{WRONG:g}*: share of pixels that are off by more; *ms*: median, drawing alone, 10th to 90th "
        "percentile in brackets; *smooth*: with the gradual transition between a line and its halo. *Reference*: how "
        "far the finely sampled pictures with and without transitions are apart, which is what they may be off.",
        "",
        f"| set | samples | smooth | ms | mean | rms | p99 | max | >{WRONG:g} |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for row in results:
        numbers = " | ".join(f"{row[key]:.4f}" for key in ("mean", "rms", "p99", "max", "wrong"))
        if row["reference"]:
            lines.append(f"| {row['set']} | {times**2} | reference | | {numbers} |")
            continue
        low, high = row["ms_spread"]
        lines.append(
            f"| {row['set']} | {row['samples']} | {'yes' if row['smooth'] else 'no'} "
            f"| {row['ms']:.1f} ({low:.1f}–{high:.1f}) | {numbers} |"
        )
    return "\n".join(lines) + "\n"


def plot(about: dict[str, Any], results: list[dict[str, Any]], path: Path) -> None:
    """Draw the mean error over time, a panel for each set."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    sets = list(dict.fromkeys(row["set"] for row in results))
    figure, axes = plt.subplots(1, len(sets), figsize=(1.0 + 4.0 * len(sets), 3.8), layout="constrained", squeeze=False)
    for axis, name in zip(axes[0], sets, strict=True):
        for smooth, mark in ((False, "s--"), (True, "o-")):
            rows = [row for row in results if row["set"] == name and row.get("smooth") is smooth]
            axis.loglog([row["ms"] for row in rows], [row["mean"] for row in rows], mark,
                        label="smooth" if smooth else "black or white")  # fmt: skip
            for row in rows:
                axis.annotate(str(row["samples"]), (row["ms"], row["mean"]), textcoords="offset points", xytext=(4, 4),
                              size="x-small")  # fmt: skip
        (floor,) = (row["mean"] for row in results if row["set"] == name and row["reference"])
        axis.axhline(floor, color="black", linestyle=":", linewidth=1, label="of the reference")
        axis.set_title(name, size="medium")
        axis.set_xlabel("ms per picture")
        axis.grid(True, which="both", alpha=0.2)
    axes[0][0].set_ylabel("mean difference of pixels")
    axes[0][0].legend(fontsize="small")
    times = about["reference"]
    title = f"{about['card'].split('(')[0].strip()}; samples a pixel beside the marks, against {times}×{times}"
    figure.suptitle(title, size="medium")
    figure.savefig(path, dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    main()
