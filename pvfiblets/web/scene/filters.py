"""Filters of a scene's layers: cuts, criteria, groups, subsets and regions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pvfiblets.plotting.viewpoints import visible_bounds
from pvfiblets.web.scene.matrix import check_connection
from pvfiblets.web.session.document import Clip, Filters, Layer, Source
from pvfiblets.web.session.shapes import CUTTING, check_condition, check_shape, make_region
from pvfiblets.web.values import mapping, number, shown, text, truth, whole

if TYPE_CHECKING:
    from pvfiblets.web.scene.scene import Scene

__all__ = ["SceneFilters", "check_filters"]

MOST_CLIPS = 16
LONGEST_CRITERION = 1100  # characters of the name of an image's values: its layer's, and a word


class SceneFilters:
    """Filters of a scene's layers: cuts, criteria, groups, subsets and regions."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    # Cuts ---------------------------------------------------------------------------------------

    def add_clip(
        self,
        kind: str,
        inside: bool = True,
        *,
        name: str | None = None,
        layers: Sequence[str] | None = None,
        **shape: Any,
    ) -> Clip:
        """Cut layers."""
        if len(self.scene.state.clips) >= MOST_CLIPS:
            raise ValueError(f"there are {MOST_CLIPS} cuts, which is the most; remove one first")
        if kind not in CUTTING:
            raise ValueError(f"the kind of a cut is {shown(kind)}; choose one of {', '.join(CUTTING)}")
        checked = self._checked_shape({**self.usual_shape(kind), **shape})
        label = f"{kind} {1 + sum(clip.shape['kind'] == kind for clip in self.scene.state.clips)}"
        name = label if name is None else text(name, "name")
        clip = Clip(self.scene.fresh_id().replace("layer", "clip"), name, checked, truth(inside, "inside"), True,
                    self._checked_layers(layers))  # fmt: skip
        self.scene.become(replace(self.scene.state, clips=(*self.scene.state.clips, clip)), f"cut by {name}")
        return clip

    def set_clip(self, clip_id: str, **changes: Any) -> Clip:
        """Change a cut."""
        clip = self.scene.state.clip(clip_id)
        wanted: dict[str, Any] = {}
        for key in ("inside", "enabled"):
            if key in changes:
                wanted[key] = truth(changes.pop(key), key)
        if "name" in changes:
            wanted["name"] = text(changes.pop("name"), "name")
        if "layers" in changes:
            wanted["layers"] = self._checked_layers(changes.pop("layers"))
        if changes:
            kind = changes.get("kind", clip.shape["kind"])
            same = kind == clip.shape["kind"]
            wanted["shape"] = self._checked_shape({**(clip.shape if same else self.usual_shape(kind)), **changes})
        new = replace(clip, **wanted)
        clips = tuple(new if other is clip else other for other in self.scene.state.clips)
        self.scene.become(replace(self.scene.state, clips=clips), f"cut {new.name}", ("clip", clip_id, *sorted(wanted)))
        return new

    def remove_clip(self, clip_id: str) -> None:
        """Take a cut back; KeyError if there is none of that id."""
        clip = self.scene.state.clip(clip_id)
        clips = tuple(other for other in self.scene.state.clips if other is not clip)
        self.scene.become(replace(self.scene.state, clips=clips), f"no cut by {clip.name}")

    def usual_shape(self, kind: str) -> dict[str, Any]:
        """Return a shape in the middle of the scene, the panel's default."""
        b = list(visible_bounds(self.scene.plotter))
        for k in (0, 2, 4):
            if b[k] == b[k + 1]:  # flat
                b[k], b[k + 1] = b[k] - 1.0, b[k] + 1.0
        middle = [0.5 * (b[k] + b[k + 1]) for k in (0, 2, 4)]
        sides = [b[k + 1] - b[k] for k in (0, 2, 4)]
        if kind == "plane":
            return {"kind": kind, "normal": [-1.0, 0.0, 0.0], "origin": middle}
        if kind == "slab":
            return {"kind": kind, "normal": [0.0, 0.0, 1.0], "origin": middle, "thickness": 0.05 * max(sides)}
        if kind == "box":
            low = [m - 0.25 * s for m, s in zip(middle, sides, strict=True)]
            high = [m + 0.25 * s for m, s in zip(middle, sides, strict=True)]
            return {"kind": kind, "bounds": [end for pair in zip(low, high, strict=True) for end in pair]}
        if kind == "sphere":
            return {"kind": kind, "center": middle, "radius": 0.25 * max(sides)}
        return {"kind": kind}

    def _checked_shape(self, shape: Mapping[str, Any]) -> dict[str, Any]:
        """Return the shape of a cut, checked by making a region of it, even before there is anything to cut."""
        found = check_shape(shape, "cut", CUTTING)
        make_region(found, self.scene.store.shape)
        return found

    def _checked_layers(self, ids: Any) -> tuple[str, ...] | None:
        if ids is None:
            return None
        if not isinstance(ids, (list, tuple)):
            raise ValueError(f"layers is {shown(ids)}; give a list of ids, or none for all that are lines")
        for layer_id in ids:
            layer = self.scene.layer(text(layer_id, "layer"))
            if layer.kind == "image":
                raise ValueError(f"{layer.name!r} is an image of slices, which are not cut; choose other layers")
        return tuple(ids)

    # Filters ------------------------------------------------------------------------------------

    def set_filter(
        self,
        layer_id: str,
        criterion: str,
        low: float | None = None,
        high: float | None = None,
        *,
        image: Source | None = None,
    ) -> None:
        """Filter by a range of values; values of an `image` at the points get the criterion's name."""
        layer = self.scene.lines_layer(layer_id)
        limits = check_range(low, high, criterion)
        images = layer.filters.images
        if image is not None:
            self._check_image(layer, criterion, image)
            images = {**images, criterion: image}
        elif criterion not in images:
            self._check_values(layer, criterion)
        criteria = {**layer.filters.criteria, criterion: limits}
        key = ("filter", layer_id, criterion)
        self.filter_by(layer, f"range of {criterion}", key, criteria=criteria, images=images)

    def remove_filter(self, layer_id: str, criterion: str | None = None) -> None:
        """Take a criterion back, or with no name all filters."""
        layer = self.scene.lines_layer(layer_id)
        if criterion is None:
            self.scene.change(replace(layer, filters=Filters()), f"show all of {layer.name}")
            return
        if criterion not in layer.filters.criteria:
            there = ", ".join(layer.filters.criteria) or "none"
            raise KeyError(f"there is no criterion {shown(criterion)}; there are: {there}")
        criteria, images = (
            {name: one for name, one in part.items() if name != criterion}
            for part in (layer.filters.criteria, layer.filters.images)
        )
        self.filter_by(layer, f"no range of {criterion}", criteria=criteria, images=images)

    def set_groups(self, layer_id: str, names: Sequence[str] | None) -> None:
        """Show some groups only; ``None`` for all streamlines, in a group or not."""
        layer = self.scene.lines_layer(layer_id)
        self.filter_by(layer, "groups", groups=check_groups(names, self.scene.data(layer).data.groups))

    def set_subset(
        self, layer_id: str, amount: float | None = None, *, every: int | None = None, seed: int = 0
    ) -> None:
        """Show some streamlines only: a share below 1 or a number of them, or every n-th; neither shows all."""
        layer = self.scene.lines_layer(layer_id)
        value = {"every": every} if every is not None else {"amount": amount, "seed": seed}
        subset = None if amount is None and every is None else check_subset(value)
        self.filter_by(layer, "subset", ("subset", layer_id), subset=subset)

    def set_regions(self, layer_id: str, condition: Mapping[str, Any] | None) -> None:
        """Show only streamlines that satisfy a condition of `pvfiblets.web.session.shapes`; ``None`` for all."""
        layer = self.scene.lines_layer(layer_id)
        regions = None if condition is None else check_condition(condition)
        # Only what a slider does many times over is one step: other numbers of the same shapes.
        moved = _outline(regions) == _outline(layer.filters.regions)
        self.filter_by(layer, "regions", ("regions", layer_id) if moved else None, regions=regions)

    def filter_by(self, layer: Layer, what: str, key: tuple[str, ...] | None = None, **changes: Any) -> None:
        """Change some of a layer's filters."""
        filters = replace(layer.filters, **changes)
        self.scene.change(replace(layer, filters=filters), f"{what} of {layer.name}", key)

    def _check_image(self, layer: Layer, criterion: str, image: Source) -> None:
        text(criterion, "name", LONGEST_CRITERION)
        if not sum(self.scene.queries.histogram(layer.id, image)["counts"]):
            raise ValueError(f"no streamline of {layer.name!r} has a value of {criterion}; choose another image")

    def _check_values(self, layer: Layer, criterion: Any) -> None:
        from pvfiblets.web.scene.layer_properties import value_names

        known = value_names(self.scene.data(layer).data)
        if criterion not in known:
            raise ValueError(f"there are no values {shown(criterion)} in {layer.name!r}; there are {', '.join(known)}")


# Checks, of sessions too --------------------------------------------------------------------------


def check_range(low: Any, high: Any, name: str) -> tuple[float, float]:
    """Return both ends of a range; ``None`` is an open one."""
    first = float("-inf") if low is None else number(low, f"low end of {name}")
    last = float("inf") if high is None else number(high, f"high end of {name}")
    if first > last:
        raise ValueError(f"the range of {name} is [{first:g}, {last:g}]; give the low end first")
    return first, last


def check_groups(names: Any, known: Any) -> tuple[str, ...] | None:
    """Return names of groups that are there."""
    if names is None:
        return None
    if not isinstance(names, (list, tuple)):
        raise ValueError(f"groups is {shown(names)}; give a list of names, or none for all")
    for name in names:
        if not isinstance(name, str) or name not in known:
            there = ", ".join(list(known)[:40]) or "none"
            raise ValueError(f"there is no group {shown(name)}; there are: {there}")
    return tuple(dict.fromkeys(names))


def check_subset(value: Any) -> dict[str, Any]:
    """Return which streamlines are shown, whatever they are."""
    if isinstance(value, Mapping) and "every" in value:
        mapping(value, "subset", ("every",))
        return {"every": whole(value["every"], "every", 1)}
    mapping(value, "subset", ("amount",), ("seed",))
    amount = number(value["amount"], "amount", 0.0)
    if amount >= 1.0:
        amount = whole(value["amount"], "amount")
    return {"amount": amount, "seed": whole(value.get("seed", 0), "seed", 0, 2**31)}


def check_filters(
    value: Any, data: Any, groups: Any, place: Callable[[str], str], volume: Callable[[Any], Source]
) -> Filters:
    """Return filters of a session file that fit some fiblets; ``groups`` are names of these by another list."""
    # `place` gives a path as documents hold it, of a file that is there; `volume` the source of one that is read.
    from pvfiblets.web.scene.layer_properties import value_names

    mapping(value, "filters", (), ("criteria", "images", "groups", "subset", "regions", "connection"))
    criteria = {}
    ranges = mapping(value.get("criteria") or {}, "criteria", (), tuple(value.get("criteria") or ()))
    images = {
        text(name, "name", LONGEST_CRITERION): volume(one)
        for name, one in mapping(value.get("images") or {}, "images", (), tuple(ranges)).items()
    }
    known = [*value_names(data), *images]
    for name, limits in mapping(value.get("criteria") or {}, "criteria", (), known).items():
        if not isinstance(limits, (list, tuple)) or len(limits) != 2:
            raise ValueError(f"the range of {name} is {shown(limits)}; give two numbers; one may be null")
        criteria[name] = check_range(limits[0], limits[1], name)
    subset, regions = value.get("subset"), value.get("regions")
    return Filters(
        criteria,
        images,
        check_groups(value.get("groups"), groups),
        None if subset is None else check_subset(subset),
        None if regions is None else check_condition(regions),
        None if value.get("connection") is None else check_connection(value["connection"], place),
    )


def _outline(value: Any) -> Any:
    """Return a condition without its numbers."""
    if isinstance(value, Mapping):
        return {name: _outline(part) for name, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_outline(part) for part in value]
    return None if isinstance(value, (int, float)) and not isinstance(value, bool) else value
