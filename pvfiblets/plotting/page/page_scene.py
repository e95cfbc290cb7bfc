"""A plotter's scene as a page (`pvfiblets.page`): fiblets, surfaces, slices of images, lights, camera, colour bars.

What a page cannot show is named in one warning, and left out.
"""

from __future__ import annotations

import warnings
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pyvista as pv

from pvfiblets.mappers.effects.depth_peeling import Layers
from pvfiblets.mappers.effects.highlight import Highlight
from pvfiblets.mappers.effects.line_light import LineLight
from pvfiblets.mappers.engine_mapper import EngineMapper
from pvfiblets.mappers.fiblets import FibletMapper
from pvfiblets.mappers.frames.scene import items_of, to_array, world_planes
from pvfiblets.mappers.tubes import TubeMapper
from pvfiblets.page.scene import CameraPlace, Light, PageScene, encoded, fiblet_layer
from pvfiblets.plotting.page.cuts import cuts_of
from pvfiblets.plotting.page.surfaces import add_image, add_surface, add_tubes, reflects_of
from pvfiblets.plotting.slices.following import prepare

if TYPE_CHECKING:
    from os import PathLike

    from vtkmodules.vtkRenderingCore import vtkCamera, vtkRenderer

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.mappers.colouring import Colouring

_SHOWN_EFFECTS = {"light", "illuminated", "selection"}
_OPACITY = "layers"
_SOON = 5_000_000  # points
MOST_FIBLET_LAYERS = 15
MOST_TUBE_POINTS = 1_000_000  # of surfaces around spline tubes: some 50 MB


def export_page(
    plotter: pv.BasePlotter, path: str | PathLike[str], *, title: str | None = None, largest_file: int | None = None
) -> list[Path]:
    """Write what a plotter's active renderer shows as a page; see `FibletsComponent.export_page`."""
    from pvfiblets.page.writing import LARGEST_FILE, write_page

    scene = page_of(plotter, title=title)
    return write_page(scene, path, largest_file=LARGEST_FILE if largest_file is None else largest_file)


def page_of(plotter: pv.BasePlotter, *, title: str | None = None) -> PageScene:
    """Return what a plotter's active renderer shows."""
    return page_and_actors(plotter, title=title)[0]


def page_and_actors(plotter: pv.BasePlotter, *, title: str | None = None) -> tuple[PageScene, list[str]]:
    """Return what `page_of` does, and the names of the actors that the layers are."""
    renderer = plotter.renderer
    said = title or getattr(plotter, "title", None) or "Streamlines"
    scene = PageScene(str(said))
    unable, names = add_all(scene, plotter)
    if unable and not scene.layers:
        raise ValueError(f"a page cannot draw {', '.join(unable)}; add streamlines or surfaces, or export an image")
    if unable:
        warnings.warn(f"the page leaves out {', '.join(unable)}: it cannot draw them", stacklevel=3)
    if renderer.camera_set:
        scene.camera = camera_place(renderer.GetActiveCamera())
    scene.plain()
    return scene, names


def add_all(
    scene: PageScene, plotter: pv.BasePlotter, *, controls: bool = True, besides: Collection[str] = ()
) -> tuple[list[str], list[str]]:
    """Fill a page from a plotter's active renderer, without its camera."""
    renderer = plotter.renderer
    prepare(renderer)  # slices have their colours from then on
    scene.background = _background(renderer)
    unable: list[str] = []
    names: list[str] = []
    for name, actor in _actors(renderer):
        if name in besides:
            continue
        bars = len(scene.bars)
        _add_actor(scene, name, actor, unable, controls=controls)
        scene.bars[bars:] = _as_shown(plotter, actor, scene.bars[bars:])
        names += [name] * (len(scene.layers) - len(names))
    scene.lights = list(_lights(renderer))
    scene.letters = any(layer["kind"] == "fiblets" for layer in scene.layers)
    picture = getattr(plotter, "picture", None)
    scene.antialias = picture is None or picture.antialias != "off"
    return list(dict.fromkeys(unable)), names


def _actors(renderer: vtkRenderer) -> Iterator[tuple[str, Any]]:
    for name, actor in renderer.actors.items():
        if actor.GetVisibility():
            yield name, actor


def _as_shown(plotter: pv.BasePlotter, actor: Any, bars: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return an actor's colour bars with the title that the plotter's has, and none if that shows none."""
    shown = plotter.scalar_bars
    titles = [title for title, mappers in shown._scalar_bar_mappers.items()  # noqa: SLF001 - it has no other list
              if actor.GetMapper() in mappers and shown[title].GetVisibility()]  # fmt: skip
    return [{**bar, "title": titles[0]} for bar in bars if titles]


def _add_actor(scene: PageScene, name: str, actor: Any, unable: list[str], *, controls: bool) -> None:
    mapper = actor.GetMapper() if hasattr(actor, "GetMapper") else None
    if isinstance(mapper, FibletMapper):
        _add_fiblets(scene, name, actor, mapper, unable, controls=controls)
    elif isinstance(mapper, TubeMapper) and (mapper.reading.points or 0) <= MOST_TUBE_POINTS:
        unable += [f"{effect} of {name!r}" for effect in mapper.effects if effect != "normals"]
        if not controls and actor.GetProperty().GetOpacity() < 1.0:  # the server shows their nearest surface alone
            unable.append(f"the opacity of {name!r}")
        add_tubes(scene, name, actor, mapper)
        _add_bar(scene, actor, mapper)
    elif isinstance(mapper, EngineMapper):  # its data are no triangles
        unable.append(repr(_label(name, type(actor).__name__)))
    elif getattr(actor, "pixels", None) is not None and hasattr(actor, "place"):
        add_image(scene, name, actor)
    elif isinstance(mapper, pv.mapper.DataSetMapper) or (mapper is not None and mapper.IsA("vtkPolyDataMapper")):
        if not mapper.GetNumberOfInputConnections(0):
            return
        if not add_surface(scene, name, actor, mapper):
            unable.append(f"{name!r}")
    elif mapper is not None and hasattr(mapper, "GetInput"):
        unable.append(f"{name!r}")


def _add_fiblets(
    scene: PageScene, name: str, actor: Any, mapper: FibletMapper, unable: list[str], *, controls: bool
) -> None:
    fiblets = mapper.fiblets
    if fiblets is None or not fiblets.n_points:
        return
    if sum(layer["kind"] == "fiblets" for layer in scene.layers) >= MOST_FIBLET_LAYERS:
        unable.append(f"{name!r}, one more than {MOST_FIBLET_LAYERS} sets of streamlines")
        return
    effects = mapper.effects
    unable += [f"{effect} of {name!r}" for effect in effects if effect not in (*_SHOWN_EFFECTS, _OPACITY)]
    if len(getattr(actor, "picking_layers", ())) > 1:
        unable.append(f"the width or the tubes of the selection of {name!r}")
    filtering = mapper.filtering
    fiblets, colours, keep = _colours(scene, fiblets, mapper.colouring)
    through = _through(scene, actor, mapper)
    if through is not None and isinstance(effects.get(_OPACITY), Layers):
        unable.append(f"the layers of {name!r}")
    light = "none"
    if actor.GetProperty().GetLighting():
        light = "illuminated" if "illuminated" in effects else "line" if _is_lit(effects) else "none"
    more: dict[str, Any] = {} if through is None else {"through": through}
    if filtering is not None and filtering.streamlines is not None:
        more["kept"] = scene.add_blob(np.asarray(filtering.streamlines, np.uint8))
    highlight = effects.get("selection")
    if isinstance(highlight, Highlight):
        more["chosen"] = {
            "data": scene.add_blob(highlight.selected.astype(np.uint8)),
            "colour": (0.0, 0.0, 0.0, 0.0) if highlight.color is None else (*highlight.color[:3], 1.0),
            "faded": (*(highlight.faded or scene.background[0])[:3], highlight.dim),
        }
    if filtering is not None and filtering.points is not None:
        more["kept_points"] = scene.add_blob(np.asarray(filtering.points, "<u4"))
    if controls and fiblets.groups:
        more["groups"] = _groups(scene, fiblets, None if filtering is None else filtering.streamlines)
    cuts, whole = cuts_of(world_planes(mapper), mapper.region)
    more |= cuts
    if not whole:
        unable.append(f"the cut of {name!r} by a closed surface")
    if controls:
        more["controls"] = _controls(scene, fiblets, actor, mapper.colouring)
    reflects, sheen = reflects_of(actor.GetProperty())
    place = to_array(actor.GetMatrix())
    matrix = None if np.array_equal(place, np.eye(4)) else place
    fiblet_layer(
        scene, fiblets, name=_label(name, "streamlines"), colours=colours, keep=keep, line_width=mapper.drawn_width,
        ends=mapper.ends, light=light, reflects=reflects, sheen=sheen, matrix=matrix, **more,
    )  # fmt: skip
    _add_bar(scene, actor, mapper)


def _add_bar(scene: PageScene, actor: Any, mapper: EngineMapper[Any]) -> None:
    scalars = getattr(actor, "active_scalars", None)
    if scalars is not None and scalars.mapped and getattr(mapper.colouring, "lut", None) is not None:
        lut, clim = mapper.colouring.lut, mapper.colouring.clim
        assert lut is not None
        bar = {"title": scalars.title, "table": encoded(lut), "clim": clim, "log": mapper.colouring.log_scale}
        if scalars.categories:
            bar["labels"] = _names(scalars.categories, mapper.colouring)
        scene.bars.append(bar)


def _through(scene: PageScene, actor: Any, mapper: FibletMapper) -> dict[str, Any] | None:
    """Return ``Through`` of the page; None where lines are opaque."""
    colouring, opacity = mapper.colouring, float(actor.GetProperty().GetOpacity())
    varied = colouring.translucent()
    if opacity >= 1.0 and not varied:
        return None
    found: dict[str, Any] = {"opacity": opacity, "varied": varied, "all": _OPACITY in mapper.effects}
    if colouring.opacities is not None:
        found["opacities"] = scene.add_blob(colouring.streamline_opacities()[:, 3])
    if colouring.opacity_source is not None:
        found["by_point"] = True
    return found


def _groups(scene: PageScene, fiblets: FibletSet, shown: npt.NDArray[np.bool_] | None) -> list[dict[str, Any]]:
    """Return the groups that have streamlines which are shown."""
    groups = []
    for name, ids in fiblets.groups.items():
        members = np.unique(np.asarray(ids)).astype("<u4")
        if len(members) and (shown is None or shown[members].any()):
            groups.append({"name": str(name), "data": scene.add_blob(members)})
    return groups


def _names(categories: Mapping[int, str], colouring: Colouring) -> list[dict[str, Any]]:
    """Return categories with their colours, as they are drawn."""
    colours = colouring.map_values(list(categories))[:, :3]
    return [
        {"name": str(name), "colour": colour}
        for name, colour in zip(categories.values(), colours.tolist(), strict=True)
    ]


def _controls(scene: PageScene, fiblets: FibletSet, actor: Any, colouring: Colouring) -> list[dict[str, Any]]:
    """Return numbers of streamlines that a page can filter by: the colouring ones, and lengths if they are cheap."""
    found: dict[str, Any] = {}
    scalars = getattr(actor, "active_scalars", None)
    if colouring.kind.numbers == "lines" and colouring.kind.table and not (scalars and scalars.categories):
        found[scalars.title if scalars is not None else "value"] = np.asarray(colouring.values, float)
    if fiblets.n_points <= _SOON and "length [mm]" not in found:
        found["length [mm]"] = fiblets.lengths()
    controls = []
    for name, values in found.items():
        finite = values[np.isfinite(values)]
        if finite.size and finite.min() < finite.max() and not np.isin(finite, (0.0, 1.0)).all():  # no flags
            span = float(np.float32(finite.min())), float(np.float32(finite.max()))
            controls.append({"name": name, "data": scene.add_blob(values.astype(np.float32)), "range": span})
    return controls


def _is_lit(effects: Any) -> bool:
    return isinstance(effects.get("light"), LineLight)


def _label(name: str, usual: str) -> str:
    """Return a name that means something to people; PyVista's own names hold addresses."""
    return usual if "Addr=" in name else name


def _colours(scene: PageScene, fiblets: FibletSet, colouring: Colouring) -> tuple[Any, dict[str, Any], tuple[str, ...]]:
    """Return the set with what colours it, ``Colours`` of the page, and the arrays of points that it needs."""
    if not (colouring.kind.table and colouring.kind.numbers == "points") and colouring.opacity_source is not None:
        _, colours, _ = _colours(scene, fiblets, replace(colouring, opacity_source=None))
        fiblets, values, keep = _values(scene, fiblets, colouring.opacity_source, False)
        return fiblets, colours | values, keep
    kind = colouring.kind
    said: dict[str, Any] = {"mode": kind.shader}
    of_lines = colouring.streamline_colours()
    if of_lines is not None:
        return fiblets, {**said, "data": scene.add_blob(of_lines)}, ()
    if kind.numbers == "points" and kind.table:
        fiblets, values, keep = _values(scene, fiblets, colouring.source, colouring.log_scale)
        table = {"table": encoded(colouring.table()), "clim": colouring.clim, "log": colouring.log_scale}
        return fiblets, said | values | table, keep
    if kind.numbers == "points":
        from pvfiblets.plotting.page.values import colours as of_points

        source = str(colouring.source)
        packed = scene.once(("colours", fiblets, source), lambda: of_points(fiblets, source).tobytes())
        return fiblets, {**said, "data": scene.add_blob(packed)}, ()
    if kind.of_directions is not None:
        return fiblets, said, ()
    return fiblets, {"mode": "solid", "colour": colouring.color}, ()


def _values(
    scene: PageScene, bare: Any, source: Any, log_scale: bool
) -> tuple[Any, dict[str, Any], tuple[str, ...]]:
    """Return the set with some values of points, where ``Colours`` of the page find them, and the arrays of it."""
    from pvfiblets.plotting.page.values import with_values

    fiblets, name = scene.once(("values", bare, source, log_scale), lambda: with_values(bare, source, log_scale))
    said: dict[str, Any] = {"values": name}
    if not scene.values_apart:
        return fiblets, said, (name,)
    values = fiblets.per_point[name]
    codes = scene.once(("codes", fiblets, name), lambda: np.asarray(values.codes).tobytes())
    said["codes"] = {
        "data": scene.add_blob(codes),
        "table": scene.add_blob(np.asarray(values.table).tobytes()),
        "bits": 8 * values.codes.dtype.itemsize,
        **{key: getattr(values, key) for key in ("lo", "hi", "reference")},
    }
    return bare, said, ()


def _background(renderer: vtkRenderer) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    bottom = renderer.GetBackground()
    top = renderer.GetBackground2() if renderer.GetGradientBackground() else bottom
    return bottom, top


def camera_place(camera: vtkCamera) -> CameraPlace:
    """Return where a vtkCamera stands."""
    return CameraPlace(
        camera.GetPosition(), camera.GetFocalPoint(), camera.GetViewUp(), camera.GetViewAngle(),
        bool(camera.GetParallelProjection()), camera.GetParallelScale(),
    )  # fmt: skip


def _lights(renderer: vtkRenderer) -> Iterator[Light]:
    """Yield the lights that are on; camera lights in camera coordinates."""
    for light in items_of(renderer.GetLights()):
        intensity = light.GetIntensity()
        if not light.GetSwitch() or intensity <= 0.0:
            continue
        red, green, blue = (intensity * part for part in light.GetDiffuseColor())
        if light.LightTypeIsCameraLight():
            place, aim = np.array(light.GetPosition()), np.array(light.GetFocalPoint())
        else:
            place, aim = np.array(light.GetTransformedPosition()), np.array(light.GetTransformedFocalPoint())
        towards = place - aim
        towards = towards / (np.linalg.norm(towards) or 1.0)
        if light.LightTypeIsHeadlight():
            yield Light((red, green, blue), view=(0.0, 0.0, 1.0))
        elif light.LightTypeIsCameraLight():
            x, y, z = (float(v) for v in towards)
            yield Light((red, green, blue), view=(x, y, z))
        else:
            x, y, z = (float(v) for v in (place if light.GetPositional() else towards))
            yield Light((red, green, blue), world=(x, y, z), positional=bool(light.GetPositional()))
