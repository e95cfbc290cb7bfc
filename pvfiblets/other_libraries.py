"""Streamlines from the objects of other libraries: nibabel, dipy, trx-python, and VTK's datasets other than PolyData.

None of them is imported: objects are recognised by their attributes. Coordinates become RAS+ millimetres with voxel
centres at integer indices, for objects with a position.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.line_cells import NOT_LINES
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.ragged import offsets_from_counts
from pvfiblets.support.vtk_space import Space, space_of_dataset, to_ras

EXPECTED = (
    "a path, FibletSet, Streamlines, PolyData with lines, MultiBlock or UnstructuredGrid of them, a Tractogram or "
    "tractogram file of nibabel, a StatefulTractogram or Streamlines of dipy, a TrxFile, or a list of (n, 3) arrays"
)

_LINES = (3, 4)  # VTK_LINE, VTK_POLY_LINE


def streamlines_of(source: Any) -> Streamlines | None:
    """Return the streamlines that an object of another library holds, with its data; None if it is of no known kind."""
    if isinstance(source, Streamlines):
        return source
    if hasattr(source, "IsA"):
        return _of_vtk(source)
    if hasattr(source, "to_rasmm") and hasattr(source, "voxel_order"):  # dipy's StatefulTractogram
        moved = copy.deepcopy(source)
        moved.to_rasmm()
        moved.to_center()
        return _sequences(
            moved.streamlines, moved.data_per_point, moved.data_per_streamline, affine=moved.affine,
            space=_space(moved.dimensions, moved.voxel_sizes, moved.voxel_order),
        )  # fmt: skip
    if hasattr(source, "data_per_vertex") and hasattr(source, "groups"):  # trx-python's TrxFile
        header = source.header
        return _sequences(
            source.streamlines, source.data_per_vertex, source.data_per_streamline, affine=header["VOXEL_TO_RASMM"],
            space={"dimensions": tuple(int(n) for n in header["DIMENSIONS"])},
            groups={name: np.asarray(ids, np.int64) for name, ids in source.groups.items()},
            per_group={
                group: {name: np.array(values).reshape(-1) for name, values in arrays.items()}
                for group, arrays in source.data_per_group.items()
            },
        )  # fmt: skip
    if hasattr(source, "tractogram") and hasattr(source, "header"):  # nibabel's TrkFile, TckFile
        found = _of_tractogram(source.tractogram)
        header = source.header if isinstance(source.header, Mapping) else {}
        # In a tck file these are strings of the program that wrote it.
        if not any(isinstance(header.get(name, ""), str) for name in ("dimensions", "voxel_sizes")):
            found.space = _space(header["dimensions"], header["voxel_sizes"], header.get("voxel_order", b""))
            found.affine = np.asarray(source.affine, np.float64)
        return found
    if hasattr(source, "affine_to_rasmm") and hasattr(source, "streamlines"):
        return _of_tractogram(source)
    if hasattr(source, "get_data") and hasattr(source, "total_nb_rows"):
        return _sequences(source)
    return None


def _space(dimensions: Any, sizes: Any, order: Any) -> dict[str, Any]:
    order = order.decode() if isinstance(order, bytes) else str(order)
    return {
        "dimensions": tuple(int(n) for n in dimensions),
        "voxel_sizes": tuple(float(n) for n in sizes),
        "voxel_order": order or "RAS",
    }


def _of_tractogram(tractogram: Any) -> Streamlines:
    """Convert nibabel's Tractogram, whole or lazy."""
    affine = tractogram.affine_to_rasmm
    if affine is None:
        raise ValueError(
            "the tractogram's affine_to_rasmm is None, so the position of its points is unknown; set it, "
            "numpy.eye(4) if they are in RAS+ mm"
        )
    if all(hasattr(held, "get_data") for held in (tractogram.streamlines, *tractogram.data_per_point.values())):
        found = _sequences(tractogram.streamlines, tractogram.data_per_point, tractogram.data_per_streamline)
    else:
        found = _of_generators(tractogram)
    affine = np.asarray(affine, np.float64)
    if not np.array_equal(affine, np.eye(4)):
        kind = found.points.dtype
        found.points = (found.points.astype(np.float64) @ affine[:3, :3].T + affine[:3, 3]).astype(kind)
    return found


def _of_generators(tractogram: Any) -> Streamlines:
    """Convert a lazy tractogram, whose `streamlines` have its pending affine applied and whose items may lack it."""
    return Streamlines.from_list(
        [np.asarray(line) for line in tractogram.streamlines],
        per_point=_joined(tractogram.data_per_point, np.concatenate),
        per_streamline=_joined(tractogram.data_per_streamline, np.stack),
    )


def _joined(columns: Mapping[str, Any], join: Callable[[Any], npt.NDArray[Any]]) -> dict[str, npt.NDArray[Any]]:
    rows = {name: [np.asarray(values) for values in parts] for name, parts in columns.items()}
    return {name: _flat(join(parts)) for name, parts in rows.items() if parts}


def _sequences(
    lines: Any, per_point: Mapping[str, Any] | None = None, per_streamline: Mapping[str, Any] | None = None, **rest: Any
) -> Streamlines:
    """Convert nibabel's ArraySequence of points, one of each value per point, and arrays per streamline."""
    counts = np.fromiter((len(line) for line in lines), np.int64, count=len(lines))
    points = np.asarray(lines.get_data()).reshape(-1, 3)
    return Streamlines(
        np.array(points),  # the object may be changed later, and ours must not
        offsets_from_counts(counts),
        {name: _flat(np.array(values.get_data())) for name, values in (per_point or {}).items()},
        {name: _flat(np.array(values)) for name, values in (per_streamline or {}).items()},
        **rest,
    )


def _flat(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Columns of one number as an array of numbers."""
    return values.reshape(len(values)) if values.ndim == 2 and values.shape[1] == 1 else values


def _of_vtk(source: Any) -> Streamlines:
    import pyvista as pv

    if source.IsA("vtkPartitionedDataSet"):
        return Streamlines.concatenate(map(_of_vtk, _partitions(source)))
    if _has_blocks(source):
        return _of_blocks(source)
    dataset = pv.wrap(source)
    if isinstance(dataset, pv.PolyData):
        return Streamlines.from_polydata(dataset)
    if isinstance(dataset, pv.UnstructuredGrid):
        found = Streamlines.from_polydata(lines_of_grid(dataset))
        if others := dataset.n_cells - len(found):
            found.dropped[NOT_LINES] = others
        return found
    raise TypeError(
        f"source is a {type(dataset).__name__}, which has no lines; of VTK's datasets PolyData, UnstructuredGrid, "
        "MultiBlock and partitioned ones hold some; extract_all_edges() makes lines of a dataset's edges"
    )


def _has_blocks(source: Any) -> bool:
    return bool(source.IsA("vtkMultiBlockDataSet") or source.IsA("vtkPartitionedDataSetCollection"))


def _partitions(source: Any) -> list[Any]:
    return [part for i in range(source.GetNumberOfPartitions()) if (part := source.GetPartition(i)) is not None]


def _named_blocks(source: Any) -> list[tuple[str, Any]]:
    """Return the blocks of a MultiBlock or a collection of partitioned datasets with their names."""
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet

    collection = source.IsA("vtkPartitionedDataSetCollection")
    number = source.GetNumberOfPartitionedDataSets() if collection else source.GetNumberOfBlocks()
    found = []
    for i in range(number):
        name = source.GetMetaData(i).Get(vtkCompositeDataSet.NAME()) if source.HasMetaData(i) else None
        found.append((name or f"block {i}", source.GetPartitionedDataSet(i) if collection else source.GetBlock(i)))
    return found


def _of_blocks(blocks: Any, space: Space | None = None) -> Streamlines:
    """Convert the blocks of a MultiBlock: their names are groups; arrays that some of them lack are dropped."""
    space = space_of_dataset(blocks) or space  # of blocks that name none
    parts: list[Streamlines] = []
    named = [(name, block) for name, block in _named_blocks(blocks) if block is not None]
    taken = {name for name, _ in named}
    for name, block in named:
        if _has_blocks(block):
            part = _of_blocks(block, space)
            # Blocks of it may be called as others are.
            part.groups = {f"{name}/{g}" if g in taken else g: ids for g, ids in part.groups.items()}
            taken |= part.groups.keys()
        elif block.GetNumberOfPoints():
            part = _of_vtk(block)
            if space_of_dataset(block) is None:
                part.points = to_ras(part.points, space)
        else:
            continue
        if len(part):
            part.groups[name] = np.arange(len(part))
        parts.append(part)
    dropped: set[str] = set()
    full = [part for part in parts if len(part)]
    for held in ("per_point", "per_streamline"):
        names = [set(getattr(part, held)) for part in full]
        common = set.intersection(*names) if names else set()
        dropped |= set().union(*names) - common
        for part in full:
            setattr(part, held, {name: values for name, values in getattr(part, held).items() if name in common})
    whole = Streamlines.concatenate(parts)
    if dropped:
        whole.dropped[f"arrays that some blocks lack ({', '.join(sorted(dropped))})"] = len(dropped)
    return whole


def lines_of_grid(source: Any) -> Any:
    """Return a PolyData of an UnstructuredGrid's line cells, with their data; anything else as it is."""
    if not source.IsA("vtkUnstructuredGrid"):
        return source
    import pyvista as pv

    grid = pv.wrap(source)
    wanted = np.flatnonzero(np.isin(grid.celltypes, _LINES))
    cells = grid.GetCells()
    starts = np.array(pv.convert_array(cells.GetOffsetsArray()), np.int64)
    ids = np.array(pv.convert_array(cells.GetConnectivityArray()), np.int64)
    counts = np.diff(starts)[wanted]
    offsets = offsets_from_counts(counts)
    rows = np.arange(offsets[-1]) - np.repeat(offsets[:-1] - starts[wanted], counts)
    mesh = pv.PolyData(np.array(grid.points), lines=np.insert(ids[rows], offsets[:-1], counts))
    for name, values in grid.point_data.items():
        mesh.point_data[name] = np.array(values)
    if len(wanted):  # PyVista has no arrays without rows
        for name, values in grid.cell_data.items():
            mesh.cell_data[name] = np.array(values)[wanted]
    for name, values in grid.field_data.items():
        mesh.field_data[name] = np.array(values)  # groups, which number the lines
    return mesh
