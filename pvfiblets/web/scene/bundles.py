"""Bundles of a scene's tractograms: named sets of streamlines, to be edited, undone and saved.

They belong to the source of data: layers of one source have the same ones. Unedited bundles are the
groups of the file, and are not stored in the document.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.query.bundles.bundle_list import Bundles, group_colours, hidden_groups
from pvfiblets.query.bundles.colours import distinct_colour, distinct_colours, hex_colour
from pvfiblets.web.scene.layers import changed
from pvfiblets.web.session.document import Bundle, Ids, Layer, Source, State, free_name, named
from pvfiblets.web.session.runs import unpack
from pvfiblets.web.values import colour, mapping, shown, text, truth

if TYPE_CHECKING:
    from pvfiblets.web.scene.scene import Scene

CONDITION = "bundles"
MOST = 20_000
LONGEST = 120


class SceneBundles:
    """Bundles of a scene's tractograms, edited as steps that can be undone."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.sync = BundleSync()

    def own_groups(self, source: Source, data: Any) -> list[str]:
        """Return the names of the groups that a set has by its file."""
        return self.sync.own(source, data)

    def of_layer(self, layer_id: str) -> tuple[Bundle, ...]:
        """Return the bundles of a tractogram in their order."""
        layer = self.scene.lines_layer(layer_id)
        found = self.scene.state.bundles_of(layer.source)
        return _own(self.scene.data(layer).data) if found is None else found

    def add_bundle(self, layer_id: str, what: str | Any, name: str | None = None) -> Bundle:
        """Add a bundle."""
        layer = self.scene.lines_layer(layer_id)
        if isinstance(what, str) and what == "selected":
            if layer.selected is None:
                raise ValueError(f"nothing of {layer.name!r} is selected; pick streamlines first")
            ids = layer.selected
        elif isinstance(what, str) and what == "shown":
            ids = Ids.from_numbers(np.flatnonzero(self.scene.actor(layer_id).shown))
        else:
            ids = Ids.from_numbers(what)
        if not len(ids):
            raise ValueError("a bundle of no streamlines; show or select some first")
        total = self.scene.data(layer).data.n_streamlines
        if ids.highest >= total:
            raise ValueError(f"streamline {ids.highest} does not exist; there are {total}")
        there = self.of_layer(layer_id)
        if name is None:
            given = free_name(f"bundle {len(there) + 1}", [one.name for one in there])
        else:
            given = self._new(there, name)
        made = Bundle(given, ids, hex_colour(distinct_colour(len(there))))
        self._put(layer, (*there, made), f"bundle {given}")
        return made

    def add_bundles(self, layer_id: str, groups: Mapping[str, Any], what: str) -> list[Bundle]:
        """Add a bundle for each of some arrays of streamlines by name, in one step; taken names get a number."""
        layer, there = self.scene.lines_layer(layer_id), list(self.of_layer(layer_id))
        colours, total = distinct_colours(len(there) + len(groups)), self.scene.data(layer).data.n_streamlines
        made: list[Bundle] = []
        for name, given in groups.items():
            ids = Ids.from_numbers(given)
            if not len(ids):
                raise ValueError(f"the bundle {shown(name)} has no streamlines")
            if ids.highest >= total:
                raise ValueError(f"streamline {ids.highest} does not exist; there are {total}")
            free = free_name(text(name, "name of a bundle", LONGEST), [one.name for one in there])
            made.append(Bundle(free, ids, hex_colour(colours[len(there)])))
            there.append(made[-1])
        self._put(layer, tuple(there), what)
        return made

    def move_bundles(self, layer_id: str, names: Sequence[str], to: int) -> None:
        """Put bundles together, in the order in which they are listed, to a place of the list from 0 on."""
        layer, there = self.scene.lines_layer(layer_id), self.of_layer(layer_id)
        moved = {id(named(there, name, "bundle")) for name in names}
        first = [one for one in there if id(one) not in moved]
        at = min(max(to, 0), len(first))
        ordered = (*first[:at], *(one for one in there if id(one) in moved), *first[at:])
        self._put(layer, ordered, f"order of {len(moved)} bundle(s)")

    def set_bundle(self, layer_id: str, bundle: str, /, **changes: Any) -> Bundle:
        """Change a bundle's ``name``, ``color`` or ``visible``."""
        layer, there = self.scene.lines_layer(layer_id), self.of_layer(layer_id)
        old = named(there, bundle, "bundle")
        wanted: dict[str, Any] = {}
        for key, value in changes.items():
            if key == "name":
                wanted[key] = value if value == old.name else self._new(there, value)
            elif key == "color":
                wanted[key] = colour(value, "colour")
            elif key == "visible":
                wanted[key] = truth(value, "visible")
            else:
                raise ValueError(f"a bundle has no {shown(key)}; it has name, color, visible")
        new = replace(old, **wanted)
        self._put(
            layer, tuple(new if one is old else one for one in there), f"{', '.join(wanted)} of {new.name}",
            {old.name: new.name},
        )  # fmt: skip
        return new

    def show_bundles(self, layer_id: str, names: Sequence[str] | None) -> None:
        """Show some bundles only; None for all."""
        layer, there = self.scene.lines_layer(layer_id), self.of_layer(layer_id)
        wanted = {one.name for one in there} if names is None else {named(there, name, "bundle").name for name in names}
        found = tuple(replace(one, visible=one.name in wanted) for one in there)
        self._put(layer, found, "show bundles")

    def merge_bundles(self, layer_id: str, names: Sequence[str]) -> Bundle:
        """Join bundles into the first of some, which keeps its name, place and colour."""
        layer, there = self.scene.lines_layer(layer_id), self.of_layer(layer_id)
        parts = [named(there, name, "bundle") for name in dict.fromkeys(names)]
        if len(parts) < 2:
            raise ValueError("choose two bundles or more to merge")
        ids = Ids.from_numbers(np.concatenate([one.ids.array() for one in parts]))
        new = replace(parts[0], ids=ids)
        kept = [new if one is parts[0] else one for one in there if one is parts[0] or one not in parts]
        gone: dict[str, str | None] = {one.name: new.name for one in parts[1:]}
        self._put(layer, tuple(kept), f"merge {len(parts)} bundles", gone)
        return new

    def subtract_bundles(self, layer_id: str, names: Sequence[str]) -> Bundle:
        """Take the streamlines of other bundles out of the first of some."""
        layer, there = self.scene.lines_layer(layer_id), self.of_layer(layer_id)
        first, *others = (named(there, name, "bundle") for name in dict.fromkeys(names))
        if not others:
            raise ValueError("choose a bundle, and then those whose streamlines are taken out of it")
        ids = np.setdiff1d(first.ids.array(), np.concatenate([one.ids.array() for one in others]))
        new = replace(first, ids=Ids.from_numbers(ids))
        self._put(layer, tuple(new if one is first else one for one in there), f"subtract from {first.name}")
        return new

    def remove_bundles(self, layer_id: str, names: Sequence[str]) -> None:
        """Take bundles off the list; their streamlines stay."""
        layer, there = self.scene.lines_layer(layer_id), self.of_layer(layer_id)
        gone = [named(there, name, "bundle") for name in names]
        left = tuple(one for one in there if one not in gone)
        self._put(layer, left, f"remove {len(gone)} bundle(s)", {one.name: None for one in gone})

    def select_bundles(self, layer_id: str, names: Sequence[str]) -> None:
        """Select the streamlines of bundles."""
        there = self.of_layer(layer_id)
        parts = [named(there, name, "bundle").ids.array() for name in names]
        self.scene.selection.select(layer_id, np.unique(np.concatenate(parts)) if parts else [])

    def _new(self, there: Sequence[Bundle], name: Any) -> str:
        given = text(name, "name of a bundle", LONGEST)
        if any(one.name == given for one in there):
            raise ValueError(f"there is a bundle {shown(given)} already; give another name")
        return given

    def _put(
        self, layer: Layer, bundles: tuple[Bundle, ...], what: str, renamed: Mapping[str, str | None] | None = None
    ) -> None:
        """Give a source other bundles; filters by group follow new names."""
        if len(bundles) > MOST:
            raise ValueError(f"there are {len(bundles)} bundles; {MOST} at most")
        state = self.scene.state
        rest = tuple((source, listed) for source, listed in state.bundles if source != layer.source)
        layers = tuple(
            _refitted(one, renamed or {}, bool(bundles)) if one.source == layer.source else one for one in state.layers
        )
        self.scene.become(replace(state, bundles=(*rest, (layer.source, bundles)), layers=layers), what)


def _refitted(layer: Layer, renamed: Mapping[str, str | None], any_left: bool) -> Layer:
    """Return a layer whose filters and colours name bundles that are there."""
    if not any_left and layer.settings.get("scalars") == "group":
        layer = replace(layer, settings=changed(layer.kind, layer.settings, "scalars", "orientation"))
    groups = layer.filters.groups
    if groups is None or not any(name in renamed for name in groups):
        return layer
    names = [renamed.get(name, name) for name in groups]
    left = tuple(dict.fromkeys(name for name in names if name is not None))
    return replace(layer, filters=replace(layer.filters, groups=left or None))


def _own(data: Any) -> tuple[Bundle, ...]:
    """Return the groups of a set as bundles."""
    colours, hidden = group_colours(data.groups, data.per_group), hidden_groups(data.per_group)
    return tuple(
        Bundle(str(name), Ids.from_numbers(np.asarray(ids, np.int64)), hex_colour(colours[name]), name not in hidden)
        for name, ids in data.groups.items()
    )


# In step --------------------------------------------------------------------------------------------


class BundleSync:
    """Keeps the groups of sets, and what their actors show, in step with a document."""

    def __init__(self) -> None:
        self._own: dict[Source, tuple[Any, dict[str, Any], dict[str, Any]]] = {}
        self._given: dict[Source, tuple[Bundle, ...]] = {}
        self._masks: dict[str, tuple[Any, Any]] = {}

    def own(self, source: Source, data: Any) -> list[str]:
        """Return the names of a file's groups, however they were edited since."""
        kept = self._own.get(source)
        return list(data.groups if kept is None or kept[0] is not data else kept[1])

    def groups(self, state: State, sets: Mapping[Source, Any]) -> set[Source]:
        """Apply the document's groups to the sets; return the sources of changed sets."""
        regrouped = set()
        for source, data in sets.items():
            wanted = state.bundles_of(source)
            own = self._own.get(source)
            if own is not None and own[0] is not data:  # read anew
                del self._own[source]
                self._given.pop(source, None)
                own = None
            if wanted == self._given.get(source):
                continue
            regrouped.add(source)
            if own is None:
                self._own[source] = data, dict(data.groups), {k: dict(v) for k, v in data.per_group.items()}
            if wanted is None:
                _, groups, facts = self._own.pop(source)
                del self._given[source]
                _replace(data, groups, facts)
            else:
                self._given[source] = wanted
                _replace(data, {}, {})
                listed = Bundles(data)
                for one in wanted:
                    listed.add(one.name, one.ids.array(), color=one.color, visible=one.visible)
        return regrouped

    def show(self, state: State, drawn: Iterable[tuple[Layer, Any]], regrouped: set[Source]) -> None:
        """Colour and hide bundles by the document."""
        for layer, actor in drawn:
            if layer.source in regrouped and isinstance(actor.scalars, str) and actor.scalars == "group":
                actor.scalars = "group" if actor.fiblets.groups else None
            bundles = state.bundles_of(layer.source)
            has = CONDITION in actor.conditions
            wanted = bundles if bundles and not all(one.visible for one in bundles) else None
            if self._masks.get(layer.id) == (actor, wanted) and has == (wanted is not None):
                continue
            self._masks[layer.id] = actor, wanted
            if wanted is not None:
                actor.include(_mask(wanted, actor.fiblets.n_streamlines), name=CONDITION)
            elif has:
                actor.remove_condition(CONDITION)


def _replace(data: Any, groups: Mapping[str, Any], facts: Mapping[str, Any]) -> None:
    for held, new in ((data.groups, groups), (data.per_group, facts)):
        held.clear()
        held.update(new)


def _mask(bundles: Iterable[Bundle], count: int) -> np.ndarray:
    """Return which streamlines are in a bundle that is shown, or in none."""
    mask = np.ones(count, bool)
    for wanted in (False, True):
        for one in bundles:
            if one.visible is wanted:
                mask[one.ids.array()] = wanted
    return mask


# Sessions -------------------------------------------------------------------------------------------


def check_bundles(value: Any, count: int, own: Collection[str]) -> tuple[Bundle, ...]:
    """Return the bundles that a session has for a file of ``count`` streamlines with groups of some names."""
    if not isinstance(value, list) or len(value) > MOST:
        raise ValueError(f"bundles are {shown(value)}; give a list of {MOST} at most")
    found: list[Bundle] = []
    for one in value:
        mapping(one, "bundle", ("name", "ids", "color"), ("visible",))
        ids = Ids(unpack(one["ids"], "ids of a bundle", count))
        given = one["name"]
        name = given if isinstance(given, str) and given in own else text(given, "name of a bundle", LONGEST)
        if any(name == other.name for other in found):
            raise ValueError(f"two bundles are called {shown(name)}")
        found.append(Bundle(name, ids, colour(one["color"], "colour"), truth(one.get("visible", True), "visible")))
    return tuple(found)
