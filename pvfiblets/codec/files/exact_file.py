"""The points of an exact set as bytes of a file, in fewer bytes than they have, without loss.

``zlib`` (RFC 1950) of the numbers of points of all streamlines followed by the coordinates, in one of three forms
(:data:`FORMS`): whichever is the smallest.

0. The coordinates as they are, little-endian, x y z x y z ...
1. Their bytes by place: the lowest byte of all coordinates, then the next of all, ...
2. By place as in 1, of differences: the bits of each coordinate, as a whole number, less the bits of the point before
   it (modulo 2**32 or 2**64), all x, then all y, then all z. Points follow each other closely, so that the upper bytes
   repeat.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

from ...errors import FormatError
from ...support.memory import check_room

FORMS = 3
DENSEST = 1032  # bytes of deflate's that come out of one, at most
_TRIED = 1 << 18  # points that each form is tried on
_LEVEL = 6

Array = npt.NDArray[Any]


def pack_points(points: Array, counts: npt.NDArray[np.int64]) -> tuple[dict[str, Any], npt.NDArray[np.uint8]]:
    """Make the bytes of a file."""
    sizes = [len(zlib.compress(_TO[form](points[:_TRIED]), _LEVEL)) for form in range(FORMS)]
    form = int(np.argmin(sizes))
    width = next(w for w in (1, 2, 4, 8) if int(counts.max(initial=0)) < 1 << (8 * w))
    machine = zlib.compressobj(_LEVEL)
    parts = [machine.compress(raw) for raw in (counts.astype(f"<u{width}").tobytes(), _TO[form](points))]
    facts = {"form": form, "float": points.dtype.itemsize, "count": width}
    return facts, np.frombuffer(b"".join([*parts, machine.flush()]), np.uint8)


def unpack_points(
    path: str | PathLike[str], facts: dict[str, Any], packed: npt.NDArray[np.uint8], n_streamlines: int, n_points: int
) -> tuple[Array, npt.NDArray[np.int64]]:
    """Undo :func:`pack_points`."""
    form, size, width = (facts[name] for name in ("form", "float", "count"))
    if form not in range(FORMS) or size not in (4, 8) or width not in (1, 2, 4, 8):
        raise FormatError(path, 0, f"exact points as {facts}", f"a form below {FORMS}, floats of 4 or 8 bytes")
    expected = n_streamlines * width + 3 * n_points * size
    if min(n_streamlines, n_points) < 0 or expected > DENSEST * len(packed) + 64:
        raise FormatError(
            path, 0, f"{n_streamlines} streamlines of {n_points} points in {len(packed)} bytes", "as many as these hold"
        )
    check_room(2 * expected)
    machine = zlib.decompressobj()
    try:
        raw = machine.decompress(packed.tobytes(), expected + 1)
    except zlib.error as error:
        raise FormatError(path, None, f"damaged points ({error})", "an undamaged file") from error
    if len(raw) != expected or not machine.eof:
        raise FormatError(path, None, f"{len(raw)} bytes of exact points", f"{expected}")
    counts = np.frombuffer(raw, f"<u{width}", n_streamlines).astype(np.int64)
    if (counts < 0).any() or int(counts.sum()) != n_points:
        raise FormatError(path, None, f"streamlines of {int(counts.sum())} points", f"{n_points}, as the header says")
    points = _FROM[form](np.frombuffer(raw, np.uint8, offset=n_streamlines * width), size)
    if not np.isfinite(points).all():
        raise FormatError(path, None, "points that are no finite numbers", "an undamaged file")
    return points, counts


def _as_bits(points: Array) -> Array:
    return np.ascontiguousarray(points).view(f"<u{points.dtype.itemsize}")


def _by_place(values: Array) -> bytes:
    return values.ravel().view(np.uint8).reshape(-1, values.dtype.itemsize).T.tobytes()


def _from_places(raw: npt.NDArray[np.uint8], size: int) -> Array:
    return np.ascontiguousarray(raw.reshape(size, -1).T).view(f"<u{size}").ravel()


def _plain(points: Array) -> bytes:
    return points.astype(points.dtype.newbyteorder("<"), copy=False).tobytes()


def _differences(points: Array) -> bytes:
    bits = _as_bits(points)
    return _by_place(np.ascontiguousarray(np.diff(bits, axis=0, prepend=np.zeros((1, 3), bits.dtype)).T))


def _from_differences(raw: npt.NDArray[np.uint8], size: int) -> Array:
    columns = _from_places(raw, size).reshape(3, -1)
    return np.ascontiguousarray(np.cumsum(columns, axis=1, dtype=columns.dtype).T).view(f"<f{size}")


_TO: tuple[Callable[[Array], bytes], ...] = (_plain, lambda points: _by_place(_as_bits(points)), _differences)
_FROM: tuple[Callable[[npt.NDArray[np.uint8], int], Array], ...] = (
    lambda raw, size: raw.view(f"<f{size}").reshape(-1, 3).copy(),
    lambda raw, size: _from_places(raw, size).view(f"<f{size}").reshape(-1, 3),
    _from_differences,
)
