"""Error against run time of the ways that light through a volume is added up, thin to stiff.

Two tables. In the first, rays are cast by the shaders, through a ball and a slope, with transfer functions that are
gentle, that jump, and that are nothing but for one entry; colours and opacities are held against float64 light that is
found cell by cell. In the second, the bare formulae, in float32 and without the shaders' limits to what opacity may be,
are held against closed forms: what leaves 0..1 is unstable::

    python benchmarks/volume_integrators.py --output docs/benchmarks

writes ``volume-integrators-CARD.json``, ``.md`` and ``.png``, named after the card.
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
from pvfiblets.report.volume_fields import DENSE, field, tables
from pvfiblets.report.volume_pictures import light_of
from pvfiblets.volumes import reference
from pvfiblets.volumes.integrators import STABLE_UP_TO, study
from pvfiblets.volumes.options import INTEGRATORS, RaycastOptions
from pvfiblets.volumes.reference_profiles import profiles
from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import RaycastVolume

DENSITIES = (1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3)  # kappa times a step of half a voxel, where it is densest
STEPS = (0.25, 0.5, 1.0)
WRONG = 1e-2


def main() -> None:
    """Measure, and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--densities", type=float, nargs="+", default=list(DENSITIES), help="kappa times half a voxel")
    parser.add_argument("--steps", type=float, nargs="+", default=list(STEPS), help="of rays, voxels")
    parser.add_argument("--voxels", type=int, default=32, help="along each axis")
    parser.add_argument("--repeats", type=int, default=5, help="of timing")
    parser.add_argument("--size", type=int, nargs=2, default=(96, 72))
    parser.add_argument("--output", type=Path, default=Path())
    options = parser.parse_args()
    ctx = context()
    results = [row for name in ("slope", "ball") for row in cast(ctx, name, options)] + formulae(options.densities)
    about = {**machine(ctx), "size": list(options.size), "voxels": options.voxels}
    write(options.output / f"volume-integrators-{card_slug(ctx)}", about, results, table(about, results), plot)


def camera(volume: RaycastVolume, size: tuple[int, int]) -> np.ndarray:
    """Return the matrix of a camera in front of a volume."""
    middle, reach = (np.array(volume.shape) - 1.0) / 2.0, float(max(volume.shape))
    back = np.array([30.0, -41.0, 22.0]) / np.linalg.norm([30.0, -41.0, 22.0])
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    view = np.eye(4)
    view[:3, :3] = right, np.cross(back, right), back
    view[:3, 3] = -view[:3, :3] @ (middle + 2.4 * reach * back)
    near, far, focal = 0.5 * reach, 8.0 * reach, 2.8
    frustum = np.diag([focal * size[1] / size[0], focal, -(far + near) / (far - near), 0.0])
    frustum[2, 3], frustum[3, 2] = -2.0 * far * near / (far - near), -1.0
    return frustum @ view


def cast(ctx: Any, name: str, options: Any) -> list[dict[str, Any]]:
    """Return a result for every integrator, transfer function, density and step, of rays cast by the shaders."""
    volume, size = field(name, options.voxels), tuple(options.size)
    matrix = camera(volume, size)
    through = reference.rays(matrix, size, volume)
    renderer, rows = VolumeRenderer(ctx, volume), []
    for look, rgba in tables().items():
        for density in options.densities:
            transfer = Transfer(rgba, (0.0, 1.0), -0.5 * np.log1p(-DENSE) / density)
            right = reference.composite(volume, transfer, through).reshape(size[1], size[0], 4)
            for step in options.steps:
                for integrator in INTEGRATORS:
                    style = VolumeStyle(casting=RaycastOptions("composite", transfer=transfer, integrator=integrator,
                                                         step=step, stop=0.9999))  # fmt: skip
                    found, seconds = picture(ctx, renderer, matrix, size, style, options.repeats)
                    off = np.abs(found - right).max(axis=-1)
                    rows.append({"table": "rays", "volume": name, "transfer": look, "integrator": integrator,
                                 "kappa_step": density * step / 0.5, "step": step, "max": float(off.max()),
                                 "rms": float(np.sqrt((off**2).mean())), "wrong": float((off > WRONG).mean()),
                                 "ms": 1e3 * seconds})  # fmt: skip
                    print(rows[-1], flush=True)
    renderer.release()
    return rows


def picture(
    ctx: Any, renderer: Any, matrix: np.ndarray, size: tuple[int, int], style: Any, repeats: int
) -> tuple[np.ndarray, float]:
    """Return ``(height, width, 4)`` light, multiplied by opacity, and seconds of process time that it took."""
    view, away = View(size, matrix), View(size, np.diag([1.0, 1.0, 1.0, 1.001]) @ matrix)
    times = []
    for _ in range(repeats):
        renderer.render(away, style)  # else nothing is drawn anew
        ctx.finish()
        start = time.process_time()
        buffer = renderer.render(view, style)
        ctx.finish()
        times.append(time.process_time() - start)
    return light_of(buffer), float(np.median(times))


def formulae(densities: list[float]) -> list[dict[str, Any]]:
    """Return a result for every formula on every profile of which a closed form is known."""
    steps = 64
    rows = study(profiles([density * steps for density in densities]), (steps,))
    return [{"table": "formulae", "profile": row.profile, "integrator": row.method, "kappa_step": row.kappa_ds,
             "max": row.error if np.isfinite(row.error) else None, "bounded": row.bounded} for row in rows]  # fmt: skip


def table(about: dict[str, Any], results: list[dict[str, Any]]) -> str:
    """Return the results in Markdown."""
    width, height = about["size"]
    lines = [
        f"# Error against run time of integrators on {about['card']}",
        "",
        f"{about['driver']}, {about['system']}, {about['cpus']} CPU cores, {about['date']}; {width}×{height} pixels, "
        f"{about['voxels']}³ voxels; the engine without VTK. κΔ: optical depth of a step where it is densest. Errors "
        "are differences of colours, multiplied by opacity, or of opacities to light found in float64, the largest "
        f"over a slope and a ball; 8 bits of colours make up 0.003 of them. *>{WRONG:g}*: share of pixels that are "
        "off by more. *ms*: median process time.",
        "",
        "| transfer | step | κΔ | integrator | max | rms | >0.01 | ms |",
        "|---|---|---|---|---|---|---|---|",
    ]
    cast_rows = [row for row in results if row["table"] == "rays"]
    keys = dict.fromkeys((row["transfer"], row["step"], row["kappa_step"], row["integrator"]) for row in cast_rows)
    for key in keys:
        rows = [row for row in cast_rows
                if (row["transfer"], row["step"], row["kappa_step"], row["integrator"]) == key]  # fmt: skip
        worst = {name: max(row[name] for row in rows) for name in ("max", "rms", "wrong")}
        ms = sum(row["ms"] for row in rows) / len(rows)
        lines.append(f"| {key[0]} | {key[1]:g} | {key[2]:g} | {key[3]} | {worst['max']:.3f} | {worst['rms']:.4f} "
                     f"| {100 * worst['wrong']:.2f} % | {ms:.1f} |")  # fmt: skip
    lines += [
        "",
        "## The bare formulae",
        "",
        "On profiles of 64 steps, in float32, against closed forms: the largest error over all of them, and on how "
        "many what comes out leaves 0..1. *Unstable beyond*: κΔ from which on light grows from step to step. The "
        "shaders limit what a step of `riemann` and `rk4` may give, which hides that but makes it no better.",
        "",
        "| integrator | κΔ | max | leaves 0..1 | unstable beyond |",
        "|---|---|---|---|---|",
    ]
    bare = [row for row in results if row["table"] == "formulae"]
    groups: dict[Any, list[dict[str, Any]]] = {}
    for row in bare:
        groups.setdefault((row["integrator"], float(f"{row['kappa_step']:.1g}")), []).append(row)
    for (integrator, density), rows in sorted(groups.items()):
        errors = [row["max"] for row in rows]
        worst_error = "∞" if None in errors else f"{max(errors):.3g}"
        out = sum(not row["bounded"] for row in rows)
        limit = f"{STABLE_UP_TO[integrator]:.3g}" if integrator in STABLE_UP_TO else "never"
        told = f"**{out} of {len(rows)}**" if out else "no"
        lines.append(f"| {integrator} | {density:g} | {worst_error} | {told} | {limit} |")
    return "\n".join(lines) + "\n"


def plot(about: dict[str, Any], results: list[dict[str, Any]], path: Path) -> None:
    """Draw errors over density, a panel for each transfer function, then those of the bare formulae."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    rays = [row for row in results if row["table"] == "rays"]
    middle = sorted({row["step"] for row in rays})[len({row["step"] for row in rays}) // 2]
    looks = list(dict.fromkeys(row["transfer"] for row in rays))
    figure, axes = plt.subplots(1, len(looks) + 1, figsize=(3.6 * (len(looks) + 1), 3.8), layout="constrained",
                                sharey=True)  # fmt: skip
    for axis, look in zip(axes, [*looks, None], strict=True):
        chosen = [row for row in results if (row.get("transfer") == look and row.get("step") == middle)
                  or (look is None and row["table"] == "formulae")]  # fmt: skip
        for integrator in dict.fromkeys(row["integrator"] for row in chosen):
            number = INTEGRATORS.index(integrator)
            worst: dict[float, float] = {}
            wild = set()
            for row in chosen:
                if row["integrator"] == integrator:
                    at = float(f"{row['kappa_step']:.2g}")
                    worst[at] = max(worst.get(at, 0.0), 1e3 if row["max"] is None else min(row["max"], 1e3))
                    wild |= {at} if row.get("bounded") is False else set()
            x = sorted(worst)
            axis.loglog(x, [max(worst[at], 1e-6) for at in x], "o-", color=f"C{number}", markersize=3,
                        linewidth=2.5 if integrator == "adaptive" else 1, label=integrator)  # fmt: skip
            axis.loglog(sorted(wild), [max(worst[at], 1e-6) for at in sorted(wild)], "x", color=f"C{number}",
                        markersize=10)  # fmt: skip
        axis.axhline(WRONG, color="black", linestyle=":", linewidth=1)
        axis.set_title(f"{look}, step {middle:g}" if look else "bare formulae; x: leaves 0..1", size="medium")
        axis.set_xlabel("κΔ")
        axis.grid(True, which="major", alpha=0.2)
        axis.legend(fontsize="x-small")
    axes[0].set_ylabel("largest error")
    figure.suptitle(about["card"].split("(")[0].strip(), size="medium")
    figure.savefig(path, dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    main()
