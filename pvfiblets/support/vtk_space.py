"""The space of points that VTK's files and datasets name, as 3D Slicer writes it: RAS+ or LPS+.

A file names it as ``SPACE=LPS`` in its title or comments, or in a field array of strings called ``SPACE``. Slicer reads
the title first. Without a name, coordinates are RAS+ here, unless the caller says otherwise: DIPY wrote LPS+ up
to 1.11 and writes RAS+ since 1.12, and nothing in its files tells.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, Literal, TypeAlias

import numpy as np

from pvfiblets.support.ragged import Array

Space: TypeAlias = Literal["RAS", "LPS"]

FIELD = "SPACE"  # name of the field array of strings
OURS: Space = "RAS"

_NAMES: dict[str, Space] = {
    "RAS": "RAS",
    "RIGHT-ANTERIOR-SUPERIOR": "RAS",
    "LPS": "LPS",
    "LEFT-POSTERIOR-SUPERIOR": "LPS",
}
_unnamed: Space | None = None
_unnamed_here: ContextVar[Space | None] = ContextVar("unnamed_here", default=None)
_TAG = re.compile(r"SPACE=([\w-]+)", re.IGNORECASE)


def space_named(name: str | None, where: str) -> Space | None:
    """Return the space of a name (NRRD's, short or long); warn of an unknown one, which counts as none."""
    if name is None:
        return None
    known = _NAMES.get(name.strip().upper())
    if known is None:
        warnings.warn(
            f"{where} names the space {name!r}; RAS or LPS is expected, and the coordinates are taken as RAS",
            UserWarning,
            stacklevel=2,
        )
    return known


def space_in_header(text: str, where: str) -> Space | None:
    """Return the space that a title or comment names."""
    found = _TAG.search(text)
    return space_named(found[1] if found else None, where)


def space_of_dataset(dataset: Any) -> Space | None:
    """Return the space that the field data of one of VTK's datasets name."""
    array = dataset.GetFieldData().GetAbstractArray(FIELD)
    if array is None or not array.IsA("vtkStringArray") or not array.GetNumberOfValues():
        return None
    return space_named(array.GetValue(0), "the field data")


@contextmanager
def unnamed_as(space: str | None) -> Iterator[None]:
    """Take files that name no space as `space`, in all threads."""
    global _unnamed  # of a whole command, whose files are read in many places
    before, _unnamed = _unnamed, None if space is None else checked(space)
    try:
        yield
    finally:
        _unnamed = before


@contextmanager
def unnamed_here(space: Space | None) -> Iterator[None]:
    """Take files that name no space as `space`, in this thread alone; of None, as :func:`unnamed_as` says."""
    token = _unnamed_here.set(space or _unnamed_here.get())
    try:
        yield
    finally:
        _unnamed_here.reset(token)


def unnamed() -> Space | None:
    """Return the space chosen for files that name none; None if none was."""
    return _unnamed_here.get() or _unnamed


def checked(space: str) -> Space:
    """Return a space that a caller gives in any case."""
    known = _NAMES.get(str(space).upper())
    if known is None:
        raise ValueError(f"unknown space {space!r}; choose 'RAS' or 'LPS'")
    return known


def space_taken(named: Space | None, given: Space | None = None) -> tuple[Space, str]:
    """Return the space of a file, from the name in it and what the caller says of files without one, and the reason."""
    if named is not None:
        return named, "named by the file"
    if chosen := given or unnamed():
        return chosen, "given, the file names none"
    return OURS, "assumed, the file names none; DIPY up to 1.11 wrote LPS: --space LPS"


def to_ras(points: Array, space: Space | None) -> Array:
    """Return ``(n, 3)`` points of a space in RAS+: the same array, or one with x and y negated."""
    return points * np.array([-1, -1, 1], points.dtype) if space == "LPS" else points
