"""Reading volumes from MetaImage files (``.mhd``, ``.mha``).

VTK's reader is not used: it crashes on damaged headers, and it transposes the directions, which MetaImage lists axis
by axis. ITK, whose format this is, means LPS+ by its coordinates. Format: https://itk.org/Wiki/ITK/MetaIO/Documentation
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.errors import FormatError

from .image import Image
from .packed_numbers import Packing, data_file, numbers

TYPES = {
    "MET_CHAR": "i1", "MET_UCHAR": "u1", "MET_SHORT": "i2", "MET_USHORT": "u2", "MET_INT": "i4", "MET_UINT": "u4",
    "MET_LONG": "i4", "MET_ULONG": "u4", "MET_LONG_LONG": "i8", "MET_ULONG_LONG": "u8", "MET_FLOAT": "f4",
    "MET_DOUBLE": "f8",
}  # fmt: skip
LONGEST_HEADER = 1 << 16
PLACES = ("offset", "position", "origin")
DIRECTIONS = ("transformmatrix", "orientation", "rotation")

Array = npt.NDArray[np.float64]


def read_metaimage(path: Path) -> Image:
    """Read an image."""
    fields, size = _fields(path)
    dims = _numbers(path, fields, ("dimsize",), None)
    if dims is None:
        raise FormatError(path, None, "no field DimSize", "a MetaImage header with one")
    channels = fields.get("elementnumberofchannels", "1").strip()
    if len(dims) not in (3, 4) or not channels.isdecimal() or not int(channels[:9]):
        raise FormatError(path, None, f"{len(dims)} axes and {channels} numbers per voxel", "three or four axes")
    if not all(n >= 1 and n == int(n) for n in dims.tolist() if math.isfinite(n)) or not np.isfinite(dims).all():
        n = "three" if len(dims) == 3 else "four"
        raise FormatError(path, None, f"DimSize = {fields['dimsize']}", f"{n} whole numbers above 0")
    shape = [int(n) for n in dims.tolist()]
    stored = shape if channels == "1" else [int(channels), *shape]  # numbers of a voxel lie side by side

    def read() -> npt.NDArray[Any]:
        values = _data(path, fields, size, stored).reshape(stored, order="F")
        return values if stored is shape else np.moveaxis(values, 0, -1)

    whole = (*shape, *stored[: len(stored) - len(shape)])
    return Image(whole, _affine(path, fields, len(shape)), read)


def _data(path: Path, fields: dict[str, str], size: int, shape: list[int]) -> npt.NDArray[Any]:
    """All numbers of the file in one row."""
    word = fields.get("elementtype", "none").upper()
    if word not in TYPES:
        raise FormatError(path, None, f"ElementType = {word}", f"one of {', '.join(TYPES)}")
    msb = _true(fields, "binarydatabyteordermsb") or _true(fields, "elementbyteordermsb")
    dtype = np.dtype(TYPES[word]).newbyteorder(">" if msb else "<")
    named, start = fields.get("elementdatafile", "LOCAL"), size
    if named.upper().split()[:1] == ["LIST"] or "%" in named:
        raise FormatError(path, None, f"ElementDataFile = {named}", "data in one file: join them first")
    place = path
    if named.upper() != "LOCAL":
        place, start = data_file(path, named), 0
    text = fields.get("headersize", "0")
    if not text.removeprefix("-").isdecimal() or int(text[:18]) < -1:
        raise FormatError(path, None, f"HeaderSize = {text}", "-1, or a number of bytes")
    skip = int(text[:18]) if place is not path else 0
    if "binarydata" in fields and not _true(fields, "binarydata"):
        return numbers(place, start, math.prod(shape), dtype, "ascii")
    packing: Packing = "zlib" if _true(fields, "compresseddata") else "raw"
    if packing == "zlib":
        start, skip = start + max(skip, 0), 0
    return numbers(place, start, math.prod(shape), dtype, packing, skip)


def _true(fields: dict[str, str], name: str) -> bool:
    return fields.get(name, "False")[:1].upper() in ("T", "1")


def header_fields(path: Path) -> dict[str, str]:
    """Return a header's fields as :func:`read_metaimage` sees them, names in lower case."""
    return _fields(path)[0]


def _fields(path: Path) -> tuple[dict[str, str], int]:
    """The header's fields, names in lower case, and its bytes."""
    fields: dict[str, str] = {}
    with path.open("rb") as file:
        read = 0
        while read < LONGEST_HEADER:
            line = file.readline(LONGEST_HEADER)
            read += len(line)
            name, equals, value = line.decode("latin-1").partition("=")
            if not equals:
                if line.strip():
                    raise FormatError(path, file.tell() - len(line), repr(line[:40]), "a line 'Field = value'")
                if not line:
                    break
                continue
            fields[name.strip().lower()] = value.strip()
            if name.strip().lower() == "elementdatafile":  # always the last
                break
        return fields, file.tell()


def _numbers(path: Path, fields: dict[str, str], names: tuple[str, ...], n: int | None) -> Array | None:
    """Numbers of the first of these fields that is there."""
    name = next((name for name in names if name in fields), None)
    if name is None:
        return None
    try:
        found = np.array([float(word) for word in fields[name].split()])
    except ValueError:
        found = np.zeros(0)
    if len(found) != n if n else len(found) == 0:
        raise FormatError(path, None, f"{name} = {fields[name]}", f"{n or 'some'} numbers")
    return found


def _affine(path: Path, fields: dict[str, str], n: int = 3) -> Array:
    """Voxel indices to mm; the first three of n axes are spatial."""
    spacing = _numbers(path, fields, ("elementspacing", "elementsize"), n)
    directions = _numbers(path, fields, DIRECTIONS, n * n)
    origin = _numbers(path, fields, PLACES, n)
    affine = np.eye(4)
    columns = np.eye(3) if directions is None else directions.reshape(n, n)[:3, :3].T
    affine[:3, :3] = columns * (1.0 if spacing is None else spacing[:3])
    affine[:3, 3] = 0.0 if origin is None else origin[:3]
    affine[:2] *= -1.0  # LPS+ to RAS+
    return affine
