"""Surfaces of FreeSurfer and values of their vertices: nibabel reads them, and its complaints become errors."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.errors import FormatError

SURFACES = (
    ".pial", ".white", ".inflated", ".sphere", ".sphere.reg", ".orig", ".smoothwm", ".midthickness", ".graymid",
    ".pial.t1", ".white.preaparc",
)  # fmt: skip
"""Ends of names of surfaces, in lower case: ``lh.pial``."""
VALUES = (".annot", ".thickness", ".curv", ".sulc")  # ends of names of files with a label or a number for each vertex

MOST_LABELS = 1 << 15  # most labels of a table: FreeSurfer's own numbers end at 14175
_TRIANGLES, _NUMBERS = b"\xff\xff\xfe", b"\xff\xff\xff"
_QUADS = {b"\xff\xff\xff": 2, b"\xff\xff\xfd": 4}
"""First bytes of older surfaces of quadrangles, and the bytes of a coordinate."""
_HEAD = 1 << 12  # bytes in which the comment of a surface ends

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def read_geometry(path: Path) -> tuple[Floats, npt.NDArray[Any], dict[str, Any]]:
    """Return points ``(n, 3)``, triangles ``(m, 3)``, and what the footer says of the volume."""
    head, size = _head(path)
    expected = "a surface of FreeSurfer, such as lh.pial"
    footer = False
    if head[:3] == _TRIANGLES:
        begin = head.find(b"\n", head.find(b"\n") + 1) + 1  # behind the comment
        if begin == 0 or len(head) < begin + 8:
            raise FormatError(path, 3, "no end of the comment", expected)
        n, m = (int(one) for one in np.frombuffer(head, ">i4", 2, begin))
        needed = begin + 8 + 12 * (n + m)
        if n < 0 or m < 0 or size < needed:
            raise FormatError(path, begin, f"{n:,} points and {m:,} triangles in {size:,} bytes", expected)
        footer = size > needed
    elif head[:3] in _QUADS:
        n, m = (int.from_bytes(head[at : at + 3], "big") for at in (3, 6))
        if size < 9 + 3 * _QUADS[head[:3]] * n + 12 * m:
            raise FormatError(path, 3, f"{n:,} points and {m:,} quadrangles in {size:,} bytes", expected)
    from nibabel.freesurfer import io

    try:
        with warnings.catch_warnings(), np.errstate(invalid="ignore"):
            warnings.simplefilter("ignore")  # of footers that it does not know
            found = io.read_geometry(path, read_metadata=footer)
    except Exception as error:  # noqa: BLE001 - of text, sizes and numbers
        raise _said(path, error, expected) from None
    return found[0], found[1], dict(found[2]) if footer else {}


def read_annotation(path: Path) -> tuple[Ints, npt.NDArray[np.uint8]]:
    """Return the label of each vertex, -1 for none, as nibabel counts them, and ``(n, 3)`` colours."""
    expected = "an annotation of FreeSurfer, such as lh.aparc.annot, with its table of colours"
    with path.open("rb") as file:
        n = int(np.frombuffer(file.read(4).ljust(4, b"\0"), ">i4")[0])
        size = path.stat().st_size
        if n < 1 or size < 4 + 8 * n:
            raise FormatError(path, 0, f"{n:,} vertices in {size:,} bytes", expected)
        file.seek(4 + 8 * n)
        _check_table(path, 4 + 8 * n, file.read(), expected)
    from nibabel.freesurfer import io

    try:
        stored, table, _ = io.read_annot(path, orig_ids=True)
    except Exception as error:  # noqa: BLE001 - of text, sizes and numbers
        raise _said(path, error, expected) from None
    numbers = np.asarray(stored, np.int64)
    order = np.argsort(table[:, 4], kind="stable")
    at = np.minimum(np.searchsorted(table[order, 4], numbers), len(table) - 1)
    found = np.where((table[order[at], 4] == numbers) & (numbers != 0), order[at], -1)
    colours = np.stack([numbers & 255, numbers >> 8 & 255, numbers >> 16 & 255], axis=1)  # what a number is made of
    colours[found < 0] = 128
    return found, colours.astype(np.uint8)


def read_numbers(path: Path) -> Floats:
    """Return the number of each vertex."""
    expected = "numbers of vertices as FreeSurfer writes them, such as lh.thickness"
    head, size = _head(path)
    n = int.from_bytes(head[3:7] if head[:3] == _NUMBERS else head[:3], "big")
    needed = 15 + 4 * n if head[:3] == _NUMBERS else 6 + 2 * n
    if n < 1 or size < needed:
        raise FormatError(path, 0, f"numbers of {n:,} vertices in {size:,} bytes", expected)
    from nibabel.freesurfer import io

    with np.errstate(invalid="ignore"):
        return np.asarray(io.read_morph_data(path), np.float64)


def _check_table(path: Path, begin: int, table: bytes, expected: str) -> None:
    """Refuse a table of colours whose sizes are wrong, before nibabel takes memory for them."""
    at = 0

    def number() -> int:
        nonlocal at
        at += 4
        if at > len(table):
            raise FormatError(path, begin + len(table), "the end of the file", expected)
        return int.from_bytes(table[at - 4 : at], "big", signed=True)

    def text() -> None:
        nonlocal at
        length = number()
        if not 0 <= length <= len(table) - at:
            raise FormatError(path, begin + at - 4, f"a text of {length:,} bytes", expected)
        at += length

    if not number():
        raise FormatError(path, begin, "no table of colours", expected)
    rows = most = number()
    if numbered := rows < 0:
        most = number()
    if not 0 < most <= MOST_LABELS:
        raise FormatError(path, begin + at - 4, f"{most:,} labels", f"1 to {MOST_LABELS:,}")
    text()
    if numbered:
        rows = number()
    for _ in range(rows):
        if numbered and not 0 <= (label := number()) < most:
            raise FormatError(path, begin + at - 4, f"the label {label:,}", f"0 to {most - 1:,}")
        text()
        at += 16
        if at > len(table):
            raise FormatError(path, begin + len(table), "the end of the file", expected)


def _head(path: Path) -> tuple[bytes, int]:
    with path.open("rb") as file:
        return file.read(_HEAD), path.stat().st_size


def _said(path: Path, error: Exception, expected: str) -> FormatError:
    return FormatError(path, None, f"what nibabel cannot read ({error or type(error).__name__})", expected)
