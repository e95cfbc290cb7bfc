"""The mappers' data from the PolyData of VTK's pipeline, in the colours that ``vtkMapper`` is set to."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.vtk_pipeline.vtk_scalars import Paint, paint_of

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
    from pvfiblets.tubes.spline_tubes import SplineTubes

POINT_BITS = 16  # a scalar range may be a small part of what the numbers range over
COLOURS = "colours"


def geometry_of(data: Any) -> tuple[Any, ...]:
    """Return what says whether two PolyData have the same lines: when their arrays were changed, never at one time."""
    if not isinstance(data, vtkPolyData) or data.GetPoints() is None:
        return (data.GetMTime(),)
    lines = data.GetLines()
    arrays = data.GetPoints().GetData(), lines.GetOffsetsArray(), lines.GetConnectivityArray()
    return tuple(array.GetMTime() for array in arrays)


def fiblets_of(data: Any, compression: Mapping[str, Any]) -> FibletSet:
    """Compress the lines of a PolyData, each cell as a streamline."""
    from pvfiblets.codec.encoding.compress import compress
    from pvfiblets.streamlines import Streamlines

    points, ids, offsets = _lines_of(data, "fiblets")
    return compress(Streamlines(points[ids], offsets), **compression)


def painted_fiblets(fiblets: FibletSet, data: Any, mapper: Any) -> tuple[FibletSet, Colouring]:
    """Return fiblets that were made of some data, with the numbers that colour them, and their colours."""
    paint = paint_of(mapper, data)
    if paint is None:
        return fiblets, _plain(mapper)
    if paint.cell_colours is not None:
        return fiblets, _of_cells(paint, data)
    from pvfiblets.codec.editing.point_arrays import with_point_colours, with_point_values

    _, ids, _ = _lines_of(data, "fiblets")
    if paint.point_colours is not None:
        clear = bool((paint.point_colours[:, 3] < 255).any())
        rows = paint.point_colours[ids][:, : 4 if clear else 3]
        colouring = Colouring("point_packed", source=paint.name, has_alpha=clear)
        return with_point_colours(fiblets, paint.name, rows), colouring
    assert paint.numbers is not None  # of a paint's three there is one
    return with_point_values(fiblets, paint.name, paint.numbers[ids], POINT_BITS), paint.mapped(paint.name)


def painted_tubes(data: Any, shape: Mapping[str, Any], mapper: Any) -> tuple[SplineTubes, Colouring]:
    """Return tubes around the lines of a PolyData, and their colours."""
    from pvfiblets.tubes.build import as_spline_tubes

    _lines_of(data, "tubes")
    paint = paint_of(mapper, data) if mapper._follows else None  # noqa: SLF001  its other half
    if not mapper._follows:  # noqa: SLF001
        return as_spline_tubes(data, **shape), mapper.colouring
    if paint is None:
        return as_spline_tubes(data, **shape), _plain(mapper)
    if paint.cell_colours is not None:
        return as_spline_tubes(data, **shape), _of_cells(paint, data)
    at_points = paint.numbers if paint.numbers is not None else paint.point_colours
    tubes = as_spline_tubes(data, scalars=at_points, **shape)
    return tubes, paint.mapped("scalars") if paint.numbers is not None else _of_points(paint)


def painted_halos(data: Any, mapper: Any) -> tuple[HaloLines | HaloPoints, Colouring]:
    """Return the lines of a PolyData, or where it has none its points, for halos, and their colours."""
    from pvfiblets.halos.build import as_halo_lines, as_halo_points

    _check_kind(data, "lines with halos")
    lines = data.GetNumberOfLines() > 0
    paint = paint_of(mapper, data) if mapper._follows else None  # noqa: SLF001  its other half
    colouring = mapper.colouring if not mapper._follows else _plain(mapper)  # noqa: SLF001
    if paint is None:
        return (as_halo_lines(data).lines if lines else as_halo_points(data)), colouring
    given: Any = paint.numbers if paint.numbers is not None else paint.point_colours
    if paint.cell_colours is not None:
        first, count = _line_cells(data) if lines else (0, data.GetNumberOfPoints())
        given = paint.cell_colours[first : first + count]
        if not lines and data.GetNumberOfVerts() != data.GetNumberOfPoints():
            raise ValueError(f"{paint.name!r} colours cells, but there are no lines; colour points by data of points")
    if not lines:
        drawn: HaloLines | HaloPoints = as_halo_points(data, scalars=given)
    else:
        drawn, of_lines = as_halo_lines(data, scalars=given)
        if of_lines:
            return drawn, _of_cells(paint, data)
    return drawn, paint.mapped("scalars") if paint.numbers is not None else _of_points(paint)


def measured_look(drawn: HaloLines | HaloPoints) -> HaloStyle:
    """Return widths that suit lines or points with halos."""
    from pvfiblets.halos import HaloStyle
    from pvfiblets.halos.spacing import default_widths

    return HaloStyle(*default_widths(drawn))


def _plain(mapper: Any) -> Colouring:
    return Colouring("solid", color=mapper._property_color())  # noqa: SLF001  its other half


def _of_cells(paint: Paint, data: Any) -> Colouring:
    return paint.of_lines(*_line_cells(data))


def _of_points(paint: Paint) -> Colouring:
    colours = paint.point_colours if paint.point_colours is not None else paint.cell_colours
    assert colours is not None
    return Colouring("point_rgba", source="scalars", has_alpha=bool((colours[:, 3] < 255).any()))


def _line_cells(data: Any) -> tuple[int, int]:
    """Return the number of cells before the lines, and of lines."""
    return data.GetNumberOfVerts(), data.GetNumberOfLines()


def _check_kind(data: Any, noun: str) -> None:
    if not isinstance(data, vtkPolyData):
        raise TypeError(
            f"{noun} cannot be made of a {type(data).__name__}; connect PolyData: a vtkGeometryFilter makes it of "
            "grids, a vtkCompositeDataGeometryFilter of blocks"
        )


def _lines_of(data: Any, noun: str) -> tuple[npt.NDArray[Any], npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return the points of a PolyData, the point numbers of its lines, and the start of each line."""
    _check_kind(data, noun)
    lines = data.GetLines()
    if not lines.GetNumberOfCells():
        if data.GetNumberOfCells():
            raise ValueError(
                f"the PolyData has no lines but {data.GetNumberOfCells():,} other cells (vertices, polygons, strips); "
                "connect lines, such as vtkExtractEdges or vtkStreamTracer makes"
            )
        return np.zeros((0, 3)), np.zeros(0, np.int64), np.zeros(1, np.int64)
    points = np.array(vtk_to_numpy(data.GetPoints().GetData()))  # a copy: VTK may move its own memory at any time
    ids, offsets = (
        vtk_to_numpy(array).astype(np.int64) for array in (lines.GetConnectivityArray(), lines.GetOffsetsArray())
    )
    if len(ids) and (ids.min() < 0 or ids.max() >= len(points)):
        raise ValueError(f"lines refer to points {ids.min()} to {ids.max()}, but the PolyData has {len(points)} points")
    return points, ids, offsets
