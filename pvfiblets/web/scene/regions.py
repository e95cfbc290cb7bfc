"""Named regions of a scene: what layers share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.viewpoints import visible_bounds
from pvfiblets.web.session.document import LINES, Layer
from pvfiblets.web.session.shapes import check_condition, shapes_in
from pvfiblets.web.values import shown, text

if TYPE_CHECKING:
    from pvfiblets.web.scene.scene import Scene

SHARE = 0.06  # of the scene's longest side: half the width of a new region
APART = 3.0  # half widths between the middles of a region and of the next


class SceneRegions:
    """Named regions of a scene, which change for all layers at once."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    def usual_region(
        self, kind: str, last: Mapping[str, Any] | None = None, beside: Any = (1.0, 0.0, 0.0)
    ) -> dict[str, Any]:
        """Return a sphere or a box of about a centimetre in a brain, for a panel to begin with."""
        bounds = np.array(visible_bounds(self.scene.plotter), np.float64)
        low, high = bounds[::2], bounds[1::2]
        half, middle = _rounded(SHARE * float((high - low).max())), 0.5 * (low + high)
        if last is not None:
            at, half = _middle(last)
            middle = at + APART * half * np.asarray(beside, np.float64)
            if (middle < low).any() or (middle > high).any():  # on the other side, where that is inside
                middle = np.clip(at - APART * half * np.asarray(beside, np.float64), low, high)
        if kind == "sphere":
            return {"kind": kind, "center": [float(part) for part in middle], "radius": half}
        return {"kind": kind, "bounds": [float(part) for m in middle for part in (m - half, m + half)]}

    def region_names(self) -> list[str]:
        """Return the names of all regions, in their order."""
        found = [
            region["name"]
            for layer in self.scene.state.layers
            if layer.filters.regions is not None
            for region in shapes_in(layer.filters.regions)
            if "name" in region
        ]
        return list(dict.fromkeys(found))

    def free_region_name(self) -> str:
        """Return a name that no region has: A to Z, and then numbers."""
        taken = set(self.region_names())
        letters = [chr(65 + k) for k in range(26)]
        return next(name for name in (*letters, *(f"region {k}" for k in range(27, 10_000))) if name not in taken)

    def sharing(self, name: str | None) -> list[str]:
        """Return the ids of the layers that have a region of a name."""
        return [layer.id for layer in self.scene.state.layers if name is not None and _has(layer, name)]

    def change_region(self, name: str, shape: Mapping[str, Any]) -> None:
        """Change a region for all layers that have it."""
        if not self.sharing(name):
            there = ", ".join(self.region_names()) or "none"
            raise ValueError(f"there is no region {shown(name)}; there are: {there}")
        new = check_condition({"how": "passes", "region": shape})["region"]

        def changed(part: Mapping[str, Any]) -> dict[str, Any]:
            if "op" in part:
                return {"op": part["op"], "of": [changed(inner) for inner in part["of"]]}
            return {**part, "region": new if part["region"].get("name") == name else part["region"]}

        layers = tuple(
            replace(layer, filters=replace(layer.filters, regions=changed(layer.filters.regions)))
            if layer.filters.regions is not None and _has(layer, name)
            else layer
            for layer in self.scene.state.layers
        )
        old = next(region for one in self.scene.state.layers for region in _named(one, name))
        parts = sorted(key for key in new if new[key] != old.get(key))
        self.scene.become(replace(self.scene.state, layers=layers), f"region {name}", ("region", name, *parts))

    def share_region(self, shape: Mapping[str, Any], how: str, negated: bool, layer_ids: Sequence[str]) -> None:
        """Filter some layers by a region, and no others."""
        name = text(shape.get("name"), "the name of a region", 40)
        for layer_id in layer_ids:
            self.scene.lines_layer(layer_id)
        part: dict[str, Any] = {"how": how, "region": dict(shape)}
        part = {"op": "not", "of": [part]} if negated else part

        def regions(layer: Layer) -> Any:
            old = layer.filters.regions
            if layer.id in layer_ids:
                if _has(layer, name):
                    return old
                if old is None:
                    return {"op": "and", "of": [part]}
                return {**old, "of": [*old["of"], part]} if old.get("op") == "and" else {"op": "and", "of": [old, part]}
            if not _has(layer, name) or old is None:
                return old
            kept = [one for one in (old["of"] if old.get("op") in ("and", "or") else [old]) if not _is(one, name)]
            if any(region.get("name") == name for one in kept for region in shapes_in(one)):
                raise ValueError(f"the regions of {layer.name!r} are nested; {name!r} stays there")
            return {"op": old.get("op", "and"), "of": kept} if kept else None

        layers = tuple(
            replace(layer, filters=replace(layer.filters, regions=regions(layer))) if layer.kind in LINES else layer
            for layer in self.scene.state.layers
        )
        self.scene.become(replace(self.scene.state, layers=layers), f"layers of region {name}")


def _has(layer: Layer, name: str) -> bool:
    return bool(_named(layer, name))


def _named(layer: Layer, name: str) -> list[Mapping[str, Any]]:
    regions = layer.filters.regions
    return [] if regions is None else [region for region in shapes_in(regions) if region.get("name") == name]


def _is(part: Mapping[str, Any], name: str) -> bool:
    """Return whether a part of a condition is about one region alone, with or without ``not``."""
    inner = part["of"][0] if part.get("op") == "not" else part
    return "region" in inner and inner["region"].get("name") == name


def _middle(shape: Mapping[str, Any]) -> tuple[np.ndarray, float]:
    """Return the middle of a sphere or a box, and half its width."""
    if shape["kind"] == "sphere":
        return np.asarray(shape["center"], np.float64), float(shape["radius"])
    bounds = np.asarray(shape["bounds"], np.float64)
    return 0.5 * (bounds[::2] + bounds[1::2]), 0.5 * float((bounds[1::2] - bounds[::2]).max())


def _rounded(value: float) -> float:
    """Return 1, 2 or 5 times a power of ten, near a value."""
    if not value > 0.0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * min((1.0, 2.0, 5.0, 10.0), key=lambda step: abs(step - value / power)))
