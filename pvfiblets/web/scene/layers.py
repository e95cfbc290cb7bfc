"""Settings of each kind of layer, and the arguments of actors for them.

`TABLES` has the properties of each kind. Panels are drawn from them (:func:`describe`), what browsers send is checked
by them (:func:`check`), and `looks` says what the settings mean for an actor, live and in scripts alike, so that both
give the same picture.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pvfiblets.plotting.colours.scalars import ORIENTATION
from pvfiblets.plotting.fiblets.looks import LOOKS, PLAIN, look_of, settings_of
from pvfiblets.plotting.fiblets.settings import FibletSettings
from pvfiblets.plotting.settings.settings import Settings, arguments
from pvfiblets.plotting.slices.settings import MEANING, SliceSettings
from pvfiblets.plotting.tubes.settings import TubeSettings
from pvfiblets.plotting.volumes.settings import VolumeSettings
from pvfiblets.web.scene.layer_properties import IMAGE, MESH, TRACTOGRAM, TUBES, VOLUME
from pvfiblets.web.scene.properties import TYPES, Choices, Property
from pvfiblets.web.scene.slices.glyph_layers import GLYPHS
from pvfiblets.web.session.document import KINDS, LINES, Layer, volume_in
from pvfiblets.web.values import shown

__all__ = [
    "ARGUMENTS",
    "KINDS",
    "LINES",
    "LOOK",
    "RADIUS_SCALE",
    "SELECTION",
    "TABLES",
    "TYPES",
    "USUAL",
    "Layer",
    "Property",
    "beginning",
    "changed",
    "check",
    "defaults",
    "describe",
    "looks",
]  # fmt: skip

TABLES: dict[str, tuple[Property, ...]] = {
    "tractogram": TRACTOGRAM,
    "tubes": TUBES,
    "volume": VOLUME,
    "mesh": MESH,
    "selection": TRACTOGRAM,
    "image": IMAGE,
}
"""Properties of each kind, in the order of a panel."""

_SETTINGS: dict[str, type[Settings]] = {
    "tractogram": FibletSettings,
    "tubes": TubeSettings,
    "volume": VolumeSettings,
    "selection": FibletSettings,
    "image": SliceSettings,
}

ARGUMENTS: dict[str, frozenset[str]] = {
    kind: frozenset({"scalars", *arguments(settings)}) for kind, settings in _SETTINGS.items()
}
"""Looks that are arguments of ``plotter.add_...``, too; all others are attributes only. Meshes have only arguments."""

USUAL: dict[str, dict[str, Any]] = {
    kind: {prop.name: prop.usual for prop in TABLES[kind] if prop.live} for kind in _SETTINGS
}
"""Settings of actors without a look."""
for _lines_kind in LINES:
    USUAL[_lines_kind]["scalars"] = ORIENTATION
USUAL["mesh"] = {
    "cmap": None, "clim": None, "log_scale": False, "opacity": 1.0, "style": "surface", "show_edges": False,
    "smooth_shading": False, "specular": 0.0, "lighting": True, "culling": None,
}  # fmt: skip

SELECTION = {
    "selection_color": "color",
    "selection_dim": "dim",
    "selection_as_tubes": "as_tubes",
    "selection_radius": "radius",
}
"""Properties of lines that are arguments of ``actor.selection_style``, by the names that they have there."""

LOOK = "look"  # A property of lines that stands for others: their actor gets these, with the look's values of effects

PERCENTILES = (1.0, 99.0)  # percentiles of non-zero voxels: the default window of volumes, as of slices
FEW = 64  # numbers; a volume of no more is one of labels

RADIUS_SCALE = "radius_scale"  # A look of tubes that is no attribute of their actor: its tubes are others

_BY_NAME = {kind: {prop.name: prop for prop in table} for kind, table in TABLES.items()}


def defaults(kind: str) -> dict[str, Any]:
    """Return all settings of a kind of layer at their defaults."""
    return {prop.name: prop.default for prop in TABLES[kind] if not prop.read_only}


def beginning(kind: str, data: Any) -> dict[str, Any]:
    """Return the settings that a new layer of some data begins with."""
    found = defaults(kind)
    if kind == "image":
        labels = data.is_labels or data.table is not None
        found[GLYPHS] = "fixels" if data.fixels is not None else None
        found[MEANING] = "labels" if labels else "rgb" if data.is_colours else "scalars"
    if kind == "volume" and (window := _window(data)) is not None:
        found["clim"] = check(kind, "clim", list(window), data)
    return found


def _window(volume: Any) -> tuple[float, float] | None:
    """Return between which values a volume's colours begin, a few very bright voxels left out; ``None`` for all."""
    # Volumes of few numbers are labels or masks, with all values visible.
    import numpy as np

    from pvfiblets.slices.image import SAMPLED, window_of

    flat = volume.values.ravel(order="K")
    if len(np.unique(flat[:: max(1, flat.size // SAMPLED)])) <= FEW:
        return None
    low, high = window_of(volume.numbers, *PERCENTILES)
    return (low, high) if volume.value_range[0] < high else None


def check(kind: str, name: Any, value: Any, data: Any, volumes: Choices = ()) -> Any:
    """Return a value for a setting in its plain form."""
    prop = _BY_NAME[kind].get(name) if isinstance(name, str) else None
    if prop is None:
        known = ", ".join(prop.name for prop in TABLES[kind] if not prop.read_only)
        raise ValueError(f"a layer of kind {kind!r} has no property {shown(name)}; it has {known}")
    return prop.check(value, data, volumes)


def changed(kind: str, settings: Mapping[str, Any], name: str, value: Any, data: Any = None) -> dict[str, Any]:
    """Return settings with one checked change, and with the settings that it resets or, for a look, sets."""
    # The line widths of the data are needed for looks.
    found = {**settings, name: value}
    if name == LOOK and value is not None:
        found |= {key: bool(one) if isinstance(one, Mapping) else one for key, one in settings_of(value, data).items()}
    elif kind in LINES and (name == LOOK or name in PLAIN):
        found[LOOK] = look_of(found, data)
    if value != settings[name]:
        table = _BY_NAME[kind]
        found.update({other: table[other].default for other in table[name].resets})
    return found


def describe(
    kind: str, actor: Any, data: Any, settings: Mapping[str, Any], volumes: Choices = ()
) -> list[dict[str, Any]]:
    """Return the properties of a layer with their present values; see :meth:`Property.describe`."""
    return [prop.describe(actor, data, settings, volumes) for prop in TABLES[kind]]


def looks(kind: str, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the settings mean for an actor: its attributes, in the order in which they are to be set."""
    # Of a mesh, these are arguments of `plotter.add_mesh`. Scalars that are a `.Source` stand for that volume.
    if kind == "mesh":
        return _mesh(settings)
    found: dict[str, Any] = {RADIUS_SCALE: settings[RADIUS_SCALE]} if kind == "tubes" else {}
    if "scalars" in settings:
        found |= _coloured(kind, settings)
    look = LOOKS[settings[LOOK]].settings if settings.get(LOOK) is not None else {}
    for prop in TABLES[kind]:
        if prop.live and not ("scalars" in settings and prop.name in _OF_COLOURS):
            exactly = look.get(prop.name) if settings[prop.name] is True else None
            found[prop.name] = dict(exactly) if isinstance(exactly, Mapping) else _plain(prop, settings)
    if kind in LINES and settings["style"] != "surface":  # which sets halos of its own
        del found["halos"]
    if kind == "volume" and settings["mode"] == "isosurface":
        found["opacity"] = settings["surface_opacity"]
    return found


_OF_COLOURS = ("color", "cmap", "clim", "log_scale", "nan_color")


def _plain(prop: Property, s: Mapping[str, Any]) -> Any:
    value = s[prop.name]
    return tuple(value) if prop.type == "range" and value is not None else value


def _coloured(kind: str, s: Mapping[str, Any]) -> dict[str, Any]:
    """One colour, or numbers and their colours."""
    if s["scalars"] is None:
        return {"color": s["color"]}
    if s["scalars"] == ORIENTATION:
        return {"scalars": ORIENTATION}
    found = {"scalars": volume_in(s["scalars"]) or s["scalars"]}
    table = _BY_NAME[kind]
    return found | {name: _plain(table[name], s) for name in _OF_COLOURS[1:] if name in table}


def _mesh(s: Mapping[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {"color": s["color"]}
    if s["scalars"] is not None:
        clim = None if s["clim"] is None else list(s["clim"])
        found = {"scalars": s["scalars"], "cmap": s["cmap"], "clim": clim, "log_scale": s["log_scale"]}
    if s["representation"] == "wireframe" or s["show_edges"]:
        found["line_width"] = s["line_width"]
    if s["representation"] == "points":
        found["point_size"] = s["point_size"]
    return found | {
        "opacity": s["opacity"],
        "style": s["representation"],
        "show_edges": s["show_edges"],
        "smooth_shading": s["smooth_shading"],
        "specular": s["specular"],
        "lighting": s["lighting"],
        "culling": s["culling"],
    }
