"""Streamlines as the line cells of VTK's, with all that they have besides as point, cell and field data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.support.ragged import Array, Floats, Ints
from pvfiblets.support.vtk_space import FIELD, OURS, Space, space_of_dataset, to_ras

if TYPE_CHECKING:
    import pyvista

NOT_LINES = "cells that are not lines"  # why cells were left out, of `dropped`
_GROUP = "groups/"
_PER_GROUP = "per_group/"
_GROUPS_OF = "groups_of"
_EXTRACTED = "vtkOriginalCellIds"
_SPACE = "space/"


def parts_of_polydata(polydata: Any) -> dict[str, Any]:
    """Return the parts of streamlines that :meth:`.Streamlines.from_polydata` makes of a PolyData."""
    import pyvista

    mesh = pyvista.wrap(polydata)
    if not isinstance(mesh, pyvista.PolyData):
        raise ValueError(
            f"expected a PolyData, got {type(polydata).__name__}: use its "
            "extract_surface() or extract_feature_edges() first"
        )
    lines = mesh.GetLines()
    n = lines.GetNumberOfCells()
    offsets = np.array(pyvista.convert_array(lines.GetOffsetsArray()), np.int64)
    if len(offsets) == 0:
        offsets = np.zeros(1, np.int64)
    ids = np.asarray(pyvista.convert_array(lines.GetConnectivityArray()), np.int64)
    first_line = mesh.GetVerts().GetNumberOfCells()
    return parts_of_cells(
        np.array(mesh.points),
        offsets,
        ids,
        {k: np.array(v) for k, v in mesh.point_data.items()},
        {k: np.array(v)[first_line : first_line + n] for k, v in mesh.cell_data.items()},
        other_cells=mesh.GetNumberOfCells() - n,
        field={k: np.array(v) for k, v in mesh.field_data.items()},
        space_name=space_of_dataset(mesh),
    )


def polydata_of(
    points: Floats,
    offsets: Ints,
    point_data: Mapping[str, Array],
    cell_data: Mapping[str, Array],
    field: Mapping[str, Array],
) -> pyvista.PolyData:
    """Return what :meth:`.Streamlines.to_polydata` does."""
    import pyvista

    mesh = pyvista.PolyData()
    mesh.points = np.ascontiguousarray(points)
    cells = pyvista.CellArray.from_arrays(offsets, np.arange(len(points), dtype=np.int64), deep=True)
    mesh.SetLines(cells)
    for data, columns in ((mesh.point_data, point_data), (mesh.cell_data, cell_data)):
        for name, values in columns.items():
            if values.size:  # PyVista has no arrays without rows
                data[name] = np.ascontiguousarray(_vtk_values(values))
    for name, array in field.items():
        mesh.field_data[name] = array
    mesh.field_data[FIELD] = [OURS]
    return mesh


def field_of(
    n_lines: int,
    groups: Mapping[str, Array],
    per_group: Mapping[str, Mapping[str, Array]],
    affine: Array,
    space: Mapping[str, Any],
) -> dict[str, Array]:
    """Return groups, group data, affine and space as flat named arrays; see :meth:`.Streamlines.to_polydata`."""
    field: dict[str, Array] = {_GROUP + k: v for k, v in groups.items()}
    if field:
        field[_GROUPS_OF] = np.array([n_lines])
    for group, values in per_group.items():
        for name, value in values.items():
            field[f"{_PER_GROUP}{group}/{name}"] = np.atleast_1d(_vtk_values(value))
    if not np.array_equal(affine, np.eye(4)):
        field["affine"] = affine
    for name, value in space.items():
        text = np.frombuffer(value.encode(), np.uint8) if isinstance(value, str) else None
        array = np.atleast_1d(np.asarray(value)) if text is None else text
        if array.size and array.dtype.kind in "fiub":
            field[_SPACE + name] = array.astype(np.int64) if array.dtype == bool else array
    return field


def parts_of_cells(
    points: Array,
    offsets: Ints,
    connectivity: Ints,
    point_data: Mapping[str, Array],
    cell_data: Mapping[str, Array],
    *,
    other_cells: int = 0,
    field: Mapping[str, Array] | None = None,
    space_name: Space | None = None,
) -> dict[str, Any]:
    """Return arguments of `Streamlines` of cells that refer to points by index, as VTK stores lines."""
    dropped: dict[str, int] = {}
    if other_cells:
        dropped[NOT_LINES] = other_cells
    n = len(points)
    if len(connectivity) != n or not np.array_equal(connectivity, np.arange(n)):
        used = np.zeros(n, bool)
        used[connectivity] = True
        if unused := n - int(used.sum()):
            dropped["points of no line"] = unused
        points = points[connectivity]
        point_data = {k: v[connectivity] for k, v in point_data.items()}
    points = to_ras(points, space_name)
    groups: dict[str, Array] = {}
    per_group: dict[str, dict[str, Array]] = {}
    affine = None
    space: dict[str, Any] = {}
    for name, array in (field or {}).items():
        if name.startswith(_GROUP):
            groups[name[len(_GROUP) :]] = array
        elif name.startswith(_PER_GROUP) and name.count("/") >= 2:
            group, key = name[len(_PER_GROUP) :].split("/", 1)
            per_group.setdefault(group, {})[key] = array
        elif name == "affine" and array.size == 16:
            affine = array.reshape(4, 4)
        elif name.startswith(_SPACE) and array.size:
            space[name[len(_SPACE) :]] = _space_value(array)
    if groups and _are_of_others(len(offsets) - 1, field or {}, cell_data):
        dropped["groups of other lines"] = len(groups)
        groups, per_group = {}, {}
    return {
        "points": points, "offsets": offsets, "per_point": point_data, "per_streamline": cell_data, "groups": groups,
        "per_group": per_group, "affine": affine, "space": space, "dropped": dropped,
    }  # fmt: skip


def _are_of_others(n_lines: int, field: Mapping[str, Array], cell_data: Mapping[str, Array]) -> bool:
    """Whether groups number the lines of what a filter took these lines from: filters pass field data on as it is."""
    of = field.get(_GROUPS_OF)
    return _EXTRACTED in cell_data if of is None or not of.size else int(of.flat[0]) != n_lines


def _space_value(array: Array) -> Any:
    """Return the value that :meth:`Streamlines.field_data` made an array of."""
    if array.dtype == np.uint8:
        return array.tobytes().decode("utf-8", "replace")
    values = tuple(array.ravel().tolist())
    return values[0] if len(values) == 1 else values


def _vtk_values(values: Array) -> Array:
    """VTK has no half precision and no boolean type of one byte that it writes to files."""
    if values.dtype == np.float16:
        return values.astype(np.float32)
    return values.astype(np.uint8) if values.dtype == bool else values
