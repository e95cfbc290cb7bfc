"""Error against run time of culling: how many pixels each kind loses, and what it costs, for slow and fast cameras.

The same frames around a made-up brain are drawn with each kind of culling and, for comparison, without (``none``). A
pixel is wrong if it does not show what the picture without culling does. The camera stands still (it moves by a
thousandth of a degree, or nothing would be drawn again), or turns by 1.14, 10 or 60 degrees a frame::

    python benchmarks/culling.py --segments 6e6 --folder /tmp --output docs/benchmarks

writes ``culling-CARD.json``, ``.md`` and ``.png``, named after the card.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np
from orbit import add_places, card_slug, context, machine, make_brain, segments_of, view, write

from pvfiblets.report.culling_pictures import streamlines_of

CULLINGS = ("none", "coverage", "two-phase")
STILL = 0.001


def main() -> None:
    """Measure, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--segments", type=float, default=6e6)
    parser.add_argument("--step", type=float, default=0.1, help="mm between points")
    parser.add_argument("--degrees", type=float, nargs="+", default=[STILL, 1.14, 10.0, 60.0], help="per frame")
    parser.add_argument("--pipeline", default="auto")
    parser.add_argument("--frames", type=int, default=12, help="frames that count")
    add_places(parser)
    options = parser.parse_args()
    ctx = context()
    with tempfile.TemporaryDirectory() as temporary:
        fiblets = make_brain(options.segments, options.step, options.folder or Path(temporary))
        results = measure_all(ctx, fiblets, options)
        about = {
            **machine(ctx),
            "size": list(options.size),
            "step_mm": options.step,
            "segments": segments_of(fiblets),
            "pipeline": results[0]["pipeline"],
        }
        del fiblets
    write(options.output / f"culling-{card_slug(ctx)}", about, results, table(about, results), plot)


def measure_all(ctx, fiblets, options) -> list[dict]:
    """Draw the same frames in every way, all ways taking turns."""
    from pvfiblets.engine import FibletRenderer, capabilities

    pipeline = capabilities.choose(ctx, options.pipeline)
    results = []
    for degrees in options.degrees:
        renderers = {
            culling: FibletRenderer(ctx, fiblets, pipeline=pipeline, culling=None if culling == "none" else culling)
            for culling in CULLINGS
        }
        times: dict[str, list[float]] = {culling: [] for culling in CULLINGS}
        wrong: dict[str, list[int]] = {culling: [] for culling in CULLINGS}
        covered = []
        for frame in range(options.frames + 2):
            at = view(fiblets, degrees * frame, tuple(options.size))
            right = None
            for culling, renderer in renderers.items():
                start = time.perf_counter()
                picture = renderer.render(at)
                ctx.finish()
                if frame < 2:
                    continue
                times[culling].append(time.perf_counter() - start)
                shown = streamlines_of(picture)
                if right is None:
                    right = shown
                    covered.append(int((right >= 0).sum()))
                wrong[culling].append(int((shown != right).sum()))
        for culling, renderer in renderers.items():
            results.append(
                {
                    "pipeline": pipeline,
                    "culling": culling,
                    "degrees_per_frame": degrees,
                    "ms": 1e3 * float(np.median(times[culling])),
                    "wrong_pixels": float(np.mean(wrong[culling])),
                    "wrong_pixels_most": int(max(wrong[culling])),
                    "covered_pixels": float(np.mean(covered)),
                }
            )
            renderer.release()
            print(results[-1], flush=True)
    return results


def table(about: dict, results: list[dict]) -> str:
    """Return the results in Markdown."""
    width, height = about["size"]
    lines = [
        f"# Culling on {about['card']}: error against run time",
        "",
        f"{about['driver']}, {about['system']}, {about['cpus']} CPU cores, {about['date']}; pipeline "
        f"`{about['pipeline']}`, {about['segments'] / 1e6:,.1f} M segments of {about['step_mm']:g} mm, "
        f"{width}×{height}. *wrong*: pixels that differ from the picture without culling, mean (most) over the frames, "
        "and their share of the covered ones.",
        "",
        "| degrees per frame | culling | ms per frame, median | times none | wrong pixels | share |",
        "|---|---|---|---|---|---|",
    ]
    bases = {row["degrees_per_frame"]: row["ms"] for row in results if row["culling"] == "none"}
    for row in results:
        base = bases[row["degrees_per_frame"]]
        share = row["wrong_pixels"] / max(row["covered_pixels"], 1)
        lines.append(
            f"| {turn_of(row)} | {row['culling']} | {row['ms']:.1f} | {base / row['ms']:.2f} "
            f"| {row['wrong_pixels']:,.0f} ({row['wrong_pixels_most']:,}) | {100 * share:.4f} % |"
        )
    return "\n".join(lines) + "\n"


def turn_of(row: dict) -> str:
    """Return how the camera moved, in words."""
    return "still" if row["degrees_per_frame"] == STILL else f"{row['degrees_per_frame']:g}°"


def plot(about: dict, results: list[dict], path: Path) -> None:
    """Draw wrong pixels over time per frame."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    figure, axis = plt.subplots(figsize=(7, 4.5), layout="constrained")
    for index, culling in enumerate(CULLINGS):
        rows = [row for row in results if row["culling"] == culling]
        axis.plot([r["ms"] for r in rows], [r["wrong_pixels"] for r in rows], "o", color=f"C{index}", label=culling)
        for row in rows:
            at = row["ms"], row["wrong_pixels"]
            axis.annotate(turn_of(row), at, textcoords="offset points", xytext=(6, 4), fontsize="small")
    axis.set_xlabel("ms per frame")
    axis.set_ylabel("wrong pixels per frame")
    axis.set_yscale("symlog", linthresh=1)
    axis.set_title(f"{about['card']}, {about['segments'] / 1e6:,.0f} M segments")
    axis.grid(True, alpha=0.2)
    axis.legend()
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main()
