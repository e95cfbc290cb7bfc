"""Integrators of volumes: light from thin to stiff."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.volumes import RaycastVolume, Transfer
from pvfiblets.volumes.raycast_options import INTEGRATORS, RaycastOptions

from ...cameras import Camera, by_turns
from ...record import Figure, Record
from ...study import Options
from ...timing import Comparison, turns_of
from . import reference
from .drawing import drawing, drawn, sample
from .fields import DENSE, field, tables
from .pictures import light_of
from .scene import TOLERANCE, circle

if TYPE_CHECKING:
    import moderngl

DENSITIES, QUICK_DENSITIES = (1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3), (0.1, 10.0, 1e3)
STEPS, QUICK_STEPS = (0.25, 0.5, 1.0), (0.5,)  # voxels
SIDE = 32  # voxels along each side
LIGHT_SIZE = (96, 72)
LIGHT_PIXELS, QUICK_LIGHT_PIXELS = 3000, 300
OFF = 0.01  # of colours and opacities: a share of pixels that are farther off is given


def integrators(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
    """Yield records of every integrator by transfer function, density and step; then how errors grow with density."""
    from pvfiblets.engine.volumes import VolumeRenderer

    looks = tables()
    fields = ("ball",) if options.quick else ("ball", "slope")
    chosen = [(shape, look) for shape in fields for look in (("ramp", "peaks") if options.quick else looks)]
    for number, (shape, look) in enumerate(chosen):
        volume = field(shape, SIDE)
        camera = circle(volume, 1, LIGHT_SIZE)[0]
        name = look if shape == "ball" else f"{look} in a {shape}"
        part = options.share(1.0 / (len(chosen) - number))
        found: list[tuple[float, Record]] = []
        renderer = VolumeRenderer(ctx, volume)
        try:
            for density in QUICK_DENSITIES if options.quick else DENSITIES:
                transfer = Transfer(looks[look].astype(np.float32), (0.0, 1.0), -0.5 * math.log1p(-DENSE) / density)
                if not part.lasts(f"{name}, κΔ {density:g}"):
                    continue
                for record in _integrated(ctx, renderer, volume, camera, transfer, f"{name}, κΔ {density:g}", part):
                    found.append((density, record))
                    yield record
        finally:
            renderer.release()
        yield from _by_density(name, found)


def _integrated(
    ctx: moderngl.Context, renderer: Any, volume: RaycastVolume, camera: Camera, transfer: Transfer, name: str,
    options: Options,
) -> Iterator[Record]:  # fmt: skip
    from pvfiblets.engine.volumes import VolumeStyle

    through = reference.rays(camera.model_view_projection, camera.size, volume)
    at = sample(~np.isnan(through.near), QUICK_LIGHT_PIXELS if options.quick else LIGHT_PIXELS)
    truth = reference.composite(volume, transfer, through[at[:, 0], at[:, 1]], TOLERANCE)
    within = options.share()  # the reference is no measurement
    timed = Comparison(name, within, turns_of(ctx))
    for step in QUICK_STEPS if options.quick else STEPS:
        for integrator in INTEGRATORS:
            if not timed.allows(f"{integrator} step {step:g}"):
                continue
            casting = RaycastOptions("composite", transfer=transfer, integrator=integrator, step=step, stop=0.9999)
            style = VolumeStyle(casting=casting)
            off = light_of(drawn(ctx, renderer, camera, style))[at[:, 0], at[:, 1]] - truth
            record = Record(
                data=name,
                group=name.partition(",")[0].replace(" ", "-"),
                approximation="light along a ray",
                method=integrator,
                setting=f"step {step:g}",
                errors={
                    "light rms": Figure(float(np.sqrt((off**2).mean())), "of 1"),
                    "light max": Figure(float(np.abs(off).max()), "of 1"),
                    f"off by {OFF:g}": Figure(100.0 * float((np.abs(off).max(axis=1) > OFF).mean()), "%"),
                },
                ours=True,
                default=(integrator, step) == (RaycastOptions.integrator, RaycastOptions.step),
            )
            timed.add(record, draw=by_turns(drawing(ctx, renderer, style), [camera]))
    yield from timed.finish()


def _by_density(name: str, found: list[tuple[float, Record]]) -> Iterator[Record]:
    """Yield the largest errors at the default step as lines over the density."""
    for integrator in INTEGRATORS:
        errors = {
            f"max at κΔ {density:g}": record.errors["light max"]
            for density, record in found
            if (record.method, record.setting) == (integrator, f"step {RaycastOptions.step:g}")
        }
        if errors:
            step = f"step {RaycastOptions.step:g}"
            yield Record(name, "stiff", "light along a ray", integrator, step, errors, ours=True)
