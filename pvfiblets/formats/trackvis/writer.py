"""Writing trk files: the mirror of :mod:`pvfiblets.formats.trackvis.trk`."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pvfiblets.formats.mapped import forget
from pvfiblets.formats.rounding import largest_change, warn_of_changes
from pvfiblets.formats.rows import transformed
from pvfiblets.formats.trackvis.header import trackvis_to_ras, unrecorded_affine
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.whole_files import replacing

Array = NDArray[Any]

_BLOCK_POINTS = 1 << 20


def write(path: str | PathLike[str], streamlines: Streamlines) -> None:
    """Write a trk file, version 2, little-endian (see :func:`pvfiblets.formats.write`)."""
    # The format holds float32 only. `affine` and `space` give the geometry; what `space` lacks follows from the affine.
    # An affine that was not recorded where the streamlines come from is not recorded here either.
    header, from_ras = _header(streamlines)
    points = _columns(streamlines.per_point, "per_point")
    values = _columns(streamlines.per_streamline, "per_streamline")
    header["scalar_name"], n_scalars = _name_table(points, "per_point")
    header["property_name"], n_properties = _name_table(values, "per_streamline")
    header["nb_scalars_per_point"] = n_scalars
    header["nb_properties_per_streamline"] = n_properties
    if len(streamlines) > 2**31 - 1 or (n := int(streamlines.counts.max(initial=0))) > 2**31 - 1:
        raise ValueError(
            f"{len(streamlines)} streamlines, or {n} points in one, exceed the format's 32 bits; write .trx"
        )
    header["nb_streamlines"] = len(streamlines)
    size = len(header.tobytes()) + 4 * (len(streamlines) * (1 + n_properties) + streamlines.n_points * (3 + n_scalars))
    with replacing(path, size) as file:
        file.write(header.tobytes())
        for start, stop in streamlines.blocks(_BLOCK_POINTS):
            file.write(_records(streamlines, from_ras, points, values, start, stop).data)
            for array in (streamlines.points, *points.values()):
                forget(array, 0, int(streamlines.offsets[stop]))
            for array in values.values():
                forget(array, 0, stop)
    if n_properties and (empty := int((streamlines.counts == 0).sum())):
        warnings.warn(
            f"{path}: {empty} streamlines have no points, and nibabel and DIPY refuse a .trk file with these and "
            "values per streamline; write streamlines[streamlines.counts > 0], or .trx",
            UserWarning,
            stacklevel=3,
        )
    fix = ".trx keeps them, or subtract an offset first"
    warn_of_changes(path, _moved(streamlines, from_ras), {**streamlines.per_point, **streamlines.per_streamline}, fix)


def _moved(streamlines: Streamlines, from_ras: NDArray[np.float64]) -> float:
    """Return by how much the file's float32 moves float64 points at most, mm."""
    if streamlines.points.dtype != np.float64:
        return 0.0
    most = 0.0
    for first in range(0, streamlines.n_points, _BLOCK_POINTS):
        last = min(first + _BLOCK_POINTS, streamlines.n_points)
        most = max(most, largest_change(streamlines.points[first:last] @ from_ras[:3, :3].T + from_ras[:3, 3]))
        forget(streamlines.points, 0, last)
    return most


def _header(streamlines: Streamlines) -> tuple[Any, Array]:
    """Make the header record and the matrix from RAS+ mm to the file's coordinates."""
    from nibabel.orientations import aff2axcodes
    from nibabel.streamlines.trk import TrkFile, header_2_dtype

    space, affine = streamlines.space, streamlines.affine.astype(np.float32).astype(np.float64)
    axes = aff2axcodes(affine)
    if None in axes or np.linalg.det(affine[:3, :3]) == 0:
        raise ValueError(f"the affine {affine.tolist()} has no inverse; give a voxel-to-RAS matrix")
    header = np.zeros((), header_2_dtype.newbyteorder("<"))
    for name, value in TrkFile.create_empty_header(endianness="little").items():
        header[name] = value
    sizes = np.asarray(space.get("voxel_sizes", np.sqrt((affine[:3, :3] ** 2).sum(axis=0))))
    if sizes.shape != (3,) or not (np.isfinite(sizes).all() and (sizes > 0).all()):
        raise ValueError(f"space['voxel_sizes'] is {sizes.tolist()}; three positive numbers (mm) are needed")
    header["voxel_sizes"] = sizes
    dimensions = np.asarray(space.get("dimensions", (1, 1, 1)))
    if dimensions.shape != (3,) or (dimensions > 32767).any() or (dimensions < 0).any():
        raise ValueError(f"dimensions {dimensions.tolist()} exceed the format's three numbers of 0 to 32767")
    header["dimensions"] = dimensions
    voxel_order = space.get("voxel_order", "".join(axes))
    header["voxel_order"] = voxel_order.encode("ascii")
    header["image_orientation_patient"] = space.get("image_orientation_patient", 0.0)
    header["pad2"] = space.get("original_voxel_order", "").encode("latin-1")
    recorded = space.get("affine_recorded", True) or not np.array_equal(affine, unrecorded_affine(sizes, voxel_order))
    header["voxel_to_rasmm"] = affine if recorded else 0.0
    # From the header's own rounded numbers: a reader has nothing else to go by.
    to_ras = trackvis_to_ras(header["voxel_sizes"].astype(np.float64), dimensions, voxel_order, affine)
    return header, np.linalg.inv(to_ras)


def _columns(arrays: Mapping[str, Array], title: str) -> dict[str, Array]:
    """Return two-dimensional views of the arrays, checked to fit float32."""
    columns = {}
    for name, array in arrays.items():
        if array.dtype.kind not in "fiub":
            raise ValueError(f"{title}[{name!r}] is {array.dtype}; a trk file holds numbers only")
        if array.dtype.kind in "iu" and array.dtype.itemsize > 2 and array.size:
            extreme = max(abs(int(array.max())), abs(int(array.min())))
            if extreme > 2**24 and not np.array_equal(array.astype(np.float32), array):
                raise ValueError(
                    f"{title}[{name!r}] has integers up to {extreme}, which the format's float32 "
                    "cannot hold exactly; write .trx or convert them to floats"
                )
        columns[name] = (
            array.reshape(len(array), -1) if array.size else array.reshape(len(array), int(np.prod(array.shape[1:])))
        )
    return columns


def _name_table(columns: Mapping[str, Array], title: str) -> tuple[Array, int]:
    from nibabel.streamlines.trk import encode_value_in_name

    if len(columns) > 10:
        raise ValueError(f"{title} has {len(columns)} arrays, a trk file holds at most 10; remove some or write .trx")
    table = np.zeros(10, "S20")
    for i, (name, array) in enumerate(columns.items()):
        try:
            table[i] = encode_value_in_name(array.shape[1], name)
        except (ValueError, UnicodeEncodeError) as error:
            raise ValueError(f"{title}[{name!r}] cannot be a name in a trk file: {error}") from error
    total = sum(a.shape[1] for a in columns.values())
    if total > 32767:
        raise ValueError(f"{title} has {total} columns, a trk file holds at most 32767")
    return table, total


def _records(
    streamlines: Streamlines,
    from_ras: NDArray[np.float64],
    points: Mapping[str, Array],
    values: Mapping[str, Array],
    start: int,
    stop: int,
) -> Array:
    """Lay out the records of some streamlines as one array of 4-byte words."""
    edges = streamlines.offsets[start : stop + 1]
    first, last = int(edges[0]), int(edges[-1])
    moved = transformed(streamlines.points[first:last], from_ras)
    rows = np.concatenate([moved, *(a[first:last].astype(np.float32) for a in points.values())], axis=1)
    properties = [a[start:stop].astype(np.float32) for a in values.values()]
    tail = np.concatenate([np.zeros((stop - start, 0), np.float32), *properties], axis=1)
    counts = np.diff(edges)
    sizes = 1 + counts * rows.shape[1] + tail.shape[1]
    ends = np.cumsum(sizes)
    heads = ends - sizes
    words = np.empty(int(ends[-1]), "<f4")
    is_row = np.ones(len(words), bool)
    is_row[heads] = False
    tails = (ends - tail.shape[1])[:, None] + np.arange(tail.shape[1])
    is_row[tails] = False
    words.view("<i4")[heads] = counts
    words[tails] = tail
    words[is_row] = rows.ravel()
    return words
