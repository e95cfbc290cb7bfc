"""Collecting the lines, imports and names of a script; and lines of cameras, bars and distances."""

from __future__ import annotations

import ast
import itertools
import keyword
import re
import textwrap
from collections.abc import Container, Mapping
from typing import TYPE_CHECKING, Any

from pvfiblets.web.scene.distance_label import LABELS, NEAREST
from pvfiblets.web.scene.distance_label import LINES as LINE_LOOKS
from pvfiblets.web.scene.scalar_bars import bar_arguments, bar_calls, bars_of
from pvfiblets.web.session.runs import pack
from pvfiblets.web.session.script_code import code

if TYPE_CHECKING:
    from pvfiblets.web.scene.scene import Scene
    from pvfiblets.web.session.document import Source

_WIDEST = 110
_MOST_RUNS = 200  # of streamlines or voxels that a script lists one by one


def free_variable(name: str, taken: Container[str]) -> str:
    """Return a variable that is called after a file or layer and is not taken."""
    stem = re.sub(r"\W+", "_", name.lower().split(".")[0], flags=re.ASCII).strip("_")[:24] or "layer"
    if stem[0].isdigit() or keyword.iskeyword(stem):
        stem = f"layer_{stem}"
    return next(found for k in itertools.count(1) if (found := stem if k == 1 else f"{stem}_{k}") not in taken)


def names_in(script: str) -> set[str]:
    """Return all names that a script uses, but attributes of others."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(script)):
        if isinstance(node, ast.Name):
            found.add(node.id)
        elif isinstance(node, ast.alias):
            found.add((node.asname or node.name).partition(".")[0])
        elif isinstance(node, ast.FunctionDef):
            found.add(node.name)
    return found


class ScriptWriter:
    """Collects lines and their imports; ``names`` are variables of layers, by their ids."""

    def __init__(self, scene: Scene, names: Mapping[str, str]) -> None:
        self._scene = scene
        self._plotter = scene.plotter
        self._lines: list[str] = []
        self._imports: set[str] = {"import pyvista as pv"}
        self._names = names
        self._wholes: dict[Source, str] = {}
        self._volumes: dict[str, str] = {}  # of parcels, by path
        self._uses_folder = False
        self._uses_labels = False
        self._uses_packed = False
        self._sliced = False

    def _file(self, path: str) -> str:
        """Return Python of a path."""
        if self._scene.root is not None and not path.startswith("/") and not re.match(r"[A-Za-z]:", path):
            self._uses_folder = True
            return f"FOLDER / {path!r}"
        return repr(path)

    def _ids(self, runs: Any) -> str:
        if len(runs) == 1:
            return f"slice({runs[0, 0]}, {runs[0, 1]})"
        self._imports.add("import numpy as np")
        if len(runs) > _MOST_RUNS:
            self._imports.add("import base64")
            self._uses_packed = True
            return "\n    ".join(["unpacked(", *map(repr, textwrap.wrap(pack(runs), _WIDEST))]) + "\n)"
        parts = [str(first) if after == first + 1 else f"{first}:{after}" for first, after in runs.tolist()]
        line = f"np.r_[{', '.join(parts)}]"
        if len(line) <= _WIDEST:
            return line
        lines = textwrap.wrap(", ".join(parts), _WIDEST, break_long_words=False)
        return "\n    ".join(["np.r_[", *lines]) + "\n]"

    def _variable(self, name: str) -> str:
        """Return a variable of the script's own."""
        return free_variable(name, {*self._names.values(), *self._wholes.values(), *self._volumes.values()})

    def _call(self, function: str, first: str, *parts: Mapping[str, Any] | str) -> None:
        """Write a call, over several lines where it is long."""
        arguments = [first]
        for part in parts:
            if isinstance(part, str):
                arguments.append(part)
            else:
                arguments += [f"{key}={code(value)}" for key, value in part.items()]
        line = f"{function}({', '.join(arguments)})"
        if len(line) <= _WIDEST or "\n" in first:
            self._lines += [line]
        else:
            self._lines += [f"{function}(", *(f"    {argument}," for argument in arguments), ")"]


class ViewWriter(ScriptWriter):
    """Writes overlays and the camera."""

    def _measurements(self) -> None:
        found = self._scene.state.measurements
        if not found:
            return
        self._imports.add("import numpy as np")
        self._lines += ["ends = np.array([  # of measured distances, mm"]
        self._lines += [f"    [{one.begin}, {one.end}]," for one in found]
        self._lines += ["])", "segments = pv.line_segments_from_points(ends.reshape(-1, 3))"]
        self._call("line = plotter.add_mesh", "segments", {**LINE_LOOKS, "reset_camera": False})
        self._lines += ["line.mapper.SetResolveCoincidentTopologyToPolygonOffset()"]
        self._lines += [f"line.mapper.SetRelativeCoincidentTopologyLineOffsetParameters{NEAREST}  # before everything"]
        texts = repr([one.text for one in found])
        self._call("plotter.add_point_labels", "ends.mean(axis=1)", texts, {**LABELS, "reset_camera": False})
        self._lines += [""]

    def _bars(self) -> None:
        state = self._scene.state
        self._scene.bars.arrange()
        drawn = [(layer, self._scene.actor(layer.id)) for layer in state.layers]
        size = self._scene.bars.size
        for (title, layer, _), place in zip(bars_of(drawn), self._scene.bars.places, strict=True):
            if place is None:
                continue
            arguments = bar_arguments(place, size, state.background)
            mapper = f"mapper={self._names[layer.id]}.mapper"
            self._call("bar = plotter.add_scalar_bar", repr(title), mapper, arguments)
            for name, given in bar_calls(title, place).items():
                self._lines += [f"bar.{name}({', '.join(map(repr, given))})"]
            if not place.labels:
                self._lines += ["bar.GetAnnotationTextProperty().SetVerticalJustificationToCentered()"]

    def _camera(self) -> None:
        camera = self._scene.cameras.camera()
        self._lines += ["", "plotter.camera_position = ["]
        self._lines += [f"    {tuple(camera[part])}," for part in ("position", "focal_point", "up")]
        self._lines += ["]"]
        self._lines += [f"plotter.camera.view_angle = {camera['view_angle']}"]
        if camera["parallel"]:
            self._lines += ["plotter.enable_parallel_projection()"]
            self._lines += [f"plotter.camera.parallel_scale = {camera['parallel_scale']}"]
        self._lines += ["plotter.renderer.reset_camera_clipping_range()"]
