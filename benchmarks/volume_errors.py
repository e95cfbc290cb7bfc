"""Error against run time of ray-cast volumes: step, filter, refinement, integrator, early end, sparse casting.

Each picture of the engine is held against rays in float64 that know no steps (`pvfiblets.volumes.reference`): colours,
from 0 to 1, and of surfaces the place along the ray, in voxels, against the roots of the cubic that the field is within
each cell. Each filter is held against its own field. What nothing beats in both time and error is marked::

    python benchmarks/volume_errors.py --output docs/benchmarks

writes ``volume-errors-CARD.json``, ``.md`` and ``.png``, named after the card. Times are the processor's, of all
threads, beside those by the clock.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from orbit import card_slug, context, machine, write
from volume_effects import DIFFERS, differing
from volume_errors_told import plot, table
from volume_measure import Measured, nudged
from volume_scene import FOLDER, MODES, known_data, make_data

from pvfiblets.engine import View
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
from pvfiblets.report.cameras import Camera
from pvfiblets.report.volume_pictures import Right, colours_of, places, right_of
from pvfiblets.report.volume_scene import circle, look_of
from pvfiblets.volumes import FILTERS
from pvfiblets.volumes.options import INTEGRATORS, RaycastOptions

STEPS = (2.0, 1.0, 0.5, 0.25, 0.125)
FEW_STEPS = (1.0, 0.5, 0.25)
REFINEMENTS = {"none": (1,), "regula-falsi": (1, 2, 3, 5, 8), "newton": (1, 2, 4)}
STOPS = (0.9, 0.99, 0.999, 1.0)
HOMOGENEOUS = (0.002, 0.01, 0.05)  # of the range of values
STRIDES, THRESHOLDS = (2, 4), (0.01, 0.05, 0.2)
QUICK = {"data": ["vessels-32"], "steps": [1.0, 0.5], "size": 96, "pixels": 300, "repeats": 1}


def main() -> None:
    """Measure, and write the table."""
    parser = parsed()
    options = parser.parse_args()
    if options.quick:
        parser.set_defaults(**QUICK)
        options = parser.parse_args()
    ctx = context()
    results = [row for name in options.data for mode in options.modes for row in measured(ctx, name, mode, options)]
    for row in results:
        row["front"] = not beaten(row, results, "rms")
        if "position" in row:
            row["position_front"] = not beaten(row, results, "position")
    about = {**machine(ctx), "size": options.size, "pixels": options.pixels, "seed": options.seed, "differs": DIFFERS}
    write(options.output / f"volume-errors-{card_slug(ctx)}", about, results, table(about, results), plot)


def parsed() -> argparse.ArgumentParser:
    """Return what reads the options."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", nargs="+", type=known_data, default=["vessels-128"], metavar="DATA",
                        help="of vessels-N and brain-N, of N voxels along each side, and brain")  # fmt: skip
    parser.add_argument("--data-folder", type=Path, default=FOLDER, help="where a brain's template may lie")
    parser.add_argument("--modes", nargs="+", choices=MODES, default=list(MODES))
    parser.add_argument("--steps", type=float, nargs="+", default=list(STEPS), help="voxels")
    parser.add_argument("--size", type=int, default=256, help="pixels along a side")
    parser.add_argument("--pixels", type=int, default=4000, help="that are looked at, in each of two pictures")
    parser.add_argument("--repeats", type=int, default=3, help="of timing each of two pictures")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--quick", action="store_true", help="a little of all")
    parser.add_argument("--output", type=Path, default=Path())
    return parser


def settings(mode: str, steps: list[float], spread: float) -> Iterator[tuple[str, dict[str, Any]]]:
    """Return what is varied, and fields of `RaycastOptions`: those left out have their defaults.

    Parameters
    ----------
    mode : str
    steps : list of float
        Voxels.
    spread : float
        Of the volume's values.
    """
    yield "default", {}
    few = [step for step in steps if step in FEW_STEPS] or steps[:1]
    for step in steps:
        yield "step", {"step": step}
        if mode == "isosurface":
            for refine, counts in REFINEMENTS.items():
                yield from (("refinement", {"step": step, "refine": refine, "iterations": n}) for n in counts)
        if mode == "composite":
            yield from (("integrator", {"step": step, "integrator": name}) for name in INTEGRATORS)
    for step in few:
        yield from (("filter", {"step": step, "filter": name}) for name in FILTERS)
        yield "jitter", {"step": step, "jitter": True}
    if mode == "composite":
        yield from (("stop", {"stop": stop}) for stop in STOPS)
        yield from (("homogeneous", {"homogeneous": share * spread}) for share in HOMOGENEOUS)
        if "recon" in RaycastOptions.__dataclass_fields__:
            yield "recon", {"recon": True}
    yield "octree", {"octree": False}
    for stride in STRIDES:
        yield from (("sparse", {"sparse": stride, "sparse_threshold": at}) for at in THRESHOLDS)


def measured(ctx: Any, name: str, mode: str, options: Any) -> list[dict[str, Any]]:
    """Return a row for each setting of one mode."""
    volume = make_data(name, options.seed, options.data_folder)
    look, cameras = look_of(volume, mode), circle(volume, 2, (options.size, options.size))
    rights: dict[str, Right] = {}
    renderer = VolumeRenderer(ctx, volume)
    rows: list[dict[str, Any]] = []
    plain: list[np.ndarray] = []
    done: list[RaycastOptions] = []
    try:
        for varied, fields in settings(mode, options.steps, float(np.ptp(volume.value_range))):
            casting = look.casting(**fields)
            if casting in done[1:]:  # the default itself is measured among its like, too
                continue
            done.append(casting)
            style = VolumeStyle(casting=casting)
            if casting.filter not in rights:
                rights[casting.filter] = right_of(volume, look, cameras, options.pixels, casting.filter)
            of = rights[casting.filter]
            pictures, depths = [], []
            for camera in cameras:
                buffer = renderer.render(View(camera.size, camera.model_view_projection), style)
                pictures.append(colours_of(buffer, look, camera))
                depths.append(np.frombuffer(buffer.depth.read(), np.uint32).reshape(camera.size[::-1]))
            times = Measured()
            for again in zip(*(nudged(camera, options.repeats + 1) for camera in cameras), strict=True):
                for camera in again:
                    times.time(draw, ctx, renderer, camera, style)
            row = {"data": name, "mode": mode, "varied": varied, **said(casting), **times.report()}
            row["rms"] = of.colours.error(pictures)
            if of.along is not None:
                row |= places(of, depths, float(volume.spacing.mean()))
            if varied == "default":
                plain = pictures
            if varied in ("sparse", "recon", "octree", "homogeneous", "stop"):
                row["differing"] = differing(list(zip(pictures, plain, strict=True)))["differing"]
            rows.append(row)
            print(row, flush=True)
    finally:
        renderer.release()
    return rows


def draw(ctx: Any, renderer: Any, camera: Camera, style: Any) -> None:
    """Draw a picture and wait for it."""
    renderer.render(View(camera.size, camera.model_view_projection), style)
    ctx.finish()


def said(casting: RaycastOptions) -> dict[str, Any]:
    """Return the fields that are told of a way to cast, defaults included."""
    told = {"step": casting.step, "filter": casting.filter, "jitter": casting.jitter, "octree": casting.octree,
            "sparse": casting.sparse, "sparse_threshold": casting.sparse_threshold}  # fmt: skip
    if hasattr(casting, "recon"):
        told["recon"] = casting.recon
    if casting.mode == "isosurface":
        told |= {"refine": casting.refine, "iterations": casting.iterations}
    if casting.mode == "composite":
        told |= {"integrator": casting.integrator, "stop": casting.stop, "homogeneous": casting.homogeneous}
    return told


def beaten(row: dict[str, Any], rows: list[dict[str, Any]], error: str) -> bool:
    """Say whether another setting of the same data, mode and filter is no worse in either, and better in one."""
    alike = [other for other in rows if all(other[key] == row[key] for key in ("data", "mode", "filter"))]
    return any(
        other["cpu_ms"] <= row["cpu_ms"] and other[error] <= row[error]
        and (other["cpu_ms"] < row["cpu_ms"] or other[error] < row[error])
        for other in alike
    )  # fmt: skip


if __name__ == "__main__":
    main()
