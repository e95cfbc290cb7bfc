"""The study of ray-cast volumes: integrators from thin to stiff, what else may be set, ambient occlusion by rays."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.synthetic.vessels import vessel_tree
from pvfiblets.volumes import FILTERS
from pvfiblets.volumes.raycast_options import INTEGRATORS, RaycastOptions

from ...cameras import by_turns
from ...drawing import Part, WindowPart, run_parts
from ...record import Axes, Figure, Record
from ...study import Options, Study
from ...timing import Comparison, turns_of
from .drawing import drawing, drawn
from .integrators import LIGHT_SIZE, SIDE, integrators
from .occlusion import RADIUS, openness
from .pictures import GroundTruth, colours_of, ground_truth_of, places
from .scene import Look, circle, look_of
from .windows import beside_vtk

if TYPE_CHECKING:
    import moderngl

PICTURE_STEPS, QUICK_PICTURE_STEPS = (2.0, 1.0, 0.5, 0.25, 0.125), (1.0, 0.25)
VESSELS, QUICK_VESSELS = 128, 48
SIZE, QUICK_SIZE = 256, 128
PIXELS, QUICK_PIXELS = 3000, 500
REFINEMENTS = {"no refinement": ("none", (1,)), "regula falsi": ("regula-falsi", (1, 2, 3, 5, 8)),
               "Newton": ("newton", (1, 2, 4))}  # fmt: skip
DIFFERS = 4  # levels of 255: pixels farther from the default's are counted


# ------------------------------------------------------------------------------------------------------------ pictures


def settings(mode: str, quick: bool, spread: float) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield the varied field, its value, and the non-default fields of `RaycastOptions`; the default is first."""
    yield "default", "", {}
    steps: tuple[float, ...] = QUICK_PICTURE_STEPS if quick else PICTURE_STEPS
    if mode == "isosurface":
        steps = ()  # the default takes none
    searched: dict[str, Any] = {} if mode == "composite" else {"refine": "regula-falsi"}
    wanted = {f"{step:g} voxels": {"step": step, **searched} for step in steps}
    yield from (("step", how, fields) for how, fields in wanted.items() if fields != {"step": RaycastOptions.step})
    if mode == "isosurface":
        for name, (refine, counts) in REFINEMENTS.items():
            for count in (1, 3) if quick and len(counts) > 1 else counts:
                yield from _at_steps(name, _iterations(count) if len(counts) > 1 else "", quick,
                                     {"refine": refine, "iterations": count})  # fmt: skip
    if mode == "composite":
        for name in INTEGRATORS if not quick else ("exponential", "romberg"):
            yield from _at_steps("integrator", name, quick, {"integrator": name})
        yield from (("early end", f"opacity {stop:g}", {"stop": stop}) for stop in (0.9, 1.0))
        for part in (0.01,) if quick else (0.002, 0.01, 0.05):
            yield "homogeneous nodes", f"{100.0 * part:g} % of the range", {"homogeneous": part * spread}
        yield "even nodes not as one", "", {"recon": False}
    yield "jitter", "", {"jitter": True, **searched}
    yield "no octree", "", {"octree": False}
    for stride in (2, 4):
        for at in (0.05,) if quick else (0.01, 0.05, 0.2):
            how = f"every {'other' if stride == 2 else 'fourth'} pixel, threshold {at:g}"
            yield "sparse", how, {"sparse": stride, "sparse_threshold": at}


def _iterations(count: int) -> str:
    return f"{count} iteration{'s' if count > 1 else ''}"


def _at_steps(name: str, how: str, quick: bool, fields: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield fields at the default step and, in a full report, at all others; never the program's own default."""
    own = {key: RaycastOptions.__dataclass_fields__[key].default for key in fields}
    for step in (RaycastOptions.step,) if quick else PICTURE_STEPS:
        usual = step == RaycastOptions.step
        if fields != own:
            at = [how] if how else []
            at += [] if usual else [f"step {step:g}"]
            yield name, ", ".join(at), fields if usual else {**fields, "step": step}


def pictures(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
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
            part = options.share(1.0 / (len(cases) - number))
            if not part.lasts(name):
                continue
            look = look_of(volume, mode)
            exact = ground_truth_of(volume, look, cameras, QUICK_PIXELS if options.quick else PIXELS, kind)
            part.budget = part.budget.share()  # the reference is no measurement
            yield from _varied(ctx, renderer, look, exact, name, kind, float(np.ptp(volume.value_range)),
                               float(volume.spacing.mean()), part)  # fmt: skip
    finally:
        renderer.release()


def _varied(
    ctx: moderngl.Context, renderer: Any, look: Look, exact: GroundTruth, name: str, kind: str, spread: float,
    spacing: float, options: Options,
) -> Iterator[Record]:  # fmt: skip
    from pvfiblets.engine.volumes import VolumeStyle

    cameras = exact.colours.cameras
    timed = Comparison(name, options, turns_of(ctx), len(cameras))
    plain: list[Any] = []
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
        plain = plain or shown
        errors = {"colour rms": Figure(exact.colours.error(shown), "of 1")}
        levels = np.rint(255.0 * np.abs(np.stack(shown) - np.stack(plain)).max(axis=-1))
        errors["unlike the default"] = Figure(100.0 * float((levels > DIFFERS).mean()), "%")
        if look.mode == "isosurface":
            found = places(exact, depths, spacing)
            errors["place"] = Figure(found["position"], "voxels")
            errors |= {key: Figure(100.0 * found[key], "%") for key in ("missed", "false")}
        record = Record(
            data=name,
            group="pictures" if kind == "trilinear" else "filters",
            approximation="a picture of a volume",
            method=varied,
            setting=how,
            errors=errors,
            ours=True,
            default=varied == "default",
        )
        timed.add(record, draw=by_turns(drawing(ctx, renderer, style), cameras))
    yield from timed.finish()


# --------------------------------------------------------------------------------------------------------------- study


PARTS: dict[Part, float] = {integrators: 4.0, pictures: 4.0, openness: 2.0}
IN_WINDOWS: dict[WindowPart, float] = {beside_vtk: 4.0}
"""What is measured, and by what weight each part has its share of the time."""


def run(options: Options) -> Iterator[Record]:
    """Yield records part by part, each with its share of what time is left."""
    return run_parts(PARTS, options, IN_WINDOWS)


STUDY = Study(
    name="volumes",
    title="Ray-cast volumes",
    approximates=(
        "Light along rays through a volume, added up step by step: integrators, steps, early ends, skipped "
        "nodes, sparse rays; where surfaces lie; ambient occlusion by few rays."
    ),
    axes=(
        Axes("light", "times/draw", "errors/light rms", "ms per frame", "rms error of light and opacity, of 1"),
        Axes("largest", "times/draw", "errors/light max", "ms per frame", "largest error of light, of 1"),
        Axes("stiff", "", "errors/max at κΔ ", "κΔ of a step of half a voxel", "largest error of light", series=True),
        Axes("colour", "times/draw", "errors/colour rms", "ms per frame", "rms error of colours, of 1"),
        Axes("place", "times/draw", "errors/place", "ms per frame", "mean error of a surface's place, voxels"),
        Axes("openness", "times/occlusion", "errors/openness rms", "ms per frame", "rms error of openness, of 1"),
    ),
    notes=(
        "The right answer is found in float64, ray by ray and cell by cell, without steps "
        "(report/studies/volumes/reference.py), in a sample of the pixels whose rays meet the volume. Colours and "
        "opacities are from 0 to 1; pictures keep them in 8 bits, which makes up 0.003 of largest errors and 0.001 of "
        "rms.",
        f"Integrators: a ball and a slope of {SIDE}³ voxels, {LIGHT_SIZE[0]}×{LIGHT_SIZE[1]} pixels; transfer "
        "functions that rise gently (*ramp*), that jump (*edge*), and that are zero but for one entry (*peak*) or "
        "several (*peaks*). κΔ is the optical depth of a step of half a voxel where they are densest. The default is "
        "*adaptive*: it halves steps where one look-up in a pre-integrated table is not enough, and is *preintegrated* "
        "elsewhere.",
        "Pictures: a synthetic tree of vessels in each mode, one thing varied at a time, integrators and refinements "
        "at each step: its length in voxels; *early end*, the opacity at which a ray ends; *homogeneous nodes*, whose "
        " values are taken as one if they differ by no more; *nodes as one*, where neither colour nor opacity "
        "changes; *sparse*, rays for every other or fourth pixel first, and between them where those differ by more "
        "than the threshold. Surfaces: *place* is the mean distance along the ray from the right surface; a missed or "
        f"false one counts as a voxel. *unlike the default*: pixels more than {DIFFERS} of 255 levels off it.",
        f"Occlusion: the share of a surface's open side that rays of {RADIUS:g} mm find empty (Lesar 2015, equation "
        "10), beside a rule of 48² directions whose rays end at exact roots; *independent rays*: the rms of the same "
        "number of random rays. The time is that of the pass alone. Where software draws, times are of the processor, "
        "all threads; on a graphics card they are elapsed.",
        "*in a window*: `plotter.add_raycast_volume` and `plotter.add_volume(mapper='gpu')` in PyVista windows, one "
        "light at the eye, one transfer function, the same lengths of steps: compare times at equal errors. *cast*: "
        "the share of the octree's leaves that is not skipped.",
    ),
    run=run,
)
