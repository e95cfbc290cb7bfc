"""Positions of FreeSurfer's surfaces: from tkRAS, with the origin in the volume's middle, to the scanner's mm.

Surfaces of FreeSurfer have the geometry of their volume with them. Their points are in tkRAS unless the file says that
they are in the scanner's space (``mris_convert --to-scanner``). Programs that have moved the points, such as fMRIPrep,
leave a middle of 0, 0, 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from os import PathLike, fspath
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .file_notes import note

Array = npt.NDArray[np.float64]

_AXES = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Directions of a volume's axes, row by row, in tkRAS."""
NO_VOLUME = "assumed, the file has no geometry of a volume"
_stored = False


class Placed(NamedTuple):
    """Points ``(n, 3)`` of a surface in the assumed space, its file's own space and why, and the applied change."""

    points: Array
    space: str = "RAS"
    space_from: str = "named by the file"
    moved: str | None = None


@contextmanager
def as_stored(stored: bool = True) -> Iterator[None]:
    """Leave FreeSurfer's surfaces where their files have them, in all threads, for as long as the context lasts."""
    global _stored  # of a whole command, whose surfaces are read in many places
    before, _stored = _stored, stored
    try:
        yield
    finally:
        _stored = before


def tkras_chosen() -> bool:
    """Return whether :func:`as_stored` holds, for other processes."""
    return _stored


def in_scanner_space(
    path: str | PathLike[str], points: Array, middle: npt.ArrayLike, axes: npt.ArrayLike | None
) -> Placed:
    """Return ``(n, 3)`` points of tkRAS in the scanner's mm, by the middle and the axes of the volume."""
    centre = np.asarray(middle, np.float64)
    c_ras = f"c_ras = ({', '.join(f'{one:g}' for one in centre)}) mm"
    if not centre.any():
        return Placed(points, space_from="its c_ras is 0, as after a move to the scanner's space")
    if _stored:
        return Placed(points, "tkRAS", f"the file's volume, with {c_ras}")
    turn = np.eye(3)
    if axes is not None and abs(np.linalg.det(np.asarray(axes, np.float64))) > 0.5:
        turn = np.asarray(axes, np.float64).T @ np.linalg.inv(_AXES.T)
        turn = np.eye(3) if np.allclose(turn, np.eye(3), atol=1e-5) else turn
    turned = "" if np.array_equal(turn, np.eye(3)) else ", and turned as its volume is,"
    note(
        path,
        f"{fspath(path)} has its points in FreeSurfer's surface space (tkRAS); they are moved by {c_ras}{turned} to "
        "the scanner's space, where tracts are. To leave them as stored, choose --tkras (in Python "
        "read_mesh(path, tkras=True))",
    )
    return Placed(points @ turn.T + centre, "tkRAS", "the file's volume", f"by {c_ras}{turned.rstrip(',')}")


def numbers_of(texts: Sequence[Any]) -> list[float] | None:
    """Return finite numbers; None if there are others."""
    try:
        found = [float(text) for text in texts]
    except (TypeError, ValueError):
        return None
    return found if np.isfinite(found).all() else None
