"""Sessions as files: all that a scene shows and from where, as JSON.

A session that was saved is as little trusted as a browser: it is read whole and checked against the data that it names
before anything changes, and its paths are confined as all paths are.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets.errors import FibletsError
from pvfiblets.web import scene_matrix
from pvfiblets.web.document import Filters, Layer, Source, State, volumes_of
from pvfiblets.web.painting import as_json
from pvfiblets.web.session_reading import VERSION, Prepared, read_session

if TYPE_CHECKING:
    from pvfiblets.web.loading import Cancel, Progress
    from pvfiblets.web.scene import Scene

__all__ = ["Prepared", "SessionError", "apply", "from_dict", "load", "prepare", "save", "to_dict"]

LARGEST = 64_000_000  # bytes of a file


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
        return read_session(scene, data, folder, progress, cancel)


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
