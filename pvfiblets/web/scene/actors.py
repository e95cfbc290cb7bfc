"""Layers as actors of a plotter: made, brought in step with their documents, and taken away.

Only changed settings are passed to an actor; nothing is compressed or copied to the GPU anew.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.web.scene.layers import RADIUS_SCALE, SELECTION, looks
from pvfiblets.web.session.document import LINES, Clip, Filters, Ids, Layer, Source
from pvfiblets.web.session.shapes import make_predicate, make_region, planes_of

if TYPE_CHECKING:
    import pyvista as pv
    from vtkmodules.vtkRenderingCore import vtkRenderer

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.web.scene.files.loading import Loaded
    from pvfiblets.web.session.shapes import Load

    Colours = Callable[[Source], Any]  # from where a volume comes from to the volume that colours or filters lines
    Ends = Callable[[Any, str, float], Any]  # from fiblets, a label volume's path and mm to the parcels of ends

__all__ = [
    "MOST_PLANES",
    "add_actor",
    "connecting",
    "cut",
    "filter_as",
    "look_as",
    "put_in_order",
    "remove_actor",
    "select_as",
    "split_cuts",
]

MOST_PLANES = 6  # most planes that VTK cuts a mesh or tubes by

_CONDITION, _CONNECTION = "regions", "connection"


def add_actor(
    plotter: pv.BasePlotter, layer: Layer, loaded: Loaded, colours: Colours, cluster: str | None = None
) -> Any:
    """Add what a layer draws, with its settings; filters, cuts and selection are not applied yet."""
    common = {"name": layer.id, "show_scalar_bar": False, "reset_camera": False, "render": False}
    wanted = looks(layer.kind, layer.settings)
    if layer.kind == "mesh":
        actor = plotter.add_mesh(loaded.data, **common, **wanted)
    else:
        add = {"tubes": plotter.add_spline_tubes, "volume": plotter.add_raycast_volume}.get(layer.kind)
        drawn_by = {} if add is not None or cluster is None else {"cluster": cluster}
        actor = (add or plotter.add_fiblets)(loaded.data, **common, **drawn_by)
        try:
            _set(actor, wanted, loaded.data, colours)
        except Exception:
            remove_actor(plotter, actor)
            raise
    if layer.kind in LINES:
        actor.selection_style(**_selection_style(layer.settings))
    actor.visibility = layer.visible
    return actor


def remove_actor(plotter: pv.BasePlotter, actor: Any) -> None:
    """Take an actor away; its GPU memory goes with it."""
    plotter.remove_actor(actor, reset_camera=False, render=False)


def put_in_order(renderer: vtkRenderer, actors: Sequence[Any]) -> None:
    """Order the actors of a renderer, whenever each was added: of things in one place the first shows."""
    props = renderer.GetViewProps()
    places = [props.IsItemPresent(actor) for actor in actors]  # from 1 on
    if places != sorted(places):
        # Of the collection alone: an actor that leaves the renderer would give back its GPU memory.
        for actor in actors:
            props.RemoveItem(actor)
            props.AddItem(actor)
        renderer.Modified()


def look_as(plotter: pv.BasePlotter, actor: Any, old: Layer, new: Layer, loaded: Loaded, colours: Colours) -> Any:
    """Bring an actor's looks in step with its layer; return the actor, which of meshes is another one."""
    before, after = looks(old.kind, old.settings), looks(new.kind, new.settings)
    if before != after:
        if new.kind == "mesh":
            actor = add_actor(plotter, new, loaded, colours)  # of the same name: it takes the other's place
        else:
            try:
                differing = {name: value for name, value in after.items() if before.get(name, _set) != value}
                _set(actor, differing, loaded.data, colours)
            except Exception:
                _set(actor, before, loaded.data, colours)
                raise
    style = _selection_style(new.settings)
    if new.kind in LINES and style != _selection_style(old.settings):
        actor.selection_style(**style)
    if new.visible != bool(actor.visibility):
        actor.visibility = new.visible
    return actor


def _set(actor: Any, wanted: Mapping[str, Any], data: Any, colours: Colours) -> None:
    """Set attributes in their order; colours by way of what every scale and range allow."""
    if "scalars" in wanted:
        if getattr(actor, "log_scale", False):
            actor.log_scale = False
        actor.clim = None
    for name, value in wanted.items():
        if name == "color" and value is None and "scalars" in wanted:
            continue
        if name == RADIUS_SCALE:
            slopes = value * data.radius_slopes
            scaled = data if value == 1.0 else replace(data, radius=value * data.radius, radius_slopes=slopes)
            if scaled is not actor.tubes:
                actor.tubes = scaled
            continue
        setattr(actor, name, colours(value) if isinstance(value, Source) else value)


def _selection_style(settings: Mapping[str, Any]) -> dict[str, Any]:
    return {theirs: settings[ours] for ours, theirs in SELECTION.items() if ours in settings}


# What is shown of lines -----------------------------------------------------------------------------


def filter_as(actor: Any, old: Filters, new: Filters, load: Load, ends: Ends, colours: Colours) -> None:
    """Apply checked filters to a tractogram's actor."""
    for name in old.criteria:
        if name not in new.criteria:
            actor.remove_criterion(name)
    for name, limits in new.criteria.items():
        image = new.images.get(name)
        if (old.criteria.get(name), old.images.get(name)) != (limits, image):
            actor.criterion(name if image is None else colours(image), limits, name=name)
    if old.groups != new.groups:
        actor.groups_shown = new.groups
    if old.subset != new.subset:
        actor.subset(**(new.subset or {}))
    if old.regions != new.regions:
        if new.regions is not None:
            actor.include(make_predicate(new.regions, load), name=_CONDITION)
        elif _CONDITION in actor.conditions:
            actor.remove_condition(_CONDITION)
    if old.connection != new.connection:
        if new.connection is not None:
            actor.include(connecting(ends, actor.fiblets, new.connection), name=_CONNECTION)
        elif _CONNECTION in actor.conditions:
            actor.remove_condition(_CONNECTION)


def connecting(ends: Ends, fiblets: FibletSet, connection: Mapping[str, Any]) -> np.ndarray:
    """``(n,)`` bool: streamlines that connect the two parcels of a filter."""
    found = np.sort(ends(fiblets, connection["labels"], connection["radius"]), axis=1)
    return np.asarray((found == np.sort(connection["pair"])).all(axis=1))


def select_as(actor: Any, selected: Ids | None) -> None:
    """Select what a layer says."""
    if selected is None:
        actor.deselect()
    else:
        actor.select(selected.array())


# Cuts -----------------------------------------------------------------------------------------------


Planes = list[tuple[list[float], list[float]]]


def split_cuts(layer: Layer, clips: Sequence[Clip]) -> tuple[Planes, list[Clip]]:
    """Return how tubes or a mesh are cut by clips that are all for it."""
    planes: Planes = []
    others: list[Clip] = []
    for clip in clips:
        found = planes_of(clip.shape, clip.inside)
        if layer.kind == "mesh" and (found is None or len(planes) + len(found) > MOST_PLANES):
            others.append(clip)
        elif found is None:
            raise ValueError(
                f"{clip.name!r} cannot cut {layer.name!r}: {layer.kind} are cut by planes, and by the inside of slabs "
                "and boxes; choose other layers for it"
            )
        else:
            planes += found
    if len(planes) > MOST_PLANES:
        raise ValueError(f"{len(planes)} planes would cut {layer.name!r}; VTK allows {MOST_PLANES}: a box is six")
    return planes, others


def cut(actor: Any, layer: Layer, clips: Sequence[Clip], load: Load, whole: Any = None) -> None:
    """Apply exactly the clips of its layer to an actor."""
    mine = [clip for clip in clips if clip.cuts(layer)]
    if layer.kind not in (*LINES, "volume"):
        from vtkmodules.vtkCommonDataModel import vtkPlane

        planes, others = split_cuts(layer, mine)
        actor.mapper.RemoveAllClippingPlanes()
        for normal, origin in planes:
            plane = vtkPlane()
            plane.SetNormal(normal)
            plane.SetOrigin(origin)
            actor.mapper.AddClippingPlane(plane)
        if others or (whole is not None and actor.mapper.dataset is not whole):
            actor.mapper.dataset = _cut_mesh(whole, others, load)
        return
    regions = {clip.id: make_region(clip.shape, load) for clip in mine}
    for name in list(actor.clips):
        if name not in regions:
            actor.unclip(name)
    for clip in mine:
        region = regions[clip.id] if clip.inside else ~regions[clip.id]
        if clip.id not in actor.clips or actor.clips[clip.id] != region:
            actor.clip(region, name=clip.id)


def _cut_mesh(whole: Any, clips: Sequence[Clip], load: Load) -> Any:
    """Return what clips leave of a mesh: the mesh itself where there are none."""
    from pvfiblets.plotting.cut_surfaces import cut_surface

    for clip in clips:
        region = make_region(clip.shape, load)
        whole = cut_surface(whole, region if clip.inside else ~region)
        if not whole.n_cells:
            break
    return whole


def shown_streamlines(actor: Any) -> np.ndarray:
    """``(n,)`` bool: streamlines that filters leave, as far as they are chosen as a whole."""
    return np.asarray(actor.shown)
