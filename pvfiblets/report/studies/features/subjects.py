"""The subjects of the study of features: streamlines, tubes, halos and a volume, and what each of them may have."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource
from pvfiblets.engine.view import MAX_CLIP_PLANES, View

from ...cameras import Camera
from .pictures import PICTURE_EFFECTS, PictureEffect, WholePicture, lens_of
from .scenes import PLAIN, Drawn, Feature, Subject

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.query.regions.surfaces import Surface

LAYERS = 4
WIDTH, RADIUS = 3.0, 0.5  # pixels of wide lines, mm of tubes
GRID = 32  # voxels along a side of a synthetic volume


def _ambient_occlusion(radius: float, surface: bool = False) -> dict[str, Any]:
    from pvfiblets.engine.effects import AmbientOcclusionPass

    def effect(drawn: Drawn, buffer: Any, camera: Camera, _view: View) -> None:
        turned = camera.world_to_camera[:3, :3]
        normals = turned if surface else None
        drawn.passes.draw(
            buffer, lens_of(camera), turned, radius=radius, samples=16, strength=1.0, normals_to_view=normals
        )

    return {"effect": effect, "passes": AmbientOcclusionPass}


def _halos(width: float, depth: float) -> dict[str, Any]:
    from pvfiblets.engine.effects import HaloPass

    def effect(drawn: Drawn, buffer: Any, camera: Camera, _view: View) -> None:
        drawn.passes.draw(buffer, lens_of(camera), width=width, depth=depth, nearest=camera.near)

    return {"effect": effect, "passes": HaloPass}


def _outline(chosen: Any) -> dict[str, Any]:
    from pvfiblets.engine.effects import OutlinePass

    def effect(drawn: Drawn, buffer: Any, _camera: Camera, _view: View) -> None:
        drawn.passes.draw(buffer, chosen, width=2.0)

    return {"effect": effect, "passes": OutlinePass}


def _whole_picture(wanted: PictureEffect) -> dict[str, Any]:
    def effect(drawn: Drawn, buffer: Any, camera: Camera, _view: View) -> None:
        drawn.passes.draw(buffer, camera)

    return {"effect": effect, "passes": lambda ctx: WholePicture(ctx, wanted)}


def _layers(drawn: Drawn, _buffer: Any, _camera: Camera, view: View) -> None:
    drawn.renderer.render_layers(view, drawn.style, LAYERS)


def _summed(mode: str, *, sliced: bool) -> Callable[..., None]:
    from pvfiblets.engine.fiblets.gather.paint import Paint

    def effect(drawn: Drawn, _buffer: Any, _camera: Camera, view: View) -> None:
        drawn.renderer.gather(view, drawn.style, Paint(mode), sliced=sliced)

    return effect


def brain_subject(fiblets: FibletSet) -> Subject:
    """Return streamlines with what can be done to them; ``fiblets`` hold a per-point array ``'height'``."""
    from pvfiblets import regions
    from pvfiblets.engine.fiblets.renderer import FibletRenderer
    from pvfiblets.engine.fiblets.style import FibletStyle

    box = np.array(fiblets.bounds, np.float64).reshape(3, 2)
    middle, sides = box.mean(axis=1), box[:, 1] - box[:, 0]
    diagonal = float(np.linalg.norm(sides))
    inner = np.stack([middle - 0.3 * sides, middle + 0.3 * sides], axis=1).ravel()
    plane = np.array([[1.0, 0.0, 0.0, -middle[0]]])
    affine = np.diag([*(sides / (GRID - 1)), 1.0])
    affine[:3, 3] = box[:, 0]
    volume = VolumeSource(np.indices((GRID,) * 3).sum(0).astype(np.float32), affine)
    half = np.arange(fiblets.n_streamlines) % 2 == 0
    words = np.full(-(-fiblets.n_points // 32), 0x0FFF0FFF, np.uint32)
    few = np.arange(fiblets.n_streamlines) % 200 == 0

    def keeping(wanted: Filter) -> Callable[[Any], None]:
        return lambda renderer: setattr(renderer, "filtering", wanted)

    features = [
        Feature(PLAIN, ""),
        Feature("lines", f"{WIDTH:g} pixels wide", style={"line_width": WIDTH}),
        Feature("lines", f"{WIDTH:g} pixels wide, shaded", style={"line_width": WIDTH, "across": True}),
        Feature("lines", f"tubes of {RADIUS:g} mm", style={"radius": RADIUS, "across": True}),
        Feature("lines", "every point", style={"tolerance": 0.0}),
        Feature("lines", f"{LAYERS} layers", effect=_layers),
        Feature("lines", "all, counted", effect=_summed("", sliced=False)),
        Feature("lines", "all, their mean colours", effect=_summed("orientation", sliced=False)),
        Feature("lines", "all, in slices", effect=_summed("orientation", sliced=True)),
        Feature("values", "stored", style={"values": "height"}),
        Feature("values", "arc length", style={"values": "arc_length"}),
        Feature("values", "curvature", style={"values": "curvature"}),
        Feature("values", "a volume", style={"values": volume}),
        Feature("cut", "plane", view={"clip_planes": plane}),
        Feature("cut", "box", view=_by_planes(regions.Box(inner))),
        Feature("cut", "outside a box", view={"region": ~regions.Box(inner)}),
        Feature("cut", "sphere", view={"region": regions.Sphere(middle, 0.3 * float(sides.min()))}),
        Feature("cut", "mesh", view={"region": torus(middle, 0.35 * float(sides.min()))}),
        Feature("filter", "half of the streamlines", prepare=keeping(Filter(streamlines=half))),
        Feature("filter", "three quarters of the points", prepare=keeping(Filter(points=words))),
        Feature("effects", "ambient occlusion", **_ambient_occlusion(diagonal / 20.0)),
        Feature("effects", "halos", **_halos(diagonal / 250.0, diagonal / 20.0)),
        Feature("effects", "outline of some", **_outline(few)),
        *(Feature("picture", wanted.name, **_whole_picture(wanted)) for wanted in PICTURE_EFFECTS),
        Feature("culling", "none", options={"culling": None}),
        Feature("culling", "coverage", options={"culling": "coverage"}),
        Feature("pipeline", "geometry", options={"pipeline": "geometry"}),
        Feature("pipeline", "tessellation", options={"pipeline": "tessellation"}),
    ]

    def make(ctx: moderngl.Context, **options: Any) -> FibletRenderer:
        return FibletRenderer(ctx, fiblets, **options)

    return Subject("streamlines", make, FibletStyle(), fiblets.bounds, features)


def _by_planes(region: Any) -> dict[str, Any]:
    """Return the fields of a view that is cut as an actor is: by planes, as far as the region is made of them."""
    from pvfiblets.engine.regions.clip_planes import planes_of

    planes, rest = planes_of(region, MAX_CLIP_PLANES)
    return {"clip_planes": planes, "region": rest}


def torus(centre: Any, radius: float, around: int = 48, across: int = 24) -> Surface:
    """Return a closed surface with a hole, of ``2 * around * across`` triangles."""
    from pvfiblets import regions

    u, v = np.meshgrid(2 * np.pi * np.arange(around) / around, 2 * np.pi * np.arange(across) / across, indexing="ij")
    ring = radius * (1.0 + 0.4 * np.cos(v))
    points = np.stack([ring * np.cos(u), ring * np.sin(u), 0.4 * radius * np.sin(v)], axis=-1).reshape(-1, 3) + centre
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    corners = [((i + a) % around * across + (j + b) % across).ravel() for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    first, second = np.stack([corners[0], corners[1], corners[2]], 1), np.stack([corners[0], corners[2], corners[3]], 1)
    return regions.Surface(points, np.concatenate([first, second]))


def tube_subject(tubes: Any) -> Subject:
    """Return spline tubes with what can be done to them; ``tubes`` hold values ``'scalars'``."""
    from pvfiblets.engine.tubes import TubeRenderer, TubeStyle

    box = np.array(tubes.bounds, np.float64).reshape(3, 2)
    diagonal, middle = float(np.linalg.norm(box[:, 1] - box[:, 0])), box.mean(axis=1)
    features = [
        Feature(PLAIN, ""),
        Feature("values", "numbers", style={"values": "scalars"}),
        Feature("cut", "plane", view={"clip_planes": np.array([[1.0, 0.0, 0.0, -middle[0]]])}),
        Feature("effects", "ambient occlusion", **_ambient_occlusion(diagonal / 20.0, surface=True)),
        Feature("culling", "none", options={"culling": None}),
        Feature("silhouettes", "boxes", options={"silhouettes": "boxes"}),
        Feature("solver", "newton", options={"solver": "newton"}),
    ]

    def make(ctx: moderngl.Context, **options: Any) -> TubeRenderer:
        return TubeRenderer(ctx, tubes, **options)

    return Subject("spline tubes", make, TubeStyle(), tubes.bounds, features)


def halo_subject(lines: Any) -> Subject:
    """Return lines with halos, and what can be done to them; ``lines`` hold values ``'filter'``."""
    from pvfiblets.engine.halos import HaloDrawStyle, HaloRenderer
    from pvfiblets.halos import HaloStyle

    box = np.array(lines.bounds, np.float64).reshape(3, 2)
    diagonal, middle = float(np.linalg.norm(box[:, 1] - box[:, 0])), box.mean(axis=1)
    look = HaloStyle(diagonal / 500.0, diagonal / 100.0, diagonal / 40.0, n_tapered=0)
    low, high = np.quantile(lines.values["filter"], (0.25, 0.75)).tolist()

    def looking(**changes: Any) -> dict[str, Any]:
        return {"look": replace(look, **changes)}

    features = [
        Feature(PLAIN, ""),
        Feature("look", "tapered ends", style=looking(n_tapered=2)),
        Feature("look", "thinner far away", style=looking(width_cue=0.5)),
        Feature("look", "bent halos", style=looking(displacement="square")),
        Feature("values", "numbers", style={"values": "filter"}),
        Feature("filter", "half of the points", style=looking(filter_by="filter", low=low, high=high)),
        Feature("cut", "plane", view={"clip_planes": np.array([[1.0, 0.0, 0.0, -middle[0]]])}),
        Feature("culling", "none", options={"culling": None}),
    ]

    def make(ctx: moderngl.Context, **options: Any) -> HaloRenderer:
        return HaloRenderer(ctx, lines, **options)

    return Subject("lines with halos", make, HaloDrawStyle(look=look), lines.bounds, features)


def volume_subject(volume: Any) -> Subject:
    """Return a volume that rays are cast through, and what can be done to it."""
    from pvfiblets import regions
    from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
    from pvfiblets.volumes import Transfer
    from pvfiblets.volumes.raycast_options import RaycastOptions

    box = np.array(volume.bounds, np.float64).reshape(3, 2)
    middle, sides = box.mean(axis=1), box[:, 1] - box[:, 0]
    low, high = float(volume.values.min()), float(volume.values.max())
    table = np.array([[0.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 0.1]], np.float32)
    light = {"mode": "composite", "transfer": Transfer(table, (low, high))}
    mip = RaycastOptions(mode="mip")

    def casting(**changes: Any) -> dict[str, Any]:
        return {"casting": replace(mip, **changes)}

    inner = np.stack([middle - 0.3 * sides, middle + 0.3 * sides], axis=1).ravel()
    features = [
        Feature(PLAIN, "greatest values"),
        Feature("mode", "surface", style=casting(mode="isosurface", values=(0.5 * (low + high),))),
        Feature("mode", "light", style=casting(**light)),
        Feature("mode", "first peak", style=casting(mode="local-mip", threshold=0.5 * (low + high))),
        Feature("rays", "nearest voxel", style=casting(filter="nearest")),
        Feature("rays", "tricubic", style=casting(filter="tricubic")),
        Feature("rays", "jitter", style=casting(jitter=True)),
        Feature("rays", "every fourth first", style=casting(sparse=4)),
        Feature("rays", "no octree", style=casting(octree=False)),
        Feature("cut", "box", view=_by_planes(regions.Box(inner))),
        Feature("cut", "outside a box", view={"region": ~regions.Box(inner)}),
    ]

    def make(ctx: moderngl.Context, **options: Any) -> VolumeRenderer:
        return VolumeRenderer(ctx, volume, **options)

    return Subject("volume", make, VolumeStyle(casting=mip), volume.bounds, features)
