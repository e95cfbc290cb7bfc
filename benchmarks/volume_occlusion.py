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
from pvfiblets.engine.raycast import RaycastRenderer, RaycastStyle
from pvfiblets.engine.raycast.occlusion import LIFT, MAX_SAMPLES, RayOcclusionPass
from pvfiblets.raycast import reference
from pvfiblets.raycast.casting import Casting
from pvfiblets.raycast.volume import RaycastVolume
from pvfiblets.synthetic.vessels import brain_like, vessel_tree


def opened_head(n: int) -> RaycastVolume:
    """Return a head without its upper third, of which the brain's folds show from above."""
    head = brain_like(n)
    return RaycastVolume(head.values[:, :, : round(0.66 * n)], head.affine)


SETS = {"vessels": (vessel_tree, 90.0, (0.25, -1.0, 0.35)), "head": (opened_head, 85.0, (0.2, -0.4, 1.0))}
"""What to draw, the value of its surface, and where to look at it from."""

SAMPLES = (4, 8, 16, 32, 64, 128, 256, 512)
BESIDE = 0.05  # mm
DIRECTIONS = 48  # along each side of the reference's rule of directions


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
    renderer, occlusion = RaycastRenderer(ctx, volume), RayOcclusionPass(ctx)
    casting = Casting(values=(value,), step=options.step)
    matrix = camera(volume, options.size, away)
    try:
        view = View(tuple(options.size), matrix)
        buffer = renderer.render(view, RaycastStyle(casting=casting))
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


def camera(volume: Any, size: tuple[int, int], away: tuple[float, float, float]) -> np.ndarray:
    """Return a matrix that shows a volume from a direction, and fills the picture with it."""
    bounds = np.array(volume.bounds).reshape(3, 2)
    middle, reach = bounds.mean(axis=1), float(np.ptp(bounds, axis=1).max())
    z = np.array(away) / np.linalg.norm(away)
    x = np.cross([0.0, 0.0, 1.0], z)
    x /= np.linalg.norm(x)
    view = np.eye(4)
    view[:3, :3] = x, np.cross(z, x), z
    view[:3, 3] = -view[:3, :3] @ (middle + 2.2 * reach * z)
    near, far, t = 1.2 * reach, 3.4 * reach, 1.0 / np.tan(np.radians(27.0) / 2.0)
    projection = np.zeros((4, 4))
    projection[0, 0], projection[1, 1] = t * size[1] / size[0], t
    projection[2, 2:] = -(far + near) / (far - near), -2.0 * far * near / (far - near)
    projection[3, 2] = -1.0
    return projection @ view


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


def exact_openness(
    volume: Any, value: float, through: Any, gradients: np.ndarray, t: np.ndarray, radius: float, n: int = DIRECTIONS
) -> np.ndarray:
    """Return equation 10 at hits of rays, by a rule of n x n stratified directions, in float64.

    Parameters
    ----------
    volume : RaycastVolume
    value : float
        Of the surface.
    through : reference.Rays
        ``(k,)`` of the pixels.
    gradients, t : numpy.ndarray
        ``(k, 3)`` and ``(k,)``: at the hits, and mm along the rays to them.
    radius : float
        mm.
    n : int

    Returns
    -------
    numpy.ndarray
        ``(k,)``: share of the directions that meet nothing.
    """
    # The open side is the viewer's by the field next to the hit, not by differences over two voxels.
    before, after = (reference.sample(volume, through.points(t + beside)) for beside in (-BESIDE, BESIDE))
    normals = gradients / np.linalg.norm(gradients, axis=-1, keepdims=True)
    above = before > after
    normals *= np.where(above, 1.0, -1.0)[:, None]
    turn = volume.inverse[:3, :3]
    hits = through.points(t)
    starts = hits + LIFT * normals / np.linalg.norm(normals @ turn.T, axis=-1, keepdims=True)
    wrong = (reference.sample(volume, starts) >= value) != above
    back = hits - LIFT * through.directions / np.linalg.norm(through.directions @ turn.T, axis=-1, keepdims=True)
    starts = np.where(wrong[:, None], back, starts)
    right = np.cross(normals, np.where(np.abs(normals[:, :1]) < 0.7, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]))
    right /= np.linalg.norm(right, axis=-1, keepdims=True)
    u, v = (side.ravel()[:, None] for side in np.meshgrid(*[(np.arange(n) + 0.5) / n] * 2))
    x, y = np.sqrt(u) * np.cos(2.0 * np.pi * v), np.sqrt(u) * np.sin(2.0 * np.pi * v)
    ways = right[:, None] * x + np.cross(normals, right)[:, None] * y + normals[:, None] * np.sqrt(1.0 - u)
    origins = np.broadcast_to(starts[:, None], ways.shape)
    voxels, steps = origins @ turn.T + volume.inverse[:3, 3], ways @ turn.T
    with np.errstate(divide="ignore"):
        ends = np.where(steps > 0.0, (np.array(volume.shape) - 1.0 - voxels) / steps, -voxels / steps)
    far = np.minimum(np.where(steps == 0.0, np.inf, ends).min(axis=-1), radius)
    gone = far <= 0.0
    rays = reference.Rays(origins, ways, np.where(gone, np.nan, 0.0), np.where(gone, np.nan, far), through.matrix)
    return (reference.isosurface(volume, value, rays).value < 0).mean(axis=1)


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
