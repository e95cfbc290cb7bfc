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
from pvfiblets.web.scene import matrix as scene_matrix
from pvfiblets.web.server.access import LARGEST_SESSION
from pvfiblets.web.session.document import LINES, Filters, Layer, Source, State, volumes_of
from pvfiblets.web.session.painting import as_json
from pvfiblets.web.session.reading import VERSION, Prepared, read_session

if TYPE_CHECKING:
    from pvfiblets.web.scene.files.loading import Cancel, Progress
    from pvfiblets.web.scene.scene import Scene

__all__ = [
    "Prepared", "SessionError", "apply", "from_dict", "from_text", "load", "prepare", "read", "save", "to_dict",
    "to_text",
]  # fmt: skip


class SessionError(FibletsError, ValueError):
    """A session cannot be opened; the message states the error, and the scene is unchanged."""


def to_dict(scene: Scene, folder: Path | None = None) -> dict[str, Any]:
    """Return a scene as JSON, whose numbers are finite; programs from before there were some of its parts refuse these.

    Paths are relative to the folder of the file that it is for where files lie in it; without one, to the scene's root.
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

    pairs = [[list(one.begin), list(one.end)] for one in state.measurements]
    measured = {"measurements": pairs} if pairs else {}
    return {
        "program": "pvfiblets",
        "version": VERSION,
        "background": state.background,
        "camera": scene.cameras.camera(),
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
    """Make a scene what a session says, in one step for its history; the session is not trusted."""
    apply(scene, prepare(scene, data, folder))


def prepare(
    scene: Scene,
    data: Any,
    folder: Path | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Prepared:
    """Read and check all that a session names, in any thread; paths are looked for in its folder, then in the root."""
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
        scene.cameras.set_camera(prepared.camera)


@contextmanager
def _as_session_error() -> Iterator[None]:
    try:
        yield
    except (FibletsError, ValueError, KeyError, TypeError, OSError, OverflowError, RecursionError) as error:
        said = error.args[0] if isinstance(error, KeyError) and error.args else error
        raise SessionError(f"the session cannot be opened: {said}") from error


def to_text(scene: Scene, folder: Path | None = None) -> str:
    """Return a scene as the text of a session file; SessionError where that is too large to be read again."""
    found = json.dumps(to_dict(scene, folder), allow_nan=False, indent=1)  # of ASCII
    _check_size("the session", len(found))
    return found


def from_text(content: str | bytes, name: str = "this") -> Any:
    """Return what a session file holds, for :func:`prepare`."""
    _check_size(name, len(content))
    try:
        return json.loads(content)
    except (ValueError, RecursionError) as error:
        raise SessionError(f"{name} is no session file: it is no JSON ({error})") from error


def save(scene: Scene, path: str) -> Path:
    """Write a session to a file under the scene's root; return its place."""
    target = scene.files.resolve(path, new=True)
    content = to_text(scene, target.parent)
    fresh = target.with_name(target.name + ".part")
    fresh.write_text(content, encoding="utf-8")
    fresh.replace(target)
    return target


def load(scene: Scene, path: str) -> None:
    """Make a scene what a file under its root says; see :func:`from_dict`."""
    place = scene.files.resolve(path)
    from_dict(scene, from_text(read(place), path), place.parent)


def read(place: Path) -> bytes:
    """Return the content of a session file that is not too large."""
    _check_size(place.name, place.stat().st_size)
    return place.read_bytes()


def _check_size(name: str, size: int) -> None:
    if size > LARGEST_SESSION:
        raise SessionError(f"{name} has {size:,} bytes; session files have {LARGEST_SESSION:,} at most")


# To JSON --------------------------------------------------------------------------------------------


def _bundles_to_dict(state: State, path_of: Any) -> dict[str, Any]:
    used = {layer.source for layer in state.layers if layer.kind in LINES}
    found = []
    for source, bundles in state.bundles:
        if source not in used:
            continue
        place = _place_of(source, path_of)
        if source.ids is not None:
            place["ids"] = source.ids.packed
        rows = [
            {"name": one.name, "color": one.color, "visible": one.visible, "ids": one.ids.packed} for one in bundles
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
        found["source"]["ids"] = source.ids.packed
    found["settings"] = dict(layer.settings)
    for name, volume in volumes_of(layer.settings).items():
        found["settings"][name] = {"volume": _place_of(volume, path_of)}
    if layer.filters.active:
        found["filters"] = _filters_to_dict(layer.filters, path_of, shape_of)
    if layer.selected is not None:
        found["selected"] = layer.selected.packed
    return found


def _place_of(source: Source, path_of: Any) -> dict[str, Any]:
    place = {"path": path_of(source.path)} if source.path is not None else {"demo": source.demo, "size": source.size}
    if source.space is not None:
        place["space"] = source.space
    return {**place, "values": [path_of(path) for path in source.values]} if source.values else place


def _filters_to_dict(filters: Filters, path_of: Any, shape_of: Any) -> dict[str, Any]:
    def end(value: float) -> float | None:
        return value if math.isfinite(value) else None

    def condition_of(condition: Mapping[str, Any]) -> dict[str, Any]:
        if "op" in condition:
            return {"op": condition["op"], "of": [condition_of(part) for part in condition["of"]]}
        return {**condition, "region": shape_of(condition["region"])}

    images = {name: _place_of(image, path_of) for name, image in filters.images.items()}
    return {
        "criteria": {name: [end(low), end(high)] for name, (low, high) in filters.criteria.items()},
        **({"images": images} if images else {}),
        "groups": None if filters.groups is None else list(filters.groups),
        "subset": None if filters.subset is None else dict(filters.subset),
        "regions": None if filters.regions is None else condition_of(filters.regions),
        **_connection(filters, path_of),
    }


def _connection(filters: Filters, path_of: Any) -> dict[str, Any]:
    if filters.connection is None:
        return {}
    return {"connection": {**filters.connection, "labels": path_of(filters.connection["labels"])}}
