"""The study of ray-cast volumes: integrators from thin to stiff, what else may be set, ambient occlusion by rays."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from pvfiblets.synthetic.vessels import vessel_tree
from pvfiblets.volumes import FILTERS, RaycastVolume, Transfer, reference
from pvfiblets.volumes.options import INTEGRATORS, RaycastOptions

from .cameras import Camera, by_turns
from .drawing import Part, run_parts
from .record import Axes, Figure, LeftOut, Record
from .study import Options
from .volumes_fields import DENSE, field, tables
from .volumes_occlusion import RADIUS, openness
from .volumes_pictures import Right, colours_of, light_of, places, right_of
from .volumes_scene import TOLERANCE, Look, circle, look_of
from .volumes_timed import LATE, Timed, drawing, drawn, some

__all__ = ["STUDY", "VolumeStudy", "settings"]

DENSITIES, QUICK_DENSITIES = (1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3), (0.1, 10.0, 1e3)
STEPS, QUICK_STEPS = (0.25, 0.5, 1.0), (0.5,)  # voxels, of integrators
BALL = 32  # voxels along each side
LIGHT_SIZE = (96, 72)
LIGHT_PIXELS, QUICK_LIGHT_PIXELS = 3000, 300
PICTURE_STEPS, QUICK_PICTURE_STEPS = (2.0, 1.0, 0.5, 0.25, 0.125), (1.0, 0.25)
VESSELS, QUICK_VESSELS = 128, 48
SIZE, QUICK_SIZE = 256, 128
PIXELS, QUICK_PIXELS = 3000, 500


# --------------------------------------------------------------------------------------------------------- integrators


def integrators(ctx: Any, options: Options, left_out: list[LeftOut]) -> Iterator[Record]:
    """Yield records of every integrator by transfer function, density and step; then how errors grow with density."""
    from pvfiblets.engine.volumes import VolumeRenderer

    volume = field("ball", BALL)
    camera = circle(volume, 1, LIGHT_SIZE)[0]
    renderer = VolumeRenderer(ctx, volume)
    looks = tables()
    chosen = ("ramp", "peaks") if options.quick else tuple(looks)
    try:
        for number, name in enumerate(chosen):
            part = replace(options, budget=options.budget.share(1.0 / (len(chosen) - number)))
            found: list[tuple[float, Record]] = []
            for density in QUICK_DENSITIES if options.quick else DENSITIES:
                transfer = Transfer(looks[name].astype(np.float32), (0.0, 1.0), -0.5 * math.log1p(-DENSE) / density)
                if part.budget.left <= 0.0:
                    left_out.append(LeftOut(f"{name}, κΔ {density:g}", LATE))
                    continue
                for record in _integrated(ctx, renderer, volume, camera, transfer, f"{name}, κΔ {density:g}", part,
                                          left_out):  # fmt: skip
                    found.append((density, record))
                    yield record
            yield from _by_density(name, found)
    finally:
        renderer.release()


def _integrated(
    ctx: Any, renderer: Any, volume: RaycastVolume, camera: Camera, transfer: Transfer, name: str, options: Options,
    left_out: list[LeftOut],
) -> Iterator[Record]:  # fmt: skip
    from pvfiblets.engine.volumes import VolumeStyle

    through = reference.rays(camera.model_view_projection, camera.size, volume)
    at = some(~np.isnan(through.near), QUICK_LIGHT_PIXELS if options.quick else LIGHT_PIXELS)
    right = reference.composite(volume, transfer, through[at[:, 0], at[:, 1]], TOLERANCE)
    timed = Timed(ctx, options, name, "draw")
    for step in QUICK_STEPS if options.quick else STEPS:
        for integrator in INTEGRATORS:
            if not timed.allows(f"{integrator} step {step:g}"):
                continue
            casting = RaycastOptions("composite", transfer=transfer, integrator=integrator, step=step, stop=0.9999)
            style = VolumeStyle(casting=casting)
            off = light_of(drawn(ctx, renderer, camera, style))[at[:, 0], at[:, 1]] - right
            record = Record(
                data=name,
                group=name.partition(",")[0],
                approximation="light along a ray",
                way=integrator,
                setting=f"step {step:g}",
                errors={
                    "light rms": Figure(float(np.sqrt((off**2).mean())), "of 1"),
                    "light max": Figure(float(np.abs(off).max()), "of 1"),
                },
                ours=True,
                default=(integrator, step) == (RaycastOptions.integrator, RaycastOptions.step),
                machine=options.machine,
            )
            timed.add(record, by_turns(drawing(ctx, renderer, style), [camera]), 1)
    yield from timed.finish(left_out)


def _by_density(name: str, found: list[tuple[float, Record]]) -> Iterator[Record]:
    """Yield the largest errors at the default step as lines over the density."""
    for integrator in INTEGRATORS:
        errors = {
            f"max at κΔ {density:g}": record.errors["light max"]
            for density, record in found
            if (record.way, record.setting) == (integrator, f"step {RaycastOptions.step:g}")
        }
        if errors:
            machine = found[0][1].machine
            yield Record(name, "stiff", "light along a ray", integrator, f"step {RaycastOptions.step:g}", errors,
            ours=True,
                         machine=machine)  # fmt: skip


# ------------------------------------------------------------------------------------------------------------ pictures


def settings(mode: str, quick: bool, spread: float) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield what is varied, how, and the fields of `RaycastOptions` that are not its defaults, the default first.

    Parameters
    ----------
    mode : str
    quick : bool
        Fewer of each.
    spread : float
        Of the volume's values.
    """
    yield "default", "", {}
    steps = QUICK_PICTURE_STEPS if quick else PICTURE_STEPS
    yield from (("step", f"{step:g} voxels", {"step": step}) for step in steps if step != RaycastOptions.step)
    if mode == "isosurface":
        yield "no refinement", "", {"refine": "none", "iterations": 1}
        for count in (1, 3):
            yield (
                "regula falsi",
                f"{count} iteration{'s' if count > 1 else ''}",
                {"refine": "regula-falsi", "iterations": count},
            )
            yield "Newton", f"{count} iteration{'s' if count > 1 else ''}", {"refine": "newton", "iterations": count}
    if mode == "composite":
        yield from (("integrator", name, {"integrator": name}) for name in ("exponential", "romberg"))
        yield from (("early end", f"opacity {stop:g}", {"stop": stop}) for stop in (0.9, 1.0))
        for part in (0.01,) if quick else (0.01, 0.05):
            yield "homogeneous nodes", f"{100.0 * part:g} % of the range", {"homogeneous": part * spread}
        yield "nodes as one", "", {"recon": True}
    yield "jitter", "", {"jitter": True}
    yield "no octree", "", {"octree": False}
    for stride in (2, 4):
        for at in (0.05,) if quick else (0.01, 0.05, 0.2):
            how = f"every {'other' if stride == 2 else 'fourth'} pixel, threshold {at:g}"
            yield "sparse", how, {"sparse": stride, "sparse_threshold": at}


def pictures(ctx: Any, options: Options, left_out: list[LeftOut]) -> Iterator[Record]:
    """Yield records of all that may be set, in each mode, on a tree of vessels."""
    from pvfiblets.engine.volumes import VolumeRenderer

    side = QUICK_SIZE if options.quick else SIZE
    volume = vessel_tree(QUICK_VESSELS if options.quick else VESSELS, options.seed, "uint16")
    cameras = circle(volume, 1 if options.quick else 2, (side, side))
    renderer = VolumeRenderer(ctx, volume)
    cases = [(mode, "trilinear") for mode in ("composite", "mip", "isosurface")]
    if not options.quick:
        cases += [(mode, name) for mode in ("composite", "isosurface") for name in FILTERS if name != "trilinear"]
    try:
        for number, (mode, kind) in enumerate(cases):
            name = f"{volume.shape[0]}³ vessels, {mode}" + ("" if kind == "trilinear" else f", {kind}")
            part = replace(options, budget=options.budget.share(1.0 / (len(cases) - number)))
            if part.budget.left <= 0.0:
                left_out.append(LeftOut(name, LATE))
                continue
            look = look_of(volume, mode)
            right = right_of(volume, look, cameras, QUICK_PIXELS if options.quick else PIXELS, kind)
            yield from _varied(ctx, renderer, look, right, name, kind, float(np.ptp(volume.value_range)),
                               float(volume.spacing.mean()), part, left_out)  # fmt: skip
    finally:
        renderer.release()


def _varied(
    ctx: Any, renderer: Any, look: Look, right: Right, name: str, kind: str, spread: float, spacing: float,
    options: Options, left_out: list[LeftOut],
) -> Iterator[Record]:  # fmt: skip
    from pvfiblets.engine.volumes import VolumeStyle

    cameras = right.colours.cameras
    timed = Timed(ctx, options, name, "draw")
    for varied, how, fields in settings(look.mode, options.quick, spread):
        if kind != "trilinear" and varied != "default" and fields.get("step") not in QUICK_PICTURE_STEPS:
            continue  # a tricubic picture takes ten times as long
        if not timed.allows(f"{varied} {how}".strip()):
            continue
        style = VolumeStyle(casting=look.casting(filter=kind, **fields))
        shown, depths = [], []
        for camera in cameras:
            buffer = drawn(ctx, renderer, camera, style)
            shown.append(colours_of(buffer, look, camera))
            depths.append(np.frombuffer(buffer.depth.read(), np.uint32).reshape(camera.size[::-1]))
        errors = {"colour rms": Figure(right.colours.error(shown), "of 1")}
        if look.mode == "isosurface":
            found = places(right, depths, spacing)
            errors["place"] = Figure(found["position"], "voxels")
            errors |= {key: Figure(100.0 * found[key], "%") for key in ("missed", "false")}
        record = Record(
            data=name,
            group="pictures" if kind == "trilinear" else "filters",
            approximation="a picture of a volume",
            way=varied,
            setting=how,
            errors=errors,
            ours=True,
            default=varied == "default",
            machine=options.machine,
        )
        timed.add(record, by_turns(drawing(ctx, renderer, style), cameras), len(cameras))
    yield from timed.finish(left_out)


# --------------------------------------------------------------------------------------------------------------- study


PARTS: dict[Part, float] = {integrators: 4.0, pictures: 4.0, openness: 2.0}
"""What is measured, and by what weight each part has its share of the time."""


class VolumeStudy:
    """Ray-cast volumes by all that may be set, thin to stiff."""

    name = "volumes"
    title = "Ray-cast volumes"
    approximates = (
        "Light along rays through a volume, added up step by step: ways of integration, steps, early ends, skipped "
        "nodes, sparse rays; where surfaces lie; ambient occlusion by few rays."
    )
    axes = (
        Axes("light", "times/draw", "errors/light rms", "ms per frame", "rms error of light and opacity, of 1"),
        Axes("largest", "times/draw", "errors/light max", "ms per frame", "largest error of light, of 1"),
        Axes("stiff", "", "errors/max at κΔ ", "κΔ of a step of half a voxel", "largest error of light", series=True),
        Axes("colour", "times/draw", "errors/colour rms", "ms per frame", "rms error of colours, of 1"),
        Axes("place", "times/draw", "errors/place", "ms per frame", "mean error of a surface's place, voxels"),
        Axes("openness", "times/occlusion", "errors/openness rms", "ms per frame", "rms error of openness, of 1"),
    )
    notes = (
        "What is right is found in float64, ray by ray and cell by cell, without steps "
        "(pvfiblets/volumes/reference.py), in a sample of the pixels whose rays meet the volume. Colours and opacities "
        "are from 0 to 1; pictures keep them in 8 bits, which makes up 0.003 of largest errors and 0.001 of rms.",
        f"Integrators: a ball of {BALL}³ voxels, {LIGHT_SIZE[0]}×{LIGHT_SIZE[1]} pixels; transfer functions that rise "
        "gently (*ramp*), that jump (*edge*), and that are nothing but for one entry (*peak*) or several (*peaks*). κΔ "
        "is the optical depth of a step of half a voxel where they are densest. The program's default is *adaptive*: "
        "it halves steps where one look-up in a pre-integrated table is not enough, and is *preintegrated* elsewhere.",
        "Pictures: a made-up tree of vessels in each mode, one thing varied at a time: length of the step in voxels; "
        "*early end*, the opacity at which a ray ends; *homogeneous nodes*, whose values are taken as one if they "
        "differ by no more; *nodes as one*, where neither colour nor opacity changes; *sparse*, rays for every other "
        "or fourth pixel first, and between them where those differ by more than the threshold. Surfaces: *place* is "
        "the mean distance along the ray from where the surface is, what is missed or false counted as a voxel.",
        f"Occlusion: the share of a surface's open side that rays of {RADIUS:g} mm find empty (Lesar 2015, equation "
        "10), beside a rule of 48² directions whose rays end at exact roots; the time is that of the pass alone. Where "
        "software draws, times are of the processor, of all threads; those of cards are by the clock.",
    )

    def run(self, options: Options, left_out: list[LeftOut]) -> Iterator[Record]:
        """Yield records part by part, each with its share of what time is left."""
        return run_parts(PARTS, options, left_out)


STUDY = VolumeStudy()
