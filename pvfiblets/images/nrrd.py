"""Reading volumes from NRRD files (``.nrrd``, ``.nhdr``).

VTK's reader takes the first axis of a 3-D file for components where the file states kinds, and knows no directions: so
the header is read here. Format: https://teem.sourceforge.net/nrrd/format.html
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.errors import FormatError

from .image import Image
from .packed_numbers import Packing, data_file, numbers

TYPES = {
    name: dtype
    for dtype, names in {
        "i1": "signed char,int8,int8_t",
        "u1": "uchar,unsigned char,uint8,uint8_t",
        "i2": "short,short int,signed short,signed short int,int16,int16_t",
        "u2": "ushort,unsigned short,unsigned short int,uint16,uint16_t",
        "i4": "int,signed int,int32,int32_t",
        "u4": "uint,unsigned int,uint32,uint32_t",
        "i8": "longlong,long long,long long int,signed long long,signed long long int,int64,int64_t",
        "u8": "ulonglong,unsigned long long,unsigned long long int,uint64,uint64_t",
        "f4": "float",
        "f8": "double",
    }.items()
    for name in names.split(",")
}
ENCODINGS: dict[str, Packing] = {
    "raw": "raw", "gz": "gzip", "gzip": "gzip", "bz2": "bzip2", "bzip2": "bzip2",
    "txt": "ascii", "text": "ascii", "ascii": "ascii",
}  # fmt: skip
LONGEST_HEADER = 1 << 20
SPATIAL = ("domain", "space", "???", "none")

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class _Header:
    path: Path
    fields: dict[str, str]
    size: int  # bytes, the blank line included

    def error(self, found: str, expected: str) -> FormatError:
        return FormatError(self.path, None, found, expected)

    def get(self, *names: str) -> str | None:
        return next((self.fields[name] for name in names if name in self.fields), None)

    def need(self, name: str) -> str:
        if name not in self.fields:
            raise self.error(f"no field {name!r} in the header", f"one, such as '{name}: ...'")
        return self.fields[name]

    def numbers(self, name: str, n: int) -> Array | None:
        """A field's n numbers; None if it is not there."""
        text = self.fields.get(name)
        if text is None:
            return None
        try:
            found = np.array([float(word) for word in text.split()])
        except ValueError:
            found = np.zeros(0)
        if len(found) != n:
            raise self.error(f"{name}: {text}", f"{n} numbers, one for each axis")
        return found

    def vectors(self, name: str) -> list[Array | None] | None:
        """Vectors such as (1,0,0), and None for the word none; None if the field is not there."""
        text = self.fields.get(name)
        if text is None:
            return None
        found: list[Array | None] = []
        rest = text.strip()
        try:
            while rest:
                if rest.startswith("none"):
                    found.append(None)
                    rest = rest[4:].strip()
                else:
                    inner, closed, after = rest.removeprefix("(").partition(")")
                    if not closed or not rest.startswith("("):
                        raise ValueError(rest)
                    found.append(np.array([float(word) for word in inner.split(",")]))
                    rest = after.strip()
        except ValueError:
            raise self.error(f"{name}: {text}", "vectors such as (1,0,0), or none, for each axis") from None
        return found


def read_nrrd(path: Path) -> Image:
    """Read an image."""
    header = _header(path)
    dimension = _whole(header, "dimension", header.need("dimension"))
    sizes = [_whole(header, "sizes", word) for word in header.need("sizes").split()]
    if len(sizes) != dimension or min(sizes, default=0) < 1:
        raise header.error(f"sizes: {header.need('sizes')}", f"{dimension} whole numbers above 0")
    axes = _spatial_axes(header, sizes)
    others = [axis for axis in range(dimension) if axis not in axes and sizes[axis] > 1]
    order = [*axes, *others, *_single(axes, others, dimension)]
    shape = tuple(sizes[axis] for axis in (*axes, *others))

    def read() -> npt.NDArray[Any]:
        return _data(header, sizes).reshape(sizes, order="F").transpose(order).reshape(shape, order="F")

    return Image(shape, _affine(header, axes, dimension), read)


def header_fields(path: Path) -> dict[str, str]:
    """Return a header's fields as :func:`read_nrrd` sees them, names in lower case."""
    return _header(path).fields


def _header(path: Path) -> _Header:
    with path.open("rb") as file:
        magic = file.readline(16)
        if not magic.startswith(b"NRRD000"):
            raise FormatError(path, 0, repr(magic[:8]), "the magic line 'NRRD0004' of a NRRD file")
        fields: dict[str, str] = {}
        while True:
            line = file.readline(LONGEST_HEADER)
            if not line.endswith(b"\n") and len(line) == LONGEST_HEADER:
                raise FormatError(path, file.tell(), "a line without an end", "lines of text in the header")
            text = line.decode("utf-8", "replace").rstrip("\r\n")
            if not text:
                return _Header(path, fields, file.tell())
            name, colon, value = text.partition(":")
            if text.startswith("#") or value.startswith("="):
                continue
            if not colon:
                raise FormatError(path, file.tell() - len(line), repr(text[:40]), "a line 'field: value'")
            fields[name.strip().lower()] = value.strip()
            if name.strip().lower() in ("data file", "datafile") and value.split()[:1] == ["LIST"]:
                return _Header(path, fields, file.tell())


def _whole(header: _Header, name: str, word: str) -> int:
    try:
        return int(word)
    except ValueError:
        raise header.error(f"{name}: {word}", "a whole number") from None


def _single(axes: list[int], others: list[int], dimension: int) -> list[int]:
    """The axes of one entry that are neither of space nor of components."""
    return [axis for axis in range(dimension) if axis not in axes and axis not in others]


def _spatial_axes(header: _Header, sizes: list[int]) -> list[int]:
    """The three axes of space."""
    directions = header.vectors("space directions")
    kinds = header.get("kinds")
    named = kinds.split() if kinds else ["???"] * len(sizes)
    spatial = [
        (directions is None or directions[axis] is not None) and named[axis].lower() in SPATIAL
        if len(named) == len(sizes) and (directions is None or len(directions) == len(sizes))
        else True
        for axis in range(len(sizes))
    ]
    axes = [axis for axis in range(len(sizes)) if spatial[axis]]
    if len(axes) > 3:  # of older files that say nothing of their axes
        axes = [axis for axis in axes if sizes[axis] > 1]
    if len(axes) != 3:
        kind = f" of the kinds {kinds}" if kinds else ""
        raise header.error(f"{len(sizes)} axes of the sizes {' x '.join(map(str, sizes))}{kind}", "three axes of space")
    return axes


def _affine(header: _Header, axes: list[int], dimension: int) -> Array:
    affine = np.eye(4)
    directions, origin = header.vectors("space directions"), header.vectors("space origin")
    if directions is not None:
        columns = [directions[axis] for axis in axes] if len(directions) == dimension else []
        place = np.zeros(3) if not origin or origin[0] is None else origin[0]
        if len(columns) != 3 or any(c is None or c.shape != (3,) for c in columns) or place.shape != (3,):
            raise header.error(
                f"space directions: {header.fields['space directions']}", "a vector of three numbers for each axis"
            )
        affine[:3, :3] = np.stack([c for c in columns if c is not None], axis=1)
        affine[:3, 3] = place
    elif (spacings := header.numbers("spacings", dimension)) is not None:
        mm = spacings[axes]
        affine[:3, :3] = np.diag(np.where(np.isnan(mm), 1.0, mm))
    space = (header.get("space") or "").lower().replace("_", "-")
    words = (
        space.split("-")
        if "-" in space
        else {"r": ["right"], "l": ["left"]}.get(space[:1], [])
        + ({"a": ["anterior"], "p": ["posterior"]}.get(space[1:2], []))
    )
    if "left" in words:
        affine[0] *= -1.0
    if "posterior" in words:
        affine[1] *= -1.0
    return affine


def _data(header: _Header, sizes: list[int]) -> npt.NDArray[Any]:
    """All numbers of the file in one row."""
    kind = header.need("type").lower()
    if kind not in TYPES:
        raise header.error(f"type: {kind}", f"one of {', '.join(TYPES)}")
    encoding = ENCODINGS.get(header.need("encoding").lower())
    if encoding is None:
        raise header.error(f"encoding: {header.need('encoding')}", "raw, gzip, bzip2 or ascii")
    dtype = np.dtype(TYPES[kind])
    if dtype.itemsize > 1 and encoding != "ascii":
        endian = header.need("endian").lower()
        if endian not in ("little", "big"):
            raise header.error(f"endian: {endian}", "little or big")
        dtype = dtype.newbyteorder("<" if endian == "little" else ">")
    path, start = header.path, header.size
    named = header.get("data file", "datafile")
    if named is not None:
        if named.split()[:1] == ["LIST"] or "%" in named:
            raise header.error(f"data file: {named}", "data in one file: join them first")
        path, start = data_file(header.path, named), 0
    skip = _whole(header, "byte skip", header.get("byte skip", "byteskip") or "0")
    if skip < -1:
        raise header.error(f"byte skip: {skip}", "-1, or a number of bytes")
    start = _skip_lines(path, start, _whole(header, "line skip", header.get("line skip", "lineskip") or "0"))
    return numbers(path, start, math.prod(sizes), dtype, encoding, skip)


def _skip_lines(path: Path, start: int, lines: int) -> int:
    """Position of the data, after so many lines."""
    with path.open("rb") as file:
        file.seek(start)
        for _ in range(lines):
            while (line := file.readline(LONGEST_HEADER)) and not line.endswith(b"\n"):
                pass
            if not line:
                break
        return file.tell()
