"""Fixels of MRtrix: directions in voxels, and numbers of them, from a folder of files.

Format: https://mrtrix.readthedocs.io/en/latest/fixel_based_analysis/fixel_directory_format.html

A folder has an index, ``(nx, ny, nz, 2)``: how many fixels a voxel has and which is its first; directions,
``(n, 3, 1)`` along right, front and up; and files of numbers, ``(n, m, 1)``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.errors import FormatError
from pvfiblets.images.files import read_image

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

SUFFIXES = (".mif", ".mif.gz", ".nii", ".nii.gz")  # suffixes of the files of a folder


@dataclass(frozen=True, eq=False)
class Fixels:
    """Directions in voxels."""

    counts: Ints  # `(nx, ny, nz)` int64: fixels of each voxel, and the number of its first
    first: Ints
    directions: npt.NDArray[np.float32]  # `(n, 3)` float32, along right, front and up
    # `(n,)` numbers of fixels that have been read
    arrays: Mapping[str, npt.NDArray[np.float32]] = field(default_factory=dict)
    folder: Path | None = None  # where more numbers are
    shown: str | None = None  # the fixels that a file was opened for

    def __len__(self) -> int:
        return len(self.directions)

    @property
    def names(self) -> list[str]:
        """Names of all numbers that :meth:`numbers` takes."""
        found = dict.fromkeys(self.arrays)
        if self.folder is not None:
            for path in sorted(self.folder.iterdir()):
                stem = _stem(path)
                if stem is not None and stem not in ("index", "directions"):
                    found[stem] = None
        return list(found)

    def numbers(self, given: Any) -> npt.NDArray[np.float32]:
        """Return ``(n,)`` numbers of fixels, by name (read from the folder if necessary) or from an array."""
        if not isinstance(given, str):
            found = np.asarray(given, np.float32)
            if found.shape != (len(self),):
                raise ValueError(f"numbers of fixels have the shape {found.shape}; give {len(self)}, one each")
            return found
        if given in self.arrays:
            return self.arrays[given]
        path = None if self.folder is None else _file(self.folder, given)
        if path is None or given in ("index", "directions"):
            raise ValueError(f"fixels have no numbers {given!r}; there are: {', '.join(self.names) or 'none'}")
        values = read_image(path).values
        if values.shape[0] != len(self) or values.size != len(self):
            raise ValueError(f"{path.name} has the shape {values.shape}; give ({len(self)}, 1, 1), a number per fixel")
        return values.reshape(-1).astype(np.float32)

    def of_voxels(self, voxels: Ints) -> tuple[Ints, Ints]:
        """Return the fixels of voxels ``(n, 3)``, ``(k,)``, and which of the voxels each is of, ``(k,)``."""
        counts, first = self.counts[tuple(voxels.T)], self.first[tuple(voxels.T)]
        which = np.repeat(np.arange(len(voxels)), counts)
        within = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
        return first[which] + within, which

    def of_grid(self, numbers: npt.NDArray[np.float32] | None) -> npt.NDArray[np.float32]:
        """Return ``(nx, ny, nz)``: how many fixels voxels have, or the greatest number of each's, 0 without any."""
        if numbers is None:
            return self.counts.astype(np.float32)
        voxels = np.argwhere(self.counts > 0)
        fixels, which = self.of_voxels(voxels)
        greatest = np.full(len(voxels), -np.inf, np.float32)
        np.fmax.at(greatest, which, numbers[fixels])
        found = np.zeros(self.counts.shape, np.float32)
        found[tuple(voxels.T)] = np.where(np.isfinite(greatest), greatest, 0.0)
        return found


def _stem(path: Path) -> str | None:
    """Return a file's name without its suffix; None if it is none of a folder of fixels."""
    suffix = max((one for one in SUFFIXES if path.name.lower().endswith(one)), key=len, default=None)
    return None if suffix is None else path.name[: -len(suffix)]


def _file(folder: Path, stem: str) -> Path | None:
    """Return the file of a folder that has a name, whatever its suffix; None without one."""
    if "/" in stem or "\\" in stem:
        return None
    return next((found for one in SUFFIXES if (found := folder / f"{stem}{one}").is_file()), None)


def sibling_files(path: Path) -> list[Path]:
    """Return index and directions of the folder that a path is or lies in; none if it is no folder of fixels."""
    folder = path if path.is_dir() else path.parent
    if folder == path.parent and _stem(path) is None:
        return []
    found = [_file(folder, stem) for stem in ("index", "directions")]
    return [] if None in found else [one for one in found if one is not None]


def read_fixels(path: Path) -> tuple[Fixels, Array, str] | None:
    """Read a folder of fixels, or one of its files."""
    beside = sibling_files(path)
    if not beside:
        if path.is_dir():
            raise FormatError(path, None, "no index and directions in the folder", "a fixel directory of MRtrix")
        return None
    own = None if path.is_dir() else _stem(path)
    numbers = None
    placed = read_image(beside[0])
    index, affine = placed.values, placed.affine
    if own not in (None, "index", "directions"):
        values = read_image(path).values
        if values.ndim != 3 or values.shape[2] != 1 or values.shape[:3] == index.shape[:3]:
            return None
        numbers = values
    if index.ndim != 4 or index.shape[3] != 2 or index.dtype.kind not in "iuf":
        raise FormatError(beside[0], None, f"the shape {index.shape}", "(nx, ny, nz, 2): numbers and firsts of fixels")
    directions = read_image(beside[1]).values
    if directions.ndim != 3 or directions.shape[1:] != (3, 1):
        raise FormatError(beside[1], None, f"the shape {directions.shape}", "(n, 3, 1): a direction of each fixel")
    counts, first = (np.ascontiguousarray(index[..., k], np.int64) for k in range(2))
    n = len(directions)
    some = counts > 0
    if (counts < 0).any() or (first[some] < 0).any() or (first[some] + counts[some] > n).any():
        raise FormatError(beside[0], None, "fixels that are not there", f"as many as directions, {n}")
    fixels = Fixels(counts, first, np.ascontiguousarray(directions[..., 0], np.float32), folder=beside[0].parent)
    name = path.resolve().name if path.is_dir() else str(_stem(path))
    if numbers is None:
        return fixels, affine, name
    if len(numbers) != n:
        raise FormatError(path, None, f"the shape {numbers.shape}", f"({n}, m, 1): a row for each fixel")
    rows = numbers[..., 0].astype(np.float32)
    columns = {name if k == 0 else f"{name} {k + 1}": column for k, column in enumerate(rows.T)}
    return Fixels(counts, first, fixels.directions, columns, fixels.folder, name), affine, name
