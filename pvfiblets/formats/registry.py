"""The modules that read and write each suffix.

A format module offers ``read(path, *, progress=False)``, ``iter_chunks(path, max_points)`` and
``info(path)``, and where the format can be written ``write(path, streamlines)``. Modules are
named by strings and imported when a file of theirs is first touched: a program that reads tck
files never loads the trx code. One of them belongs to the codec; only this table refers to it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from importlib import import_module
from os import PathLike, fspath
from pathlib import Path
from types import ModuleType

from pvfiblets.errors import FibletsError

_MODULES: dict[str, str] = {
    ".tck": "pvfiblets.formats.tck",
    ".trk": "pvfiblets.formats.trackvis.trk",
    ".trk.gz": "pvfiblets.formats.trackvis.trk_gz",
    ".trx": "pvfiblets.formats.trx",
    ".vtk": "pvfiblets.formats.vtk_files.legacy",
    ".vtp": "pvfiblets.formats.vtk_files.vtp",
    ".tt.gz": "pvfiblets.formats.tinytrack",
    ".fib": "pvfiblets.formats.vtk_files.legacy",
    ".fiblets": "pvfiblets.codec.files.fiblets_format",
}
READ_BY_VTK = (".vtu", ".pvtu", ".pvtp", ".vtm", ".vtmb", ".vtkhdf")
_READ_BY_LIBRARIES = {
    **dict.fromkeys(READ_BY_VTK, "pvfiblets.formats.vtk_files.by_vtk"),
    ".dpy": "pvfiblets.formats.dpy",
}
"""Not for files of strangers: VTK and HDF5 trust their sizes, and VTK opens the files that they name."""


class UnknownFormatError(FibletsError, ValueError):
    """An unknown suffix, or a format without the requested operation."""


def register(suffix: str, module_name: str) -> None:
    """Register `module_name` for files whose name ends in `suffix`."""
    if not suffix.startswith("."):
        raise ValueError(f"the suffix {suffix!r} must begin with a dot, as in '.trk'")
    _MODULES[suffix.lower()] = module_name


def suffixes() -> tuple[str, ...]:
    """Return every suffix of files of any source, longest first."""
    return tuple(sorted(_MODULES, key=lambda s: (-len(s), s)))


def suffix_of(path: str | PathLike[str]) -> str:
    """Return the registered suffix that the name of `path` ends with, the longest that fits."""
    name = fspath(path).lower()
    for suffix in (*suffixes(), *_READ_BY_LIBRARIES):
        if name.endswith(suffix):
            return suffix
    known = ", ".join(sorted((*_MODULES, *_READ_BY_LIBRARIES)))
    if is_trx_folder(path):
        return ".trx"
    if os.path.isdir(path):  # noqa: PTH112 - also for invalid paths
        raise UnknownFormatError(f"{fspath(path)} is a folder; give a file of one of {known}")
    raise UnknownFormatError(
        f"{fspath(path)}: no format has this suffix; rename the file or convert it to one of {known}"
    )


def is_trx_folder(path: str | PathLike[str]) -> bool:
    """Return whether a path is a folder of the arrays of a TRX file."""
    place = Path(path)
    return (place / "header.json").is_file() and any(place.glob("positions.*"))


def module_for(path: str | PathLike[str], *needs: str) -> ModuleType:
    """Import the module that serves `path`."""
    suffix = suffix_of(path)
    module = import_module(_MODULES.get(suffix) or _READ_BY_LIBRARIES[suffix])
    for need in needs:
        if not hasattr(module, need):
            able = ", ".join(_able(need))
            raise UnknownFormatError(f"{fspath(path)}: the format {suffix} has no {need}(); formats that have: {able}")
    return module


def _able(need: str) -> Iterator[str]:
    for suffix in sorted(_MODULES):
        try:
            if hasattr(import_module(_MODULES[suffix]), need):
                yield suffix
        except ImportError:
            continue
