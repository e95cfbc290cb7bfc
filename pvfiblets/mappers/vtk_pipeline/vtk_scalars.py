"""The array of its input that colours a mapper, by the settings that every ``vtkMapper`` has.

``ScalarVisibility``, ``ScalarMode``, ``SelectColorArray``, ``ColorMode``, ``LookupTable``, ``ScalarRange`` and
``UseLookupTableScalarRange`` mean the same as in VTK. Numbers at points are interpolated along a line before they
are mapped, as with ``InterpolateScalarsBeforeMapping``. Colours of whole lines are mapped by VTK itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR, reference, vtkLookupTable
from vtkmodules.vtkRenderingCore import vtkAbstractMapper

from pvfiblets.mappers.colouring import Colouring

DEFAULT, DIRECT = 0, 2  # VTK_COLOR_MODE_DEFAULT, VTK_COLOR_MODE_DIRECT_SCALARS
POINTS, CELLS = 0, 1  # what GetAbstractScalars says of an array
MAGNITUDE = 0  # vtkScalarsToColors::MAGNITUDE
ENTRIES = 1024  # colours that are taken of a colour map that is no table
MOST_LABELS = 65536

Bytes = npt.NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Paint:
    """The colours of lines, or of an image."""

    name: str  # of the array
    numbers: npt.NDArray[np.float64] | None = None  # `(n_points,)` float64, which `table` maps
    table: Any = None  # `lut`, `clim` and the other arguments of a `Colouring` that maps numbers
    point_colours: Bytes | None = None  # `(n, 4)` uint8 RGBA of each point, or of each cell
    cell_colours: Bytes | None = None

    def mapped(self, source: str) -> Colouring:
        """Return the colours of numbers that are stored under a name."""
        return Colouring("point_scalar", source=source, **self.table)

    def of_lines(self, first: int, count: int) -> Colouring:
        """Return the colours of so many cells, the lines among a PolyData's cells."""
        assert self.cell_colours is not None
        return Colouring("streamline_rgba", values=self.cell_colours[first : first + count])


def scalars_of(mapper: Any, data: Any) -> tuple[Any, int] | None:
    """Return the array that colours, and whether it is of points (0) or cells (1); None for the property's colour."""
    if not mapper.GetScalarVisibility():
        return None
    kind: Any = reference(POINTS)
    array = vtkAbstractMapper.GetAbstractScalars(
        data, mapper.GetScalarMode(), mapper.GetArrayAccessMode(), mapper.GetArrayId(), mapper.GetArrayName(), kind
    )
    return None if array is None else (array, int(kind))


def state_of(mapper: Any, data: Any) -> tuple[Any, ...]:
    """Return what colours depend on beside the data: another value wants other colours."""
    found = scalars_of(mapper, data)
    if found is None:
        return ()
    array, table = found[0], mapper.GetLookupTable()
    # Times are never the same of two objects.
    times = array.GetMTime(), table.GetMTime()
    clim = mapper.GetUseLookupTableScalarRange() or mapper.GetScalarRange()
    return *times, found[1], mapper.GetColorMode(), mapper.GetArrayComponent(), clim


def paint_of(mapper: Any, data: Any) -> Paint | None:
    """Return what colours some data; None for the property's colour."""
    found = scalars_of(mapper, data)
    if found is None:
        return None
    array, kind = found
    name = array.GetName() or "scalars"
    if kind not in (POINTS, CELLS) or not array.IsA("vtkDataArray"):
        what = "an array of words" if kind in (POINTS, CELLS) else "field data"
        raise ValueError(f"{name!r} is {what}, which cannot colour lines; choose numbers of points or cells")
    table = _table_of(mapper, array)
    direct = mapper.GetColorMode() == DIRECT or (
        mapper.GetColorMode() == DEFAULT and array.GetDataType() == VTK_UNSIGNED_CHAR
    )
    if direct or kind == CELLS:
        mapped = table.MapScalars(array, mapper.GetColorMode(), mapper.GetArrayComponent(), 4)
        colours = np.array(vtk_to_numpy(mapped))
        return Paint(name, **{"point_colours" if kind == POINTS else "cell_colours": colours})
    return Paint(name, _numbers(mapper, table, array), _entries(table))


def _table_of(mapper: Any, array: Any) -> Any:
    """Return the look-up table, with the mapper's range for it."""
    own = array.GetLookupTable() if array.IsA("vtkDataArray") else None
    if own is not None:
        mapper.SetLookupTable(own)
    table = mapper.GetLookupTable()
    if not mapper.GetUseLookupTableScalarRange() and tuple(table.GetRange()) != tuple(mapper.GetScalarRange()):
        table.SetRange(mapper.GetScalarRange())  # as vtkMapper does: scalar bars show it
    table.Build()
    return table


def _numbers(mapper: Any, table: Any, array: Any) -> npt.NDArray[np.float64]:
    """Return one number per point, of vectors the component that the mapper or the look-up table takes, or a length."""
    values = vtk_to_numpy(array).astype(np.float64)
    if values.ndim == 1:
        return values
    component, size = mapper.GetArrayComponent(), table.GetVectorSize()
    if component < 0 and table.GetVectorMode() == MAGNITUDE:
        first = max(table.GetVectorComponent(), 0) if size > 0 else 0
        return np.asarray(np.linalg.norm(values[:, first : first + size if size > 0 else None], axis=1))
    component = table.GetVectorComponent() if component < 0 else component
    return values[:, min(max(component, 0), values.shape[1] - 1)]


def _entries(table: Any) -> dict[str, Any]:
    """Return a look-up table as the arguments of a `Colouring`."""
    if table.GetIndexedLookup():
        return _labels(table)
    low, high = table.GetRange()
    log = bool(table.UsingLogScale())
    if log and low <= 0.0:
        log = False  # VTK moves such a range, or maps it linearly
    if isinstance(table, vtkLookupTable):
        lut = np.array(vtk_to_numpy(table.GetTable()))
        below = table.GetBelowRangeColor() if table.GetUseBelowRangeColor() else None
        above = table.GetAboveRangeColor() if table.GetUseAboveRangeColor() else None
        return {
            "lut": lut, "clim": (low, high), "log_scale": log, "nan_color": _parts(table.GetNanColor()),
            "below_color": below, "above_color": above,
        }  # fmt: skip
    middles = (np.arange(ENTRIES) + 0.5) / ENTRIES
    places = low * (high / low) ** middles if log else low + (high - low) * middles
    span = high - low or 1.0
    colours = _mapped(table, np.concatenate([places, [low - span, high + span, np.nan]]))
    ends = (colours[ENTRIES:] / 255.0).tolist()
    return {
        "lut": colours[:ENTRIES], "clim": (low, high), "log_scale": log,
        "below_color": ends[0], "above_color": ends[1], "nan_color": ends[2],
    }  # fmt: skip


def _labels(table: Any) -> dict[str, Any]:
    """Return a map of labels, whole numbers, as a table with an entry for each from the least to the greatest."""
    known = [table.GetAnnotatedValue(index) for index in range(table.GetNumberOfAnnotatedValues())]
    numbers = np.array([value.ToDouble() for value in known])
    if not len(numbers) or (numbers != np.round(numbers)).any() or np.ptp(numbers) >= MOST_LABELS:
        raise ValueError(
            f"the look-up table has IndexedLookup and the labels {numbers.tolist()[:5]}; numbers at points want whole "
            f"ones, fewer than {MOST_LABELS} apart: give the array to the cells, or switch IndexedLookup off"
        )
    low, high = numbers.min(), numbers.max()
    colours = _mapped(table, np.arange(low, high + 1.0))
    other = _parts(table.GetNanColor())
    return {
        "lut": colours, "clim": (low - 0.5, high + 0.5), "nan_color": other, "below_color": other, "above_color": other,
    }  # fmt: skip


def _mapped(table: Any, numbers: npt.NDArray[np.float64]) -> Bytes:
    return np.array(vtk_to_numpy(table.MapScalars(numpy_to_vtk(numbers, deep=True), 1, 0, 4)))


def _parts(colour: Any) -> tuple[float, ...]:
    return tuple(min(max(float(part), 0.0), 1.0) for part in colour)
