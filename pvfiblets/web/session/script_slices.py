"""The part of a script about images that are shown as slices."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.web.scene.slices.glyph_layers import VECTORS
from pvfiblets.web.scene.slices.slicing import normal_of
from pvfiblets.web.session.document import LINES
from pvfiblets.web.session.runs import runs_of
from pvfiblets.web.session.script_code import Python

if TYPE_CHECKING:
    from pvfiblets.web.scene.scene import Scene
    from pvfiblets.web.session.document import Layer


def has_images(scene: Scene) -> bool:
    """Return whether any layer is an image of slices."""
    return any(layer.kind == "image" for layer in scene.layers)


def image_arguments(layer: Layer, meaning: str, file: Callable[[str], str]) -> dict[str, Any]:
    """Return arguments that say what an image's numbers mean; ``file`` gives the Python of a path."""
    found: dict[str, Any] = {"kind": meaning}
    if meaning == "labels" and layer.source.values:
        found["labels"] = Python(file(layer.source.values[-1]))
    if meaning == "direction" and layer.settings[VECTORS] != "scanner":
        found["vectors"] = layer.settings[VECTORS]
    return found


def slicing_lines(scene: Scene) -> list[str]:
    """Return lines that look at slices as the scene does."""
    view = scene.slicing.view
    found = []
    if view.oblique is not None:
        normal = tuple(round(part, 9) for part in normal_of(view.oblique))
        found += [f"workspace.add_oblique({normal}, widget=False)"]
    layout = "beside" if view.layout == "oblique" and view.oblique is None else view.layout
    found += [f"workspace.layout = {layout!r}"]
    found += [f"workspace.{name} = {getattr(view, name)!r}" for name in ("convention", "thickness")]
    found += ["workspace.told = False"]
    found += [] if view.cross_hair else ["workspace.cross_hair = False"]
    if not view.planes:
        found += ["for plane in ('axial', 'coronal', 'sagittal'):", "    workspace.slices[plane].visible = False"]
    return [*found, f"workspace.position = {view.position}", ""]


def painting_lines(scene: Scene, names: Mapping[str, str], ids: Callable[[Any], str]) -> list[str]:
    """Return lines that make the painted regions, show them and choose streamlines by them."""
    painting, painter = scene.state.painting, scene.canvas.painter
    if painting is None or painter is None:
        return []
    matrix = [[float(part) for part in row] for row in painting.matrix]
    found = [f"painter = regions.RegionPainter(({painting.shape}, np.array({matrix})))"]
    flat = painter.labels.reshape(-1)
    for one in painting.regions:
        found += [f"painter.add({one.name!r}, {one.color!r})"]
        runs = runs_of(np.flatnonzero(flat == one.label))
        if len(runs) == 1:
            found += [f"painter.set_voxels({one.name!r}, np.arange({runs[0, 0]}, {runs[0, 1]}))"]
        elif len(runs):
            found += [f"painter.set_voxels({one.name!r}, {ids(runs)})"]
    used = scene.canvas.used(painting)
    for layer in scene.layers if used else ():
        if layer.kind not in LINES:
            continue
        found += [f"live = regions.LiveRegions({names[layer.id]}.fiblets, painter)"]
        for name, use in used:
            if use != "in_order":
                found += [f"{names[layer.id]}.include_painted(live, {_WORDS[use]}={name!r})"]
        if waypoints := [name for name, use in used if use == "in_order"]:
            found += [f"{names[layer.id]}.include_painted(live, in_order={waypoints})"]
    if has_images(scene):
        shown = {k: (one.name, one.color if one.visible else "#00000000") for k, one in enumerate(painting.regions, 1)}
        found += ["workspace.slices.add((painter.labels, painter.grid.affine), name='painted', opacity=0.55,"]
        found += [f"                     labels={shown})"]
    return [*found, ""]


def bundle_lines(scene: Scene, layer: Layer, name: str, ids: Callable[[Any], str]) -> list[str]:
    """Return lines that give an actor the bundles of its layer, if they were edited."""
    bundles = scene.state.bundles_of(layer.source)
    if bundles is None:
        return []
    found = [f"for bundle in {name}.bundles.names:", f"    {name}.bundles.remove(bundle)"]
    for one in bundles:
        which = "np.array([], int)" if not len(one.ids) else ids(one.ids.runs)
        hidden = "" if one.visible else ", visible=False"
        found += [f"{name}.bundles.add({one.name!r}, {which}, color={one.color!r}{hidden})"]
    return found


_WORDS = {"passes": "include", "misses": "exclude", "ends_in": "ends_in", "stays_in": "stays_in"}
