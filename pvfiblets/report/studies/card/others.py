"""The card's check of spline tubes, lines with halos and ray-cast volumes, each beside its float64 reference."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.engine.gbuffer import EMPTY as NO_KEY
from pvfiblets.engine.view import View

from ...cameras import Camera, orbit
from ..tubes.pictures import Truth, helices, reversed_depth_of
from .findings import EMPTY
from .scenes import SIZE, SMALL, Judged, Scene

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.engine.gbuffer import GBuffer
    from pvfiblets.tubes import SplineTubes
    from pvfiblets.volumes import RaycastVolume

TURNS = 90  # pictures of a whole turn
PICTURES = 4
TUBES, HELICES, VOXELS = 5, 6, 40
PIXELS = 600  # of them that are looked at
SILHOUETTE, DEPTH = 0.05, 1e-2  # pixels, radii (99th percentile)
KINDS, HALO_DEPTH = 0.5, 0.02  # percent of pixels; mm, 99th percentile
COLOUR, OFF, PIXELS_OFF = 0.004, 0.02, 0.05  # of 1; steps of half a voxel may miss an edge here and there

Array = npt.NDArray[np.float64]
Made = Iterator[tuple[str, Callable[[], Scene]]]


# --------------------------------------------------------------------------------------------------------------- tubes


def capsules_of(lines: Sequence[Array], radius: float) -> SplineTubes:
    """Return polylines as spline tubes: straight segments of one radius, each with nodes of its own."""
    from pvfiblets.tubes import SplineTubes

    begin, end = (np.concatenate([line[part] for line in lines]) for part in (slice(None, -1), slice(1, None)))
    points = np.stack([begin, end], axis=1).reshape(-1, 3)
    n = len(begin)
    return SplineTubes(
        points=points, segments=np.arange(2 * n).reshape(n, 2), radius=np.full(2 * n, radius),
        tangents=np.repeat(end - begin, 2, axis=0), radius_slopes=np.zeros(2 * n), scaled=False,
        tubes=np.repeat(np.arange(len(lines)), [len(line) - 1 for line in lines]), n_tubes=len(lines),
    )  # fmt: skip


def judge_depths(gbuffer: GBuffer, tubes: Any, camera: Camera) -> Judged:
    """Hold a G-buffer against where rays meet tubes."""
    truth = _truth(tubes, camera)
    keys = np.frombuffer(gbuffer.depth.read(), np.uint32)
    there = keys != NO_KEY
    found = truth.errors(camera.distance(reversed_depth_of(keys)), there)
    figures = {EMPTY: float(not there.any()), "silhouette, pixels": found["silhouette"],
               "depth, radii": found["depth p99"]}  # fmt: skip
    wrong = (there != truth.there).reshape(camera.size[::-1])
    pictures = {"drawn": there.reshape(wrong.shape), "right": truth.there.reshape(wrong.shape), "wrong": wrong}
    return Judged(figures, {EMPTY: 0.0, "silhouette, pixels": SILHOUETTE, "depth, radii": DEPTH}, pictures)


def tubes_part(ctx: moderngl.Context) -> Made:
    """Yield every solver and every silhouette of spline tubes."""
    from pvfiblets.engine.tubes.options import SILHOUETTES, SOLVERS

    for solver in SOLVERS:
        yield f"solver {solver}", partial(_tubes, ctx, solver=solver)
    for silhouettes in SILHOUETTES:
        yield f"silhouettes {silhouettes}", partial(_tubes, ctx, silhouettes=silhouettes)
    yield "no culling", partial(_tubes, ctx, culling=None)


@cache
def _helices() -> tuple[Any, list[Camera]]:
    tubes = helices(TUBES)
    return tubes, orbit(tubes, "far", TURNS, SMALL)[:PICTURES]


@cache
def _truth(tubes: Any, camera: Camera) -> Truth:
    return Truth.from_tubes(tubes, camera)  # the same for all solvers


def _tubes(ctx: moderngl.Context, **options: Any) -> Scene:
    from pvfiblets.engine.tubes import TubeRenderer, TubeStyle

    tubes, path = _helices()
    renderer = TubeRenderer(ctx, tubes, **options)

    def draw(number: int) -> GBuffer:
        view = View(path[number].size, path[number].model_view_projection)
        return renderer.render(view, TubeStyle(min_width=0.0))

    return Scene(draw, lambda last: judge_depths(last, tubes, path[PICTURES - 1]), renderer.release)


# --------------------------------------------------------------------------------------------------------------- halos


def halos_part(ctx: moderngl.Context) -> Made:
    """Yield looks of lines and points with halos."""
    yield "lines", partial(_halos, ctx)
    yield "tapered ends", partial(_halos, ctx, n_tapered=3)
    yield "bent halos", partial(_halos, ctx, displacement="square")
    yield "points", partial(_halos, ctx, points=True)


def _halos(ctx: moderngl.Context, points: bool = False, **more: Any) -> Scene:
    from pvfiblets.engine.halos import HaloRenderer
    from pvfiblets.halos import HaloPoints
    from pvfiblets.report.studies.halos.reference import picture

    from ..halos.exact import pixel_errors
    from ..halos.pictures import darkness_of, finer, look_of
    from ..halos.pictures import helices as halo_helices
    from ..halos.pictures import orbit as halo_orbit

    drawn: Any = halo_helices(HELICES)
    if points:
        drawn = HaloPoints(drawn.points)
    look = look_of(drawn, **more)
    path = halo_orbit(drawn, 1, PICTURES - 1, SIZE)[0]
    renderer = HaloRenderer(ctx, drawn)

    def draw(number: int) -> GBuffer:
        return renderer.render(View(path[number].size, path[number].model_view_projection), finer(look, 1))

    def judge(last: Any) -> Judged:
        camera = path[PICTURES - 1]
        truth = picture(drawn, look, camera.model_view_projection, camera.size)
        dark = darkness_of(last)
        found = pixel_errors(last, dark, truth, camera)
        figures = {EMPTY: float(not dark.any()), "line or halo, %": found["kind"].value,
                   "darkness, %": found["mean"].value, "depth, mm": found["depth"].value}  # fmt: skip
        limits = {EMPTY: 0.0, "line or halo, %": KINDS, "darkness, %": KINDS, "depth, mm": HALO_DEPTH}
        off = np.abs(dark - truth.ink) > 0.25
        return Judged(figures, limits, {"drawn": dark > 0.5, "right": truth.ink > 0.5, "wrong": off})

    return Scene(draw, judge, renderer.release)


# ------------------------------------------------------------------------------------------------------------- volumes


@cache
def _waves() -> RaycastVolume:
    """Return a smooth ball with waves on it: no detail is finer than a voxel."""
    from pvfiblets.volumes import RaycastVolume

    x, y, z = np.meshgrid(*[np.linspace(-1.0, 1.0, VOXELS)] * 3, indexing="ij")
    waves = np.cos(9.0 * x) * np.cos(7.0 * y) * np.cos(8.0 * z)
    values = np.clip(1.2 - np.sqrt(x * x + y * y + z * z) + 0.2 * waves, 0.0, None)
    return RaycastVolume(values.astype(np.float32))


def volumes_part(ctx: moderngl.Context) -> Made:
    """Yield modes and filters of ray-cast volumes."""
    from pvfiblets.volumes import FILTERS

    for mode in ("composite", "mip", "isosurface"):
        yield f"{mode}", partial(_volume, ctx, mode)
    for name in FILTERS:
        if name != "trilinear":
            yield f"isosurface, {name}", partial(_volume, ctx, "isosurface", name)
    yield "composite, no octree", partial(_volume, ctx, "composite", octree=False)
    yield "mip, no octree", partial(_volume, ctx, "mip", octree=False)


def _volume(ctx: moderngl.Context, mode: str, filter: str = "trilinear", **more: Any) -> Scene:  # noqa: A002
    from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle

    from ..volumes.pictures import colours_of
    from ..volumes.scene import circle, look_of, truth

    volume = _waves()
    look = look_of(volume, mode)
    cameras = circle(volume, PICTURES, SMALL)
    renderer = VolumeRenderer(ctx, volume)
    style = VolumeStyle(casting=look.casting(filter=filter, **more))

    def draw(number: int) -> GBuffer:
        camera = cameras[number]
        return renderer.render(View(camera.size, camera.model_view_projection), style)

    def judge(last: Any) -> Judged:
        camera = cameras[PICTURES - 1]
        picture = colours_of(last, look, camera)
        right = truth(volume, look, [camera], PIXELS, filter)
        at = right.pixels[0]
        off = np.abs(picture[at[:, 0], at[:, 1]] - right.colours[0][0]).max(axis=1)
        figures = {EMPTY: float(not picture.any()), "median colour": float(np.median(off)),
                   "pixels off": float((off > OFF).mean())}  # fmt: skip
        limits = {EMPTY: 0.0, "median colour": COLOUR, "pixels off": PIXELS_OFF}
        return Judged(figures, limits, {"drawn": (255.0 * picture).astype(np.uint8)})

    return Scene(draw, judge, renderer.release)
