"""Error against run time of ambient occlusion by rays: how far few rays are from many, and what rays cost.

Lesar 2015, equation (10). Each picture is held against the mean of many of the most rays, each with another seed. That
mean is held, at some pixels, against the float64 reference, whose rays end at exact roots in each cell: what is left
is not of chance but of the step by which rays look at the volume::

    python benchmarks/volume_occlusion.py --output docs/benchmarks

writes ``volume-occlusion-CARD.json``, ``.md`` and ``.png``, named after the card.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

import numpy as np
from orbit import card_slug, context, machine, write

from pvfiblets.engine import View
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
from pvfiblets.engine.volumes.occlusion import MAX_SAMPLES, RayOcclusionPass
from pvfiblets.report.volume_openness import SETS, exact_openness, seen_from
from pvfiblets.volumes import reference
from pvfiblets.volumes.options import RaycastOptions

SAMPLES = (4, 8, 16, 32, 64, 128, 256, 512)


def main() -> None:
    """Measure, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", nargs="+", choices=list(SETS), default=list(SETS))
    parser.add_argument("--voxels", type=int, default=128, help="along each side of the volume")
    parser.add_argument("--samples", type=int, nargs="+", default=list(SAMPLES), help="rays of a pixel")
    parser.add_argument("--radius", type=float, default=12.0, help="mm of a ray")
    parser.add_argument("--step", type=float, default=0.5, help="of a ray, voxels")
    parser.add_argument(
        "--many", type=int, nargs=2, default=(2, MAX_SAMPLES), help="seeds and rays of the right picture"
    )
    parser.add_argument("--pixels", type=int, default=100, help="at which the float64 reference is asked")
    parser.add_argument("--repeats", type=int, default=3, help="of timing, each with another seed")
    parser.add_argument("--size", type=int, nargs=2, default=(400, 400))
    parser.add_argument("--output", type=Path, default=Path())
    options = parser.parse_args()
    ctx = context()
    results = [row for name in options.sets for row in measured(ctx, name, options)]
    kept = ("voxels", "radius", "step", "size", "repeats", "pixels", "many")
    about = {**machine(ctx), **{name: getattr(options, name) for name in kept}}
    write(options.output / f"volume-occlusion-{card_slug(ctx)}", about, results, table(about, results), plot)


def measured(ctx: Any, name: str, options: Any) -> list[dict[str, Any]]:
    """Return a result for every number of rays, and before them one of the right picture itself."""
    make, value, away = SETS[name]
    volume = make(options.voxels)
    renderer, occlusion = VolumeRenderer(ctx, volume), RayOcclusionPass(ctx)
    casting = RaycastOptions(values=(value,), step=options.step)
    matrix = seen_from(volume, options.size, away)
    try:
        view = View(tuple(options.size), matrix)
        buffer = renderer.render(view, VolumeStyle(casting=casting))
        shown = np.frombuffer(buffer.depth.read(), "u4") != 0xFFFFFFFF

        def openness(samples: int, seed: int, *, smooth: bool = False) -> np.ndarray:
            rays = {"radius": options.radius, "samples": samples, "seed": seed, "smooth": smooth}
            texture = occlusion.draw(renderer, buffer, casting, view, **rays)
            return np.frombuffer(texture.read(), "f2")[shown].astype(np.float64) / samples

        seeds, most = options.many
        right = np.mean([openness(most, 1000 + seed) for seed in range(seeds)], axis=0)
        common = {"set": name, "pixels": int(shown.sum()), "openness": float(right.mean())}
        rows = [{**common, "reference": True, **against_reference(volume, value, matrix, shown, right, options)}]
        print(rows[-1], flush=True)
        openness(1, 0, smooth=True)  # programs are made
        for samples, smooth in ((samples, smooth) for samples in options.samples for smooth in (False, True)):
            off, wall, cpu = [], [], []
            for seed in range(options.repeats):
                ctx.finish()
                started = time.perf_counter(), time.process_time()
                picture = openness(samples, seed, smooth=smooth)
                wall.append(1e3 * (time.perf_counter() - started[0]))
                cpu.append(1e3 * (time.process_time() - started[1]))
                off.append(np.abs(picture - right))
            by_chance = float(np.sqrt(np.mean(right * (1.0 - right)) / samples))
            rows.append({**common, "reference": False, "samples": samples, "smooth": smooth,
                         "ms": float(np.median(wall)), "ms_cpu": float(np.median(cpu)),
                         "ms_spread": [min(wall), max(wall)], **errors(np.array(off)),
                         "rms_by_chance": by_chance})  # fmt: skip
            print(rows[-1], flush=True)
        return rows
    finally:
        occlusion.release()
        renderer.release()


def errors(off: np.ndarray) -> dict[str, float]:
    """Return how far openness is off, as parts of 1."""
    return {"mean": float(off.mean()), "rms": float(np.sqrt((off**2).mean())), "p99": float(np.percentile(off, 99)),
            "max": float(off.max())}  # fmt: skip


def against_reference(
    volume: Any, value: float, matrix: np.ndarray, shown: np.ndarray, right: np.ndarray, options: Any
) -> dict[str, Any]:
    """Return how far the picture of many rays is from rays that end at exact roots, and the mean difference."""
    width, height = options.size
    chosen = np.random.default_rng(0).permutation(np.flatnonzero(shown))[: options.pixels]
    through = reference.rays(matrix, (width, height), volume)[chosen // width, chosen % width]
    hits = reference.isosurface(volume, value, through)
    found = np.isfinite(hits.t)
    exact = exact_openness(volume, value, through[found], hits.gradient[found], hits.t[found], options.radius)
    off = right[np.searchsorted(np.flatnonzero(shown), chosen[found])] - exact
    size = np.abs(off)
    return {
        "asked": len(size),
        "bias": float(off.mean()),
        "median": float(np.median(size)),
        **errors(size),
    }


def table(about: dict[str, Any], results: list[dict[str, Any]]) -> str:
    """Return the results in Markdown."""
    width, height = about["size"]
    seeds, most = about["many"]
    lines = [
        f"# Error against run time of ambient occlusion by rays on {about['card']}",
        "",
        f"{about['driver']}, {about['system']}, {about['cpus']} CPU cores, {about['date']}; {about['voxels']}³ voxels, "
        f"{width}×{height}, rays of {about['radius']:g} mm in steps of {about['step']:g} voxels; the engine without "
        f"VTK. Errors are differences of openness, 0 to 1, to the mean of {seeds} pictures of {most} rays a pixel. *By "
        "chance*: rms that as many independent rays would have. *smooth*: with the mean over neighbouring pixels of "
        "a surface. *ms*: median of the pass, least to greatest in "
        "brackets; *CPU ms*: of all cores, which on a shared machine says more. *Reference*: how far that mean is, at "
        f"{about['pixels']} pixels, from float64 rays that end at exact roots.",
        "",
        "| set | rays | smooth | ms | CPU ms | mean | rms | by chance | p99 | max |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for row in results:
        mean, rms, p99, most_off = (f"{row[key]:.4f}" for key in ("mean", "rms", "p99", "max"))
        if row["reference"]:
            lines.append(f"| {row['set']} | reference | | | | {mean} | {rms} | | {p99} | {most_off} |")
            continue
        low, high = row["ms_spread"]
        lines.append(
            f"| {row['set']} | {row['samples']} | {'yes' if row['smooth'] else 'no'} "
            f"| {row['ms']:.0f} ({low:.0f}–{high:.0f}) | {row['ms_cpu']:.0f} "
            f"| {mean} | {rms} | {row['rms_by_chance']:.4f} | {p99} | {most_off} |"
        )
    return "\n".join(lines) + "\n"


def plot(about: dict[str, Any], results: list[dict[str, Any]], path: Path) -> None:
    """Draw the rms error over the number of rays, and over time."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.8), layout="constrained", sharey=True)
    for number, name in enumerate(dict.fromkeys(row["set"] for row in results)):
        for smooth, mark in ((False, "o-"), (True, "s--")):
            rows = [row for row in results if row["set"] == name and row.get("smooth") is smooth]
            samples, rms = [row["samples"] for row in rows], [row["rms"] for row in rows]
            look = {"color": f"C{number}", "label": f"{name}, smooth" if smooth else name}
            left.loglog(samples, rms, mark, **look)
            right.loglog([row["ms_cpu"] for row in rows], rms, mark, **look)
            for row in rows:
                right.annotate(str(row["samples"]), (row["ms_cpu"], row["rms"]), textcoords="offset points",
                               xytext=(4, 4), size="x-small")  # fmt: skip
        chance = [row["rms_by_chance"] for row in rows]
        left.loglog(samples, chance, ":", color=f"C{number}", label=f"{name}, by chance")
    left.set_xlabel("rays a pixel")
    right.set_xlabel("CPU ms a picture")
    left.set_ylabel("rms error of openness")
    left.legend(fontsize="small")
    for axis in (left, right):
        axis.grid(True, which="both", alpha=0.2)
    figure.suptitle(about["card"].split("(")[0].strip(), size="medium")
    figure.savefig(path, dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    main()
