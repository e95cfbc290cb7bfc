"""What can be set of each kind of layer, and what an actor is told for it.

`TABLES` has the properties of each kind. Panels are drawn from them (:func:`describe`), what browsers send is checked
by them (:func:`check`), and `looks` says what the settings mean for an actor, live and in scripts alike, so that both
give the same picture.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pvfiblets.plotting.fiblets.scalars import ORIENTATION
from pvfiblets.web.document import KINDS, LINES, Layer, volume_in
from pvfiblets.web.properties import TYPES, Choices, Property
from pvfiblets.web.tables import MESH, TRACTOGRAM, TUBES, VOLUME
from pvfiblets.web.values import shown

__all__ = [
    "ARGUMENTS",
    "KINDS",
    "LINES",
    "RADIUS_SCALE",
    "TABLES",
    "TYPES",
    "Layer",
    "Property",
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
}
"""Properties of each kind, in the order of a panel."""

ARGUMENTS: dict[str, frozenset[str]] = {
    "tractogram": frozenset(
        {"scalars", "color", "cmap", "clim", "log_scale", "nan_color", "opacity", "transparency", "line_width",
         "lighting", "culling", "fit"}
    ),
    "tubes": frozenset({"scalars", "color", "cmap", "clim", "log_scale", "opacity", "lighting", "min_width",
                        "culling", "solver"}),
    "volume": frozenset({"mode", "values", "cmap", "clim", "color", "opacity", "opacity_unit_distance", "thresholds",
                         "peak", "smooth", "step", "filter", "refine", "integrator", "jitter", "lighting"}),
}  # fmt: skip
"""Looks that are arguments of ``plotter.add_...``, too; all others are attributes only. All those of meshes are."""
ARGUMENTS["selection"] = ARGUMENTS["tractogram"]

RADIUS_SCALE = "radius_scale"
"""A look of tubes that is no attribute of their actor: its tubes are others."""

_BY_NAME = {kind: {prop.name: prop for prop in table} for kind, table in TABLES.items()}


def defaults(kind: str) -> dict[str, Any]:
    """Return all settings of a kind of layer at their defaults."""
    return {prop.name: prop.default for prop in TABLES[kind] if not prop.read_only}


def check(kind: str, name: Any, value: Any, data: Any, volumes: Choices = ()) -> Any:
    """Return a value for a setting in its plain form.

    Parameters
    ----------
    kind : str
        Of the layer.
    name : str
        Of the setting.
    value : object
        What somebody sent.
    data : object
        What the layer draws: choices and limits may depend on it.
    volumes : sequence of (value, label)
        Volumes that lines may be coloured by.

    Raises
    ------
    ValueError
        If there is no such setting or it cannot be that.
    """
    prop = _BY_NAME[kind].get(name) if isinstance(name, str) else None
    if prop is None:
        known = ", ".join(prop.name for prop in TABLES[kind] if not prop.read_only)
        raise ValueError(f"a layer of kind {kind!r} has no property {shown(name)}; it has {known}")
    return prop.check(value, data, volumes)


def changed(kind: str, settings: Mapping[str, Any], name: str, value: Any) -> dict[str, Any]:
    """Return settings with one changed that was checked, and with those at their defaults that it resets."""
    found = {**settings, name: value}
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
    """Return what the settings mean for an actor: its attributes, in the order in which they are to be set.

    Of a mesh, these are arguments of ``plotter.add_mesh``. Scalars that are a :class:`.Source` stand for that volume.
    """
    return {"tractogram": _lines, "selection": _lines, "tubes": _tubes, "volume": _volume, "mesh": _mesh}[kind](
        settings
    )


def _coloured(s: Mapping[str, Any]) -> dict[str, Any]:
    """One colour, or numbers and their colours."""
    if s["scalars"] is None:
        return {"color": s["color"]}
    if s["scalars"] == ORIENTATION:
        return {"scalars": ORIENTATION}
    clim = None if s["clim"] is None else tuple(s["clim"])
    scalars = volume_in(s["scalars"]) or s["scalars"]
    return {"scalars": scalars, "cmap": s["cmap"], "clim": clim, "log_scale": s["log_scale"]}


def _lines(s: Mapping[str, Any]) -> dict[str, Any]:
    found = _coloured(s)
    if "cmap" in found:
        found["nan_color"] = s["nan_color"]
    same = ("opacity", "transparency", "line_width", "lighting", "culling", "fit", "style")
    found |= {name: s[name] for name in same}
    if s["style"] == "surface":  # the other one sets halos of its own
        found["halos"] = s["halos"]
    more = ("illuminated", "tube_shading", "tube_radius", "ambient_occlusion", "depth_cue")
    return found | {name: s[name] for name in more}


def _tubes(s: Mapping[str, Any]) -> dict[str, Any]:
    same = ("opacity", "lighting", "min_width", "culling", "solver", "silhouette", "ambient_occlusion", "depth_cue")
    return {RADIUS_SCALE: s[RADIUS_SCALE]} | _coloured(s) | {name: s[name] for name in same}


def _volume(s: Mapping[str, Any]) -> dict[str, Any]:
    surface = s["mode"] == "isosurface"
    found = {"mode": s["mode"], "values": s["values"]}
    found |= {"color": s["color"], "cmap": s["cmap"], "clim": None if s["clim"] is None else tuple(s["clim"])}
    found["opacity"] = s["surface_opacity"] if surface else s["opacity"]
    found["thresholds"] = None if s["thresholds"] is None else tuple(s["thresholds"])
    same = ("opacity_unit_distance", "peak", "smooth", "step", "filter", "refine", "integrator", "jitter", "lighting",
            "ambient_occlusion", "depth_cue")  # fmt: skip
    return found | {name: s[name] for name in same}


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
