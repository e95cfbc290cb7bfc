"""Pickers and exporters of VTK that see what this package draws.

VTK's own hook for Python, ``vtkClass.override``, has ``vtkCellPicker()`` and its like make objects of these classes
from the first actor of this package on. They do what VTK's do; only around each pick and each export mappers are
readable (`pvfiblets.mappers.vtk_pipeline.readable_lines`). A picker that was made before, or is of a class of its own,
is handled by `follow`.
"""

from __future__ import annotations

import sys
from contextlib import nullcontext
from typing import Any

import numpy as np
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkRenderingCore import vtkActor, vtkCellPicker, vtkPicker, vtkPointPicker

from pvfiblets.mappers.frames.scene import actors_in, items_of, to_array
from pvfiblets.mappers.vtk_pipeline.readable_lines import MOST_POINTS, LineReading, readable, reading_of

EXPORTERS = {
    "vtkmodules.vtkIOExport": (
        "vtkGLTFExporter", "vtkIVExporter", "vtkJSONSceneExporter", "vtkOBJExporter", "vtkOOGLExporter",
        "vtkPOVExporter", "vtkRIBExporter", "vtkSingleVTPExporter", "vtkVRMLExporter", "vtkX3DExporter",
    ),
}  # fmt: skip


def follow(picker: vtkPicker) -> Any:
    """Make a ``vtkPicker`` or its like find this package's actors, and return it.

    Those that are made after the first actor of this package do so by themselves. Its ``GetDataSet()`` is PolyData of
    the lines that are shown, whose cell data ``'streamline'`` says which streamline ``GetCellId()`` is.
    """
    picker.AddObserver(vtkCommand.StartPickEvent, _begin)
    picker.AddObserver(vtkCommand.EndPickEvent, _end)
    return picker


def _readings(picker: vtkPicker) -> list[LineReading]:
    renderer = picker.GetRenderer()
    if renderer is None:
        return []
    found = [actor for prop in items_of(renderer.GetViewProps()) for actor in actors_in(prop)]
    shown = [reading_of(actor.GetMapper()) for actor in found if actor.GetVisibility() and actor.GetPickable()]
    return [reading for reading in shown if reading is not None]


def _begin(picker: Any, _event: str) -> None:
    looked_at = []
    for reading in _readings(picker):
        if reading.purpose == "selection":  # until the next picture
            reading.end()
        if not reading.mapper.is_readable and reading.points is not None:
            looked_at.append(reading.near(_ray(picker, reading.mapper.actor), MOST_POINTS))
            reading.begin(looked_at[-1])
    picker.looked_at = looked_at  # of what its GetDataSet() returns it keeps an address only


def _ray(picker: vtkPicker, actor: vtkActor | None) -> tuple[Any, float]:
    """Return the ends of a pick's ray and its tolerance at the far one, mm of an actor's data."""
    renderer, (x, y, _) = picker.GetRenderer(), picker.GetSelectionPoint()
    width, height = renderer.GetRenderWindow().GetSize()
    tolerance = picker.GetTolerance() * float(np.hypot(width, height)) + 1.0
    ends = []
    for place in ((x, y, 0.0), (x, y, 1.0), (x + tolerance, y, 1.0)):
        renderer.SetDisplayPoint(*place)
        renderer.DisplayToWorld()
        *world, w = renderer.GetWorldPoint()
        ends.append([*(np.array(world) / w), 1.0])
    matrix = np.eye(4) if actor is None else to_array(actor.GetMatrix())
    start, stop, beside = (np.array(ends) @ np.linalg.inv(matrix).T)[:, :3]
    return np.array([start, stop]), float(np.linalg.norm(beside - stop))


def _end(picker: vtkPicker, _event: str) -> None:
    for reading in _readings(picker):
        reading.end()


class _Picker(vtkPicker):
    def __init__(self) -> None:
        follow(self)


class _PointPicker(vtkPointPicker):
    def __init__(self) -> None:
        follow(self)


class _CellPicker(vtkCellPicker):
    def __init__(self) -> None:
        follow(self)


def _exporter(base: Any) -> Any:
    """Return an exporter around whose writing mappers are readable."""

    def write(self: Any) -> None:
        window = self.GetRenderWindow()
        with nullcontext() if window is None else readable(window):
            base.Write(self)

    return type(base.__name__, (base,), {"Write": write, "Update": write, "__doc__": base.__doc__})


_done: set[str] = set()


def override() -> None:
    """Register this package with the loaded VTK pickers and exporters; a second call has no effect."""
    if not _done:
        pickers: dict[Any, type] = {vtkPicker: _Picker, vtkPointPicker: _PointPicker, vtkCellPicker: _CellPicker}
        for base, ours in pickers.items():
            base.override(ours)
        _done.add("pickers")
    for module, names in EXPORTERS.items():
        if module in sys.modules and module not in _done:
            _done.add(module)
            for name in names:
                base = getattr(sys.modules[module], name, None)
                if base is not None:
                    base.override(_exporter(base))
