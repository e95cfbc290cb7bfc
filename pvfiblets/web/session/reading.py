"""Sessions from JSON to a document: all values are checked first, and the files are read and fit."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets.web.scene import layers
from pvfiblets.web.scene import matrix as scene_matrix
from pvfiblets.web.scene.actors import split_cuts
from pvfiblets.web.scene.bundles import check_bundles
from pvfiblets.web.scene.cameras import check_camera
from pvfiblets.web.scene.filters import MOST_CLIPS, check_filters
from pvfiblets.web.scene.measurements import check_measurements
from pvfiblets.web.scene.scene import LONGEST_NAME, MOST_LAYERS, MOST_VALUES
from pvfiblets.web.scene.slices.slicing import SliceView, check_view
from pvfiblets.web.session.document import (
    KINDS,
    LINES,
    VOLUME_SETTINGS,
    Bundle,
    Clip,
    Ids,
    Layer,
    Matrix,
    Source,
    State,
    as_volume_choice,
)
from pvfiblets.web.session.painting import check_painting
from pvfiblets.web.session.runs import unpack
from pvfiblets.web.session.shapes import CUTTING, check_shape, make_predicate, make_region
from pvfiblets.web.values import colour, mapping, shown, text, truth, whole

if TYPE_CHECKING:
    from pvfiblets.web.scene.files.loading import Cancel, Progress
    from pvfiblets.web.scene.scene import Scene
    from pvfiblets.web.session.store import Store

VERSION = 1
_ID = re.compile(r"[a-z]+[0-9]{1,9}")


@dataclass(frozen=True)
class Prepared:
    """A session whose files are read and found to fit; :func:`.files.apply` shows it."""

    state: State
    camera: dict[str, Any] | None
    store: Store  # with all that the document names
    slices: SliceView | None = None


def read_session(
    scene: Scene, data: Any, folder: Path | None, progress: Progress | None, cancel: Cancel | None
) -> Prepared:
    """Return the document and the camera of a session whose files are read and found to fit."""
    # Parameters and errors as of `.files.prepare`.
    if not isinstance(data, Mapping):
        raise ValueError(f"it is {shown(data)} and no object")
    if data.get("program") != "pvfiblets":
        raise ValueError(f"its program is {shown(data.get('program'))}, not 'pvfiblets': it is no session")
    version = data.get("version")
    if isinstance(version, bool) or version != VERSION:
        raise ValueError(f"its version is {shown(version)}; this program reads version {VERSION}")
    optional = ("clips", "background", "camera", "measurements", "slices", "painting", "bundles", "matrix")
    mapping(data, "session", ("program", "version", "layers"), optional)
    for name, most in (("layers", MOST_LAYERS), ("clips", MOST_CLIPS)):
        if not isinstance(data.get(name, []), list) or len(data.get(name, [])) > most:
            raise ValueError(f"{name} is {shown(data.get(name))}; give a list of {most} at most")
    reading = _Reading(scene.store.fork(), _Paths(scene, folder), progress, cancel, {}, scene.bundles.own_groups)
    reading.bundles.update(_listed(data.get("bundles", []), reading))
    found = [_layer_from_dict(item, reading) for item in data["layers"]]
    clips = [_clip_from_dict(item, reading.paths) for item in data.get("clips", [])]
    ids = [layer.id for layer in found] + [clip.id for clip in clips]
    if twice := [name for name in ids if ids.count(name) > 1]:
        raise ValueError(f"the id {twice[0]!r} stands twice")
    background = colour(data.get("background", "#000000"), "background")
    measurements = check_measurements(data.get("measurements", []))
    painting = None if data.get("painting") is None else check_painting(data["painting"])
    slices = None if data.get("slices") is None else check_view(data["slices"])
    oblique = None if slices is None else slices.oblique
    state = State(tuple(found), tuple(clips), background, measurements, painting, oblique=oblique)
    state = replace(state, bundles=_bundles_from(reading, state))
    state = replace(state, matrix=_matrix_from(data.get("matrix"), reading, state))
    _check_cuts(reading.store, state)
    camera = data.get("camera")
    return Prepared(state, None if camera is None else check_camera(camera), reading.store, slices)


class _Paths:
    """The folders of a session's files: beside it, or under the root."""

    def __init__(self, scene: Scene, folder: Path | None) -> None:
        self._files, self._folder = scene.files, folder

    def __call__(self, value: Any) -> str:
        """Return a path as documents hold it, of a file that is there."""
        path = text(value, "path", 4096)
        if self._folder is not None and not Path(path).is_absolute():
            beside = Path(self._folder) / path
            try:
                return self._files.name(self._files.resolve(str(beside)))
            except (OSError, ValueError):
                pass  # the error for the root is easier to understand
        return self._files.name(self._files.resolve(path))

    def shape(self, shape: dict[str, Any]) -> dict[str, Any]:
        return {**shape, "path": self(shape["path"])} if "path" in shape else shape

    def condition(self, condition: Mapping[str, Any]) -> dict[str, Any]:
        if "op" in condition:
            return {"op": condition["op"], "of": [self.condition(part) for part in condition["of"]]}
        return {**condition, "region": self.shape(condition["region"])}


@dataclass(frozen=True)
class _Reading:
    """State of reading a session; its store is another than the scene's, which is in use meanwhile."""

    store: Store
    paths: _Paths
    progress: Progress | None
    cancel: Cancel | None
    bundles: dict[Source, list[Any]]  # unchecked
    own: Callable[[Source, Any], Any]  # names of a file's groups, however they were edited since

    def source(self, value: Any, kind: str | None = None) -> Source:
        """Return a source, for a layer of some kind; the file is read where ids must be among its streamlines."""
        ids = mapping(value, "source", (), ("path", "demo", "size", "ids", "values", "space")).get("ids")
        if kind is not None and (kind == "selection") != (ids is not None):
            raise ValueError(f"a layer of kind {kind!r} has {'no ' if ids is None else ''}ids in its source")
        values = value.get("values", [])
        if not isinstance(values, list) or len(values) > MOST_VALUES:
            raise ValueError(f"values of a source is {shown(values)}; give a list of {MOST_VALUES} paths at most")
        if (value.get("path") is None) == (value.get("demo") is None):
            raise ValueError("a source has either a path or a demo")
        if value.get("path") is not None:
            space = value.get("space")
            if space not in (None, "RAS", "LPS"):
                raise ValueError(f"space of a source is {shown(space)}; choose RAS or LPS")
            found = Source(self.paths(value["path"]), space=space)
        elif value["demo"] in ("tracts", "head"):
            most = 100_000 if value["demo"] == "tracts" else 256
            found = Source(demo=value["demo"], size=whole(value.get("size"), "size of a demo", 2, most))
        else:
            raise ValueError(f"demo is {shown(value['demo'])}; choose one of tracts, head")
        found = replace(found, values=tuple(self.paths(path) for path in values))
        if ids is None:
            return found
        count = self.store.whole(found, self.progress, self.cancel).n_streamlines
        return replace(found, ids=Ids(unpack(ids, "ids", count)))

    def volume(self, setting: Any) -> list[tuple[Any, str]]:
        """Return the one volume that a setting names, as a choice; none if it names none."""
        if not isinstance(setting, Mapping):
            return []
        mapping(setting, "volume of a setting", ("volume",))
        return [(as_volume_choice(self.sampled(setting["volume"])), "volume")]

    def sampled(self, value: Any) -> Source:
        """Return the source of a volume that colours or filters lines, which is read."""
        source = self.source(value, "volume")
        if source.values:
            raise ValueError("a volume that colours or filters lines has values; volumes have no streamlines")
        self.store.colours(source, self.progress, self.cancel)
        return source


def _layer_from_dict(value: Any, reading: _Reading) -> Layer:
    store, paths = reading.store, reading.paths
    mapping(value, "layer", ("id", "kind", "name", "source"), ("visible", "settings", "filters", "selected"))
    kind = value["kind"]
    if kind not in KINDS:
        raise ValueError(f"the kind of a layer is {shown(kind)}; choose one of {', '.join(KINDS)}")
    source = reading.source(value["source"], kind)
    if source.values and kind not in (*LINES, "image", "mesh"):
        raise ValueError(f"a layer of kind {kind!r} has values in its source; tractograms, images and meshes have")
    visible = truth(value.get("visible", True), "visible")
    layer = Layer(_id(value["id"]), kind, text(value["name"], "name", LONGEST_NAME), source, visible)
    data = store.data(layer, reading.progress, reading.cancel).data
    settings = layers.defaults(kind)
    for name, setting in mapping(value.get("settings", {}), "settings", (), tuple(settings)).items():
        if name == "scalars" and setting == "group" and reading.bundles.get(source):
            settings[name] = setting  # of bundles that come with the session
            continue
        volumes = reading.volume(setting) if name in VOLUME_SETTINGS else []
        settings[name] = layers.check(kind, name, volumes[0][0] if volumes else setting, data, volumes)
    layer = replace(layer, settings=settings)
    if kind not in LINES:
        if value.get("filters") is not None or value.get("selected") is not None:
            raise ValueError(f"{layer.name!r} is of kind {kind} and has filters or a selection; tractograms alone have")
        return layer
    if value.get("filters") is not None:
        bundles = reading.bundles.get(source)
        groups = reading.own(source, data) if bundles is None else [str(one["name"]) for one in bundles]
        filters = check_filters(value["filters"], data, groups, paths, reading.sampled)
        if filters.connection is not None:  # here, where no frame waits for it
            path, radius = filters.connection["labels"], filters.connection["radius"]
            store.end_labels(data, path, radius, reading.progress, reading.cancel)
        if filters.regions is not None:
            regions = paths.condition(filters.regions)
            make_predicate(regions, store.shape)
            filters = replace(filters, regions=regions)
        layer = replace(layer, filters=filters)
    if value.get("selected") is not None:
        selected = Ids(unpack(value["selected"], "selected", data.n_streamlines))
        layer = replace(layer, selected=selected if len(selected) else None)
    return layer


def _listed(value: Any, reading: _Reading) -> dict[Source, list[Any]]:
    """Return bundles by their source, with checked names only."""
    if not isinstance(value, list) or len(value) > MOST_LAYERS:
        raise ValueError(f"bundles are {shown(value)}; give a list of {MOST_LAYERS} at most")
    found: dict[Source, list[Any]] = {}
    for one in value:
        mapping(one, "bundles", ("source", "bundles"))
        rows = one["bundles"]
        if not isinstance(rows, list) or not all(isinstance(row, Mapping) and "name" in row for row in rows):
            raise ValueError(f"bundles of a source are {shown(rows)}; give a list of bundles")
        found[reading.source(one["source"])] = rows
    return found


def _bundles_from(reading: _Reading, state: State) -> tuple[tuple[Source, tuple[Bundle, ...]], ...]:
    found = []
    for source, rows in reading.bundles.items():
        layer = next((one for one in state.layers if one.kind in LINES and one.source == source), None)
        if layer is None:
            raise ValueError("there are bundles of what no layer shows")
        data = reading.store.data(layer).data
        found.append((source, check_bundles(rows, data.n_streamlines, reading.own(source, data))))
    return tuple(found)


def _matrix_from(value: Any, reading: _Reading, state: State) -> Matrix | None:
    def data_of(layer_id: str) -> Any:
        layer = state.layer(layer_id)
        if layer.kind not in LINES:
            raise ValueError(f"the matrix is of {layer.name!r}, which is of kind {layer.kind} and has no streamlines")
        return reading.store.data(layer).data

    return None if value is None else scene_matrix.check_matrix(value, data_of, reading.paths)


def _clip_from_dict(value: Any, paths: _Paths) -> Clip:
    mapping(value, "clip", ("id", "name", "shape"), ("inside", "enabled", "layers"))
    of = value.get("layers")
    if of is not None and not (isinstance(of, list) and all(isinstance(item, str) for item in of)):
        raise ValueError(f"layers of a cut is {shown(of)}; give a list of ids, or null")
    return Clip(
        _id(value["id"]),
        text(value["name"], "name"),
        paths.shape(check_shape(value["shape"], "cut", CUTTING)),
        truth(value.get("inside", True), "inside"),
        truth(value.get("enabled", True), "enabled"),
        None if of is None else tuple(of),
    )


def _check_cuts(store: Store, state: State) -> None:
    for clip in state.clips:
        make_region(clip.shape, store.shape)
        for layer_id in clip.layers or ():
            if state.layer(layer_id).kind == "image":
                raise ValueError(f"{clip.name!r} cuts an image of slices, which are not cut")
    for layer in state.layers:
        if layer.kind not in (*LINES, "volume", "image"):
            split_cuts(layer, [clip for clip in state.clips if clip.cuts(layer)])


def _id(value: Any) -> str:
    if not isinstance(value, str) or not _ID.fullmatch(value):
        raise ValueError(f"an id is {shown(value)}; ids are letters and a number, such as 'layer1'")
    return value
