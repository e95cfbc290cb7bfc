"""Sessions as files: all that a scene shows and from where, as JSON.

A session that was saved is as little trusted as a browser: it is read whole and checked against the data that it names
before anything changes, and its paths are confined as all paths are.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.errors import FibletsError
from pvfiblets.web import layers, scene_matrix
from pvfiblets.web.actors import split_cuts
from pvfiblets.web.cameras import check_camera
from pvfiblets.web.document import (
    KINDS,
    LINES,
    VOLUME_SETTINGS,
    Bundle,
    Clip,
    Filters,
    Ids,
    Layer,
    Matrix,
    Source,
    State,
    as_volume_choice,
    volumes_of,
)
from pvfiblets.web.painting import as_json, check_painting
from pvfiblets.web.scene_bundles import check_bundles
from pvfiblets.web.scene_filters import MOST_CLIPS, check_filters
from pvfiblets.web.scene_measurements import check_measurements
from pvfiblets.web.shapes import CUTTING, check_shape, make_predicate, make_region
from pvfiblets.web.slicing import SliceView, check_view
from pvfiblets.web.values import colour, mapping, shown, text, truth, whole

if TYPE_CHECKING:
    from pvfiblets.web.loading import Cancel, Progress
    from pvfiblets.web.scene import Scene
    from pvfiblets.web.store import Store

__all__ = ["VERSION", "Prepared", "SessionError", "apply", "from_dict", "load", "prepare", "save", "to_dict"]

VERSION = 1
LARGEST = 64_000_000  # bytes of a file
_MOST_LAYERS = 64
_MOST_RUNS = 4_000_000
_MOST_VALUES = 64
_ID = re.compile(r"[a-z]+[0-9]{1,9}")


class SessionError(FibletsError, ValueError):
    """A session cannot be taken over; the message says what is wrong with it, and the scene is as it was."""


def to_dict(scene: Scene, folder: Path | None = None) -> dict[str, Any]:
    """Return a scene as JSON.

    Parameters
    ----------
    scene : Scene
    folder : Path, optional
        Of the file that it is for: paths are relative to it where files lie in it. By default they are relative to the
        scene's root where they lie in that, and absolute elsewhere.

    Returns
    -------
    dict
        ``version``, ``layers``, ``clips``, ``background``, ``camera``, and ``measurements``, ``slices``,
        ``painting``, ``bundles`` and ``matrix`` where there are any; no numbers but finite ones.
    """
    state = scene.state

    def path_of(path: str) -> str:
        if folder is None:
            return path
        place = scene.files.resolve(path)
        home = Path(folder).resolve()
        return place.relative_to(home).as_posix() if place.is_relative_to(home) else path

    def shape_of(shape: Mapping[str, Any]) -> dict[str, Any]:
        return {**shape, "path": path_of(shape["path"])} if "path" in shape else dict(shape)

    # Programs from before there were any refuse what they do not know.
    pairs = [[list(one.begin), list(one.end)] for one in state.measurements]
    measured = {"measurements": pairs} if pairs else {}
    return {
        "program": "pvfiblets",
        "version": VERSION,
        "background": state.background,
        "camera": scene.camera(),
        **_slices_to_dict(scene),
        "layers": [_layer_to_dict(layer, path_of, shape_of) for layer in state.layers],
        "clips": [
            {
                "id": clip.id,
                "name": clip.name,
                "shape": shape_of(clip.shape),
                "inside": clip.inside,
                "enabled": clip.enabled,
                "layers": None if clip.layers is None else list(clip.layers),
            }
            for clip in state.clips
        ],
        **measured,
        **_painting_to_dict(scene),
        **_bundles_to_dict(state, path_of),
        **({} if state.matrix is None else {"matrix": scene_matrix.as_json(state.matrix, path_of)}),
    }


@dataclass(frozen=True)
class Prepared:
    """A session whose files are read and found to fit; :func:`apply` shows it."""

    state: State
    camera: dict[str, Any] | None
    store: Store  # with all that the document names
    slices: SliceView | None = None


def from_dict(scene: Scene, data: Any, folder: Path | None = None) -> None:
    """Make a scene what a session says; one step for its history.

    Parameters
    ----------
    scene : Scene
    data : dict
        Of :func:`to_dict`; not trusted.
    folder : Path, optional
        Of the file that it is from: paths are looked for there first, then under the scene's root.

    Raises
    ------
    SessionError
        If anything in it is malformed, its files are not there or not allowed, or do not fit; the scene is as it was.
    """
    apply(scene, prepare(scene, data, folder))


def prepare(
    scene: Scene,
    data: Any,
    folder: Path | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Prepared:
    """Read and check all that a session names; nothing is drawn, so that it may run in a thread of its own.

    Arguments and errors as of :func:`from_dict` and :meth:`.Scene.load`.
    """
    with _as_session_error():
        return _checked(scene, data, folder, progress, cancel)


def apply(scene: Scene, prepared: Prepared) -> None:
    """Show a session that was prepared for this scene."""
    scene.store.take(prepared.store)
    try:
        with _as_session_error():
            scene.become(prepared.state, "open a session")
    except SessionError:
        scene.forget_unused()
        raise
    if prepared.slices is not None:
        scene.slicing.view = prepared.slices
    if prepared.camera is not None:
        scene.set_camera(prepared.camera)


@contextmanager
def _as_session_error() -> Iterator[None]:
    try:
        yield
    except (FibletsError, ValueError, KeyError, TypeError, OSError, OverflowError, RecursionError) as error:
        said = error.args[0] if isinstance(error, KeyError) and error.args else error
        raise SessionError(f"the session cannot be opened: {said}") from error


def save(scene: Scene, path: str) -> Path:
    """Write a session to a file under the scene's root; return its place."""
    target = scene.files.resolve(path, new=True)
    content = json.dumps(to_dict(scene, target.parent), allow_nan=False, indent=1)
    fresh = target.with_name(target.name + ".part")
    fresh.write_text(content, encoding="utf-8")
    fresh.replace(target)
    return target


def load(scene: Scene, path: str) -> None:
    """Make a scene what a file under its root says; see :func:`from_dict`."""
    place = scene.files.resolve(path)
    if place.stat().st_size > LARGEST:
        raise SessionError(f"{path} has {place.stat().st_size:,} bytes; sessions have {LARGEST:,} at most")
    try:
        data = json.loads(place.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise SessionError(f"{path} is no session: it is no JSON ({error})") from error
    from_dict(scene, data, place.parent)


# To JSON --------------------------------------------------------------------------------------------


def _bundles_to_dict(state: State, path_of: Any) -> dict[str, Any]:
    used = {layer.source for layer in state.layers}
    found = []
    for source, bundles in state.bundles:
        if source not in used:
            continue
        place = _place_of(source, path_of)
        if source.ids is not None:
            place["ids"] = source.ids.runs.ravel().tolist()
        rows = [
            {"name": one.name, "color": one.color, "visible": one.visible, "ids": one.ids.runs.ravel().tolist()}
            for one in bundles
        ]
        found.append({"source": place, "bundles": rows})
    return {"bundles": found} if found else {}


def _painting_to_dict(scene: Scene) -> dict[str, Any]:
    painting, painter = scene.state.painting, scene.canvas.painter
    return {} if painting is None or painter is None else {"painting": as_json(painting, painter.labels)}


def _slices_to_dict(scene: Scene) -> dict[str, Any]:
    there = any(layer.kind == "image" for layer in scene.layers)
    return {"slices": scene.slicing.view.as_json()} if there else {}


def _layer_to_dict(layer: Layer, path_of: Any, shape_of: Any) -> dict[str, Any]:
    source = layer.source
    found: dict[str, Any] = {"id": layer.id, "kind": layer.kind, "name": layer.name, "visible": layer.visible}
    found["source"] = _place_of(source, path_of)
    if source.ids is not None:
        found["source"]["ids"] = source.ids.runs.ravel().tolist()
    found["settings"] = dict(layer.settings)
    for name, volume in volumes_of(layer.settings).items():
        found["settings"][name] = {"volume": _place_of(volume, path_of)}
    if layer.filters.active:
        found["filters"] = _filters_to_dict(layer.filters, shape_of)
    if layer.selected is not None:
        found["selected"] = layer.selected.runs.ravel().tolist()
    return found


def _place_of(source: Source, path_of: Any) -> dict[str, Any]:
    place = {"path": path_of(source.path)} if source.path is not None else {"demo": source.demo, "size": source.size}
    return {**place, "values": [path_of(path) for path in source.values]} if source.values else place


def _filters_to_dict(filters: Filters, shape_of: Any) -> dict[str, Any]:
    def end(value: float) -> float | None:
        return value if math.isfinite(value) else None

    def condition_of(condition: Mapping[str, Any]) -> dict[str, Any]:
        if "op" in condition:
            return {"op": condition["op"], "of": [condition_of(part) for part in condition["of"]]}
        return {"how": condition["how"], "region": shape_of(condition["region"])}

    return {
        "criteria": {name: [end(low), end(high)] for name, (low, high) in filters.criteria.items()},
        "groups": None if filters.groups is None else list(filters.groups),
        "subset": None if filters.subset is None else dict(filters.subset),
        "regions": None if filters.regions is None else condition_of(filters.regions),
        **_connection(filters, shape_of),
    }


def _connection(filters: Filters, shape_of: Any) -> dict[str, Any]:
    if filters.connection is None:  # programs from before there were any refuse what they do not know
        return {}
    path = shape_of({"path": filters.connection["labels"]})["path"]
    return {"connection": {**filters.connection, "labels": path}}


# From JSON ------------------------------------------------------------------------------------------


def _checked(
    scene: Scene, data: Any, folder: Path | None, progress: Progress | None, cancel: Cancel | None
) -> Prepared:
    """Return the document and the camera of a session whose files are read and found to fit."""
    if not isinstance(data, Mapping):
        raise ValueError(f"it is {shown(data)} and no object")
    if data.get("program") != "pvfiblets":
        raise ValueError(f"its program is {shown(data.get('program'))}, not 'pvfiblets': it is no session")
    version = data.get("version")
    if isinstance(version, bool) or version != VERSION:
        raise ValueError(f"its version is {shown(version)}; this program reads version {VERSION}")
    optional = ("clips", "background", "camera", "measurements", "slices", "painting", "bundles", "matrix")
    mapping(data, "session", ("program", "version", "layers"), optional)
    for name, most in (("layers", _MOST_LAYERS), ("clips", MOST_CLIPS)):
        if not isinstance(data.get(name, []), list) or len(data.get(name, [])) > most:
            raise ValueError(f"{name} is {shown(data.get(name))}; give a list of {most} at most")
    paths = _Paths(scene, folder)
    reading = _Reading(scene.store.fork(), paths, progress, cancel, _listed(data.get("bundles", []), paths),
                       scene.own_groups)  # fmt: skip
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
    """Where files of a session are: beside it, or under the root."""

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
                pass  # what is said of it under the root is easier to understand
        return self._files.name(self._files.resolve(path))

    def shape(self, shape: dict[str, Any]) -> dict[str, Any]:
        return {**shape, "path": self(shape["path"])} if "path" in shape else shape

    def condition(self, condition: Mapping[str, Any]) -> dict[str, Any]:
        if "op" in condition:
            return {"op": condition["op"], "of": [self.condition(part) for part in condition["of"]]}
        return {"how": condition["how"], "region": self.shape(condition["region"])}


@dataclass(frozen=True)
class _Reading:
    """What a session is read with; its store is another than the scene's, which is in use meanwhile."""

    store: Store
    paths: _Paths
    progress: Progress | None
    cancel: Cancel | None
    bundles: Mapping[Source, list[Any]]  # as they were sent
    own: Callable[[Source, Any], Any]  # names of a file's groups, however they were edited since

    def volume(self, setting: Any) -> list[tuple[Any, str]]:
        """Return the one volume that a setting names, as a choice; none if it names none."""
        if not isinstance(setting, Mapping):
            return []
        mapping(setting, "volume of a setting", ("volume",))
        source = _source_from_dict(setting["volume"], self.paths)
        if source.ids is not None or source.values:
            raise ValueError("a volume that colours lines has ids or values; volumes have no streamlines")
        self.store.colours(source, self.progress, self.cancel)
        return [(as_volume_choice(source), "volume")]


def _layer_from_dict(value: Any, reading: _Reading) -> Layer:
    store, paths = reading.store, reading.paths
    mapping(value, "layer", ("id", "kind", "name", "source"), ("visible", "settings", "filters", "selected"))
    kind = value["kind"]
    if kind not in KINDS:
        raise ValueError(f"the kind of a layer is {shown(kind)}; choose one of {', '.join(KINDS)}")
    source = _source_from_dict(value["source"], paths)
    if source.values and kind not in (*LINES, "image", "mesh"):
        raise ValueError(f"a layer of kind {kind!r} has values in its source; tractograms, images and meshes have")
    if (kind == "selection") != (source.ids is not None):
        raise ValueError(f"a layer of kind {kind!r} has {'no ' if source.ids is None else ''}ids in its source")
    visible = truth(value.get("visible", True), "visible")
    layer = Layer(_id(value["id"]), kind, text(value["name"], "name"), source, visible)
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
        filters = check_filters(value["filters"], data, groups, paths)
        if filters.connection is not None:  # here, where nobody waits for a picture
            path, radius = filters.connection["labels"], filters.connection["radius"]
            store.end_labels(data, path, radius, reading.progress, reading.cancel)
        if filters.regions is not None:
            regions = paths.condition(filters.regions)
            make_predicate(regions, store.shape)
            filters = replace(filters, regions=regions)
        layer = replace(layer, filters=filters)
    if value.get("selected") is not None:
        selected = _ids(value["selected"], "selected")
        if selected.highest >= data.n_streamlines:
            raise ValueError(f"streamline {selected.highest} is selected, of {data.n_streamlines} in {layer.name!r}")
        layer = replace(layer, selected=selected if len(selected) else None)
    return layer


def _listed(value: Any, paths: _Paths) -> dict[Source, list[Any]]:
    """Return bundles by their source, of which no more is known yet than that they have names."""
    if not isinstance(value, list) or len(value) > _MOST_LAYERS:
        raise ValueError(f"bundles are {shown(value)}; give a list of {_MOST_LAYERS} at most")
    found: dict[Source, list[Any]] = {}
    for one in value:
        mapping(one, "bundles", ("source", "bundles"))
        rows = one["bundles"]
        if not isinstance(rows, list) or not all(isinstance(row, Mapping) and "name" in row for row in rows):
            raise ValueError(f"bundles of a source are {shown(rows)}; give a list of bundles")
        found[_source_from_dict(one["source"], paths)] = rows
    return found


def _bundles_from(reading: _Reading, state: State) -> tuple[tuple[Source, tuple[Bundle, ...]], ...]:
    found = []
    for source, rows in reading.bundles.items():
        layer = next((one for one in state.layers if one.kind in LINES and one.source == source), None)
        if layer is None:
            raise ValueError("there are bundles of what no layer shows")
        found.append((source, check_bundles(rows, _ids, reading.store.data(layer).data.n_streamlines)))
    return tuple(found)


def _matrix_from(value: Any, reading: _Reading, state: State) -> Matrix | None:
    def data_of(layer_id: str) -> Any:
        layer = state.layer(layer_id)
        if layer.kind not in LINES:
            raise ValueError(f"the matrix is of {layer.name!r}, which is of kind {layer.kind} and has no streamlines")
        return reading.store.data(layer).data

    return None if value is None else scene_matrix.check_matrix(value, data_of, reading.paths)


def _source_from_dict(value: Any, paths: _Paths) -> Source:
    mapping(value, "source", (), ("path", "demo", "size", "ids", "values"))
    ids = None if value.get("ids") is None else _ids(value["ids"], "ids")
    values = value.get("values", [])
    if not isinstance(values, list) or len(values) > _MOST_VALUES:
        raise ValueError(f"values of a source is {shown(values)}; give a list of {_MOST_VALUES} paths at most")
    held = tuple(paths(path) for path in values)
    if (value.get("path") is None) == (value.get("demo") is None):
        raise ValueError("a source has either a path or a demo")
    if value.get("path") is not None:
        return Source(paths(value["path"]), ids=ids, values=held)
    if value["demo"] not in ("tracts", "head"):
        raise ValueError(f"demo is {shown(value['demo'])}; choose one of tracts, head")
    most = 100_000 if value["demo"] == "tracts" else 256
    return Source(demo=value["demo"], size=whole(value.get("size"), "size of a demo", 2, most), ids=ids, values=held)


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


def _ids(value: Any, name: str) -> Ids:
    """Return streamlines of a flat list of runs."""
    fine = isinstance(value, list) and len(value) % 2 == 0 and len(value) <= 2 * _MOST_RUNS
    if not fine or not all(type(item) is int and 0 <= item < 2**62 for item in value):
        raise ValueError(f"{name} is {shown(value)}; give first and behind the last of each run of streamlines")
    return Ids(np.array(value, np.int64).reshape(-1, 2))
