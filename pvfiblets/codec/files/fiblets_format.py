"""``.fiblets`` as one of the formats: the functions that :mod:`pvfiblets.formats.registry` asks of each."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from os import PathLike, fspath
from typing import Any

import numpy as np

from ...streamlines import Streamlines
from ..check import check_file
from ..decompress import held_in_bounds
from ..encoding.compress import compress
from ..fibletset import FibletSet
from ..point_values import PointValues
from ..tangents import PIXELS
from .fiblets_file import index_bytes, is_sharded


def read(path: str | PathLike[str], *, progress: bool = False) -> Streamlines:
    """Decode a whole file; see :func:`pvfiblets.read`."""
    del progress  # decoding outruns the bar
    fiblets = FibletSet.open(path)
    return next(held_in_bounds(fiblets, [fiblets.decompress()]))


def iter_chunks(path: str | PathLike[str], max_points: int) -> Iterator[Streamlines]:
    """Decode a file piece by piece; see :func:`pvfiblets.iter_chunks`."""
    empty = True
    for chunk in _iter_chunks(path, max_points):
        empty = False
        yield chunk
    if empty:
        yield FibletSet.open(path).decompress()


def _iter_chunks(path: str | PathLike[str], max_points: int) -> Iterator[Streamlines]:
    if is_sharded(path):
        from ..shards.sharded_set import ShardedSet

        return ShardedSet.open(path).iter_chunks(max_points)
    fiblets = FibletSet.open(path)
    return held_in_bounds(fiblets, fiblets.iter_chunks(max_points))


def write(path: str | PathLike[str], streamlines: Streamlines) -> None:
    """Compress with default settings, every per-point array kept at one byte a point, and save."""
    compress(streamlines, per_point=tuple(streamlines.per_point)).save(path)


def info(path: str | PathLike[str]) -> dict[str, Any]:
    """Header facts, in constant time; of a folder of shards, from its manifest and its first shard."""
    if is_sharded(path):
        return _info_of_shards(path)
    f = FibletSet.open(path)
    return {
        "format": "fiblets",
        "path": fspath(path),
        "streamlines": f.n_streamlines,
        "points": f.n_points,
        "fiblets": f.n_fiblets,
        "bytes": f.nbytes,
        "index_bytes": index_bytes(f) or None,
        "step_mm": f.step,
        "exact": f.exact is not None,
        "promise_mm": f.points_promise,
        "promise_pixels": _pixels(f.points_promise, f.bounds),
        "bounds_mm": list(f.bounds),
        "per_point": {k: {"min": v.lo, "max": v.hi, **_errors_and_type(v)} for k, v in f.per_point.items()},
        "per_streamline": sorted(f.per_streamline),
        "groups": {k: len(v) for k, v in f.groups.items()},
        "affine": f.affine.tolist(),
        "dropped": f.dropped,
    }


def _errors_and_type(values: PointValues) -> dict[str, Any]:
    return {"max_error": values.max_error, "mean_error": values.mean_error, "type": values.dtype.name}


def _pixels(promise: float, bounds: Sequence[float]) -> dict[str, float]:
    """Return the pixels that a point may move in a full-screen view along each axis, whatever the axes' units."""
    extent = np.diff(np.reshape(bounds, (3, 2)), axis=1).ravel()
    wide = {name: math.hypot(*np.delete(extent, axis)) / PIXELS for axis, name in enumerate("xyz")}
    return {f"along_{name}": promise / side if side else 0.0 for name, side in wide.items()}


def _info_of_shards(path: str | PathLike[str]) -> dict[str, Any]:
    from ..shards.sharded_set import ShardedSet

    whole = ShardedSet.open(path)
    manifest = whole.manifest
    first = info(whole.place(0))
    return {
        **first,
        "path": fspath(path),
        "streamlines": manifest.streamlines,
        "points": manifest.points,
        "fiblets": manifest.n_fiblets,
        "bytes": whole.nbytes,
        "shards": len(manifest.shards),
        "promise_mm": (promise := 0.0 if first["exact"] else manifest.promise_mm),
        "promise_pixels": _pixels(promise, manifest.bounds),
        "bounds_mm": list(manifest.bounds),
        "groups": manifest.groups,
        "dropped": manifest.dropped,
    }


def verify_file(path: str | PathLike[str]) -> None:
    """Check a file's every byte against its checksums, and its records for sense."""
    if is_sharded(path):
        from ..shards.sharded_set import ShardedSet

        ShardedSet.open(path).verify()
    else:
        check_file(FibletSet.open(path), path)
