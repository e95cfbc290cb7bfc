"""Reading images from MRtrix's files (``.mif``, ``.mif.gz``, ``.mih``).

Format: https://mrtrix.readthedocs.io/en/latest/getting_started/image_data.html
"""

from __future__ import annotations

import gzip
import math
import re
import zlib
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.errors import FormatError

from .image import Image
from .packed_numbers import data_file, numbers

MAGIC = b"mrtrix image"
LONGEST_HEADER = 1 << 24  # a table of 10,000 gradients is well below
MOST_AXES = 16

_KIND = re.compile(r"(u?int|float)(8|16|32|64)(le|be)?", re.IGNORECASE)

Array = npt.NDArray[np.float64]


def read_mif(path: Path) -> Image:
    """Read an image."""
    fields, files, transform = _header(path)
    shape = _whole_numbers(path, fields, "dim")
    if not 1 <= len(shape) <= MOST_AXES or min(shape) < 1:
        raise FormatError(path, None, f"dim: {fields['dim']}", "one to 16 whole numbers above 0, between commas")
    strides = _layout(path, fields, len(shape))
    whole = (*shape, 1, 1)[: max(len(shape), 3)]

    def read() -> npt.NDArray[Any]:
        return _scaled(path, fields, _in_order(_data(path, fields, files, shape), shape, strides).reshape(whole))

    return Image(whole, _affine(path, fields, transform, shape), read)


def named_files(path: Path) -> list[str]:
    """Return the files that a header says its numbers lie in, as :func:`read_mif` takes it; none if it is this one."""
    _, files, _ = _header(path)
    return [named for named in (_split(line)[0] for line in files) if named != "."]


def _split(line: str) -> tuple[str, int]:
    """Return the name and the offset after ``file:``."""
    named, _, offset = line.rpartition(" ") if re.search(r" \d+$", line) else (line, "", "0")
    return named.strip(), int(offset)


def _open(path: Path) -> IO[bytes]:
    opened: Any = gzip.open if path.name.lower().endswith(".gz") else open
    return opened(path, "rb")


def _header(path: Path) -> tuple[dict[str, str], list[str], list[str]]:
    """Return fields by name, where data are, and the rows of the transform."""
    fields: dict[str, str] = {}
    files: list[str] = []
    transform: list[str] = []
    try:
        with _open(path) as file:
            first = file.readline(64)
            if first.strip() != MAGIC:
                raise FormatError(path, 0, repr(first[:20]), f"the magic line {MAGIC.decode()!r}")
            read = len(first)
            while read < LONGEST_HEADER:
                line = file.readline(LONGEST_HEADER - read)
                read += len(line)
                text = line.decode("utf-8", "replace").strip()
                if text == "END":
                    return fields, files, transform
                if not line:
                    if path.suffix.lower() == ".mih":  # whose header MRtrix ends with the file
                        return fields, files, transform
                    break
                name, colon, value = text.partition(":")
                name, value = name.strip().lower(), value.strip()
                if not text or text.startswith("#"):
                    continue
                if not colon:
                    raise FormatError(path, read - len(line), repr(text[:40]), "a line 'name: value'")
                if name == "file":
                    files.append(value)
                elif name == "transform":
                    transform.append(value)
                else:
                    fields[name] = value
    except (EOFError, gzip.BadGzipFile, zlib.error) as error:
        raise FormatError(path, None, f"damaged gzip data ({error})", "whole gzip data") from None
    raise FormatError(path, None, "a header without END", "the line END after the header")


def _numbers(path: Path, name: str, text: str) -> Array:
    try:
        return np.array([float(word) for word in text.split(",")])
    except ValueError:
        raise FormatError(path, None, f"{name}: {text}", "numbers between commas") from None


def _whole_numbers(path: Path, fields: dict[str, str], name: str) -> list[int]:
    if name not in fields:
        raise FormatError(path, None, f"no field {name!r} in the header", f"one, such as '{name}: ...'")
    try:
        return [int(word) for word in fields[name].split(",")]
    except ValueError:
        raise FormatError(path, None, f"{name}: {fields[name]}", "whole numbers between commas") from None


def _layout(path: Path, fields: dict[str, str], n: int) -> list[tuple[int, bool]]:
    """Return of each axis its place in memory, 0 the fastest, and whether it runs backwards."""
    text = fields.get("layout")
    if text is None:
        raise FormatError(path, None, "no field 'layout' in the header", "one, such as 'layout: +0,+1,+2'")
    words = [word.strip() for word in text.split(",")]
    good = all(re.fullmatch(r"[+-]?\d+", word) for word in words)
    if not good or sorted(abs(int(word)) for word in words) != list(range(n)):
        raise FormatError(path, None, f"layout: {text}", f"the places 0 to {n - 1}, each once and with a sign")
    return [(abs(int(word)), word.startswith("-")) for word in words]


def _data(path: Path, fields: dict[str, str], files: list[str], shape: list[int]) -> npt.NDArray[Any]:
    """All numbers of the file in one row."""
    if len(files) != 1:
        raise FormatError(path, None, f"{len(files)} lines 'file: ...'", "one: join the data by mrconvert first")
    named, start = _split(files[0])
    place = path if named == "." else data_file(path, named)
    kind = fields.get("datatype", "none")
    packing: Any = "gzip" if place.name.lower().endswith(".gz") else "raw"
    at, skip = (0, start) if packing == "gzip" else (start, 0)
    count = math.prod(shape)
    if kind.lower() == "bit":
        packed = numbers(place, at, (count + 7) // 8, np.uint8, packing, skip)
        return np.unpackbits(packed, count=count)
    found = _KIND.fullmatch(kind)
    name = "" if found is None else f"{found[1].lower()}{found[2]}"
    if found is None or name in ("float8", "uint", "int"):
        expected = "one of Bit, Int8, UInt8 … Float64, with LE or BE; mrconvert makes real of complex numbers"
        raise FormatError(
            path, None, f"datatype: {kind}", f"one of {expected}; mrconvert makes real of complex numbers"
        )
    order: Any = {"le": "<", "be": ">"}.get((found[3] or "").lower(), "=")
    return numbers(place, at, count, np.dtype(name).newbyteorder(order), packing, skip)


def _in_order(flat: npt.NDArray[Any], shape: list[int], strides: list[tuple[int, bool]]) -> npt.NDArray[Any]:
    """Return numbers in memory as an array of the image's axes; only a view of them."""
    axes = sorted(range(len(shape)), key=lambda axis: strides[axis][0])  # the fastest first
    stored = flat.reshape([shape[axis] for axis in axes], order="F")
    values = stored.transpose([axes.index(axis) for axis in range(len(shape))])
    return values[tuple(slice(None, None, -1 if backwards else 1) for _, backwards in strides)]


def _scaled(path: Path, fields: dict[str, str], values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    if "scaling" not in fields:
        return values
    found = _numbers(path, "scaling", fields["scaling"])
    if len(found) != 2 or not np.isfinite(found).all():
        raise FormatError(path, None, f"scaling: {fields['scaling']}", "two finite numbers, offset and scale")
    offset, scale = found
    return values if (offset, scale) == (0.0, 1.0) else (values * np.float32(scale) + np.float32(offset))


def _affine(path: Path, fields: dict[str, str], transform: list[str], shape: list[int]) -> Array:
    """Voxel indices to mm; without a transform the image's middle is the origin, as in MRtrix."""
    vox = np.ones(3)
    found = _numbers(path, "vox", fields.get("vox", "1,1,1"))[:3]
    known = np.isfinite(found) & (found > 0.0)
    vox[: len(found)][known] = found[known]
    affine = np.eye(4)
    if transform:
        rows = [_numbers(path, "transform", row) for row in transform]
        if len(rows) < 3 or any(len(row) != 4 for row in rows) or not np.isfinite(rows[:3]).all():
            raise FormatError(path, None, f"transform: {'; '.join(transform)}", "three rows of four finite numbers")
        affine[:3] = rows[:3]
        affine[:3, :3] *= vox
    else:
        affine[:3, :3] = np.diag(vox)
        sides = np.ones(3)
        sides[: min(len(shape), 3)] = shape[:3]
        affine[:3, 3] = -0.5 * vox * (sides - 1.0)
    return affine
