"""DSI Studio's TinyTrack (``.tt.gz``): a gzipped MATLAB 4 file; read only.

The layout, as DSI Studio's author gave it to its users
(https://groups.google.com/g/dsi-studio/c/3Y_lIRLWXTs) and as trx-rs reads it: matrices
``dimension``, ``voxel_size``, ``trans_to_mni`` (4 x 4, by rows, voxel to mm) and byte matrices
``track`` (or ``track0``, ``track1``, ...). These hold one record per streamline, little-endian: a
uint32 number of coordinates, three int32 for the first point, then one int8 per further
coordinate, the difference to the same coordinate of the point before; all in 1/32 voxel.
``cluster`` (one number per streamline) becomes groups, named after the lines of the text file
beside it where there is one; ``color`` (0xRRGGBB per cluster) becomes the groups' ``color``.

The file is inflated whole. A damaged matrix or record is a FormatError at its byte (of the
inflated data); matrices that mean nothing to us are left out and counted.
"""

from __future__ import annotations

import gzip
import struct
from array import array
from collections.abc import Iterator
from os import PathLike, fspath
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvfiblets.errors import FormatError
from pvfiblets.formats.gzipped import check_swelling, inflate
from pvfiblets.formats.read_whole import facts, pieces
from pvfiblets.formats.rows import finite, transformed
from pvfiblets.streamlines import Streamlines

Array = NDArray[Any]

UNKNOWN = "matrices of unknown meaning"

_TYPES = ("f8", "f4", "i4", "i2", "u2", "u1")  # MATLAB 4's types by the tens digit of a matrix' type number

_SUBVOXEL = 32
_HEAD = 16  # bytes of a record before its differences


class _Matrix(NamedTuple):
    position: int
    values: Array


def _matrices(path: str, data: bytes) -> dict[str, _Matrix]:
    """Split a MATLAB 4 file into its matrices."""
    found: dict[str, _Matrix] = {}
    at = 0
    while at < len(data):
        if at + 20 > len(data):
            raise FormatError(path, len(data), "the end of the data", "a matrix header of 20 bytes")
        kind, rows, columns, imaginary, name_size = struct.unpack_from("<5i", data, at)
        tens = kind // 10 % 10
        if not 0 <= kind < 100 or tens >= len(_TYPES) or kind % 10 or imaginary:
            raise FormatError(path, at, f"matrix type {kind}", "a real little-endian full matrix")
        if rows < 0 or columns < 0 or not 0 < name_size <= 256:
            raise FormatError(
                path, at, f"a matrix of {rows} x {columns}, name of {name_size} bytes",
                "sizes from 0, a name of 1 to 256 bytes",
            )  # fmt: skip
        dtype = np.dtype("<" + _TYPES[tens])
        begin = at + 20 + name_size
        end = begin + rows * columns * dtype.itemsize
        name = data[at + 20 : begin].split(b"\0")[0].decode("latin-1")
        if end > len(data):
            raise FormatError(
                path, len(data), "the end of the data",
                f"matrix {name!r} up to byte {end}: the file is truncated",
            )  # fmt: skip
        found[name] = _Matrix(begin, np.frombuffer(data, dtype, rows * columns, begin))
        at = end
    return found


def _records(path: str, track: _Matrix) -> tuple[Array, NDArray[np.int64]]:
    """Decode the records of a track matrix: points in 1/32 voxel, and points per streamline."""
    data = np.ascontiguousarray(track.values).data
    starts, counts = array("q"), array("q")
    at = 0
    while at < len(data):
        # Each count tells where the next record begins: sequential by nature.
        if at + _HEAD > len(data):
            raise FormatError(
                path, track.position + len(data), "the end of the track matrix",
                f"a record of at least {_HEAD} bytes from byte {track.position + at}",
            )  # fmt: skip
        (n,) = struct.unpack_from("<I", data, at)
        if n < 3 or n % 3 or at + _HEAD + n - 3 > len(data):
            raise FormatError(
                path, track.position + at, f"a streamline of {n} coordinates",
                f"a multiple of 3 with at most {len(data) - at - _HEAD} further bytes",
            )  # fmt: skip
        starts.append(at)
        counts.append(n // 3)
        at += _HEAD + n - 3
    if not starts:
        return np.zeros((0, 3), np.int64), np.zeros(0, np.int64)
    begins, sizes = np.frombuffer(starts, np.int64), np.frombuffer(counts, np.int64)
    raw = np.frombuffer(data, np.uint8)
    heads = begins[:, None] + np.arange(_HEAD)
    is_delta = np.ones(len(raw), bool)
    is_delta[heads] = False
    first = np.ascontiguousarray(raw[heads[:, 4:]]).view("<i4").astype(np.int64)
    rows = np.cumsum(sizes) - sizes
    steps = np.zeros((int(sizes.sum()), 3), np.int64)
    is_step = np.ones(len(steps), bool)
    is_step[rows] = False
    steps[is_step] = raw[is_delta].view(np.int8).reshape(-1, 3)
    # A running sum over everything, less its value where each streamline begins.
    total = np.cumsum(steps, axis=0)
    return total + np.repeat(first - total[rows], sizes, axis=0), sizes


def read(path: str | PathLike[str], *, progress: bool = False) -> Streamlines:  # noqa: ARG001
    """Read a tt.gz file (see :func:`pvfiblets.formats.read`)."""
    name = fspath(path)
    check_swelling(name, whole=True)
    with gzip.open(name, "rb") as stream:
        data = inflate(name, stream, -1)
    matrices = _matrices(name, data)
    affine = _numbers(name, matrices, "trans_to_mni", 16).reshape(4, 4)
    sizes = _numbers(name, matrices, "voxel_size", 3)
    dimensions = _numbers(name, matrices, "dimension", 3)
    if not np.isfinite(affine).all():
        raise FormatError(name, matrices["trans_to_mni"].position, repr(affine.tolist()), "finite numbers")
    blocks = sorted(
        (int(key[5:] or 0), key) for key in matrices if key.startswith("track") and (key[5:] or "0").isdecimal()
    )
    if not blocks:
        raise FormatError(name, len(data), "no matrix 'track'", "the streamlines")
    for _, key in blocks:
        if matrices[key].values.dtype != np.uint8:
            raise FormatError(name, matrices[key].position, f"{key} of {matrices[key].values.dtype}", "bytes")
    decoded = [_records(name, matrices[key]) for _, key in blocks]
    counts = np.concatenate([sizes for _, sizes in decoded])
    points = np.concatenate([rows for rows, _ in decoded]) / _SUBVOXEL
    groups, per_group = _clusters(name, matrices, len(counts))
    space: dict[str, Any] = {
        "dimensions": tuple(int(d) for d in dimensions),
        "voxel_sizes": tuple(float(s) for s in sizes),
    }
    texts = ("report", "parameter_id")
    for key in texts:
        if key in matrices and matrices[key].values.dtype == np.uint8:
            text = matrices[key].values.tobytes().split(b"\0")[0]
            space[key] = text.decode("utf-8", "replace")
    known = {"dimension", "voxel_size", "trans_to_mni", "cluster", "color", *texts}
    unknown = len(set(matrices) - known - {key for _, key in blocks})
    return finite(
        transformed(points, affine),
        counts,
        {},
        {UNKNOWN: unknown} if unknown else {},
        groups=groups,
        per_group=per_group,
        affine=affine,
        space=space,
    )


def _numbers(path: str, matrices: dict[str, _Matrix], name: str, n: int) -> NDArray[np.float64]:
    if name not in matrices:
        raise FormatError(path, None, f"no matrix {name!r}", f"{n} numbers of that name")
    position, values = matrices[name]
    if len(values) != n:
        raise FormatError(path, position, f"{name} of {len(values)} numbers", f"{n} numbers")
    with np.errstate(invalid="ignore"):  # NaN is judged by the caller
        return values.astype(np.float64)


def _clusters(path: str, matrices: dict[str, _Matrix], n: int) -> tuple[dict[str, Array], dict[str, dict[str, Array]]]:
    """Make groups of the clusters, and their colours."""
    groups: dict[str, Array] = {}
    per_group: dict[str, dict[str, Array]] = {}
    if "cluster" not in matrices or len(matrices["cluster"].values) == 0:
        return groups, per_group
    position, cluster = matrices["cluster"]
    if len(cluster) != n or cluster.dtype.kind not in "iu":
        raise FormatError(path, position, f"{len(cluster)} clusters of {cluster.dtype}", f"{n} integers")
    colors = matrices["color"].values if "color" in matrices else np.zeros(0, np.int64)
    names = _sibling_names(path)
    order = np.argsort(cluster, kind="stable")
    ids, firsts = np.unique(cluster[order], return_index=True)
    for i, members in zip(ids.tolist(), np.split(order, firsts[1:]), strict=True):
        name = names[i] if 0 <= i < len(names) and names[i] else f"cluster_{i}"
        if name in groups:
            name = f"{name}_{i}"
        groups[name] = members
        if 0 <= i < len(colors) and colors.dtype.kind in "iu":
            color = int(colors[i])
            rgb = np.array([color >> 16 & 255, color >> 8 & 255, color & 255], np.uint8)
            per_group[name] = {"color": rgb}
    return groups, per_group


def _sibling_names(path: str) -> list[str]:
    """Return the lines of ``NAME.tt.gz.txt`` or ``NAME.txt``, the clusters' names, if there."""
    whole = Path(path)
    for candidate in (whole.name + ".txt", whole.name[: -len(".tt.gz")] + ".txt"):
        if (side := whole.with_name(candidate)).is_file():
            text = side.read_text("utf-8", "replace")
            return [line.strip().replace("/", "_") for line in text.splitlines()]
    return []


def iter_chunks(path: str | PathLike[str], max_points: int) -> Iterator[Streamlines]:
    """Inflate the whole file, then give it in pieces (see :func:`pvfiblets.formats.iter_chunks`)."""
    yield from pieces(read(path), max_points)


def info(path: str | PathLike[str]) -> dict[str, Any]:
    """Facts of the file, which is inflated whole (see :func:`pvfiblets.formats.info`)."""
    return facts(read(path))
