"""Tractogram files: one module per format, chosen by suffix.

========== ===== ====== ======================= ================================================
suffix     reads writes streams in small memory carries
========== ===== ====== ======================= ================================================
.tck       yes   yes    yes (memory map)        points
.trk       yes   yes    yes (memory map)        points, per point, per streamline, affine
.trk.gz    yes   no     yes (inflates on)       as trk
.trx       yes   yes    yes (memory map, or     everything; a folder is read too
                        inflates on)
.vtk       yes   yes    after reading the file  points, per point, per streamline
.vtp       yes   yes    after reading the file  points, per point, per streamline
.fib       yes   yes    after reading the file  as vtk: DIPY's
.vtu .vtm  yes   no     after reading the file  as vtp, and blocks as groups; also .vtkhdf .pvtp .pvtu .vtmb
.dpy       yes   no     after reading the file  points
.tt.gz     yes   no     after inflating         points, clusters as groups, affine
.fiblets   yes   yes    yes                     everything
========== ===== ====== ======================= ================================================

Reading a file has one of three results: Streamlines; Streamlines whose ``dropped`` counts the
omitted parts by reason; or a :class:`~pvfiblets.errors.FormatError` with the byte, the value found
and the value expected.
"""

from __future__ import annotations

from collections.abc import Iterator
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from pvfiblets.errors import FormatError
from pvfiblets.formats import registry
from pvfiblets.formats.registry import UnknownFormatError, module_for, suffix_of
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.addresses import is_url, path_of
from pvfiblets.support.vtk_space import Space, checked

__all__ = [
    "FormatError",
    "UnknownFormatError",
    "attach",
    "info",
    "iter_chunks",
    "read",
    "write",
]

DOUBLES = (".tck", ".vtk")  # suffixes of formats with float32 points unless doubles are requested


SPACED = (".vtk", ".vtp", ".fib", *registry.READ_BY_VTK)  # suffixes of formats that do not fix the space of points


def read(path: str | PathLike[str], *, progress: bool = False, space: str | None = None) -> Streamlines:
    """Read a tractogram file.

    Parameters
    ----------
    path : str or PathLike
        Its suffix chooses the format.
    progress : bool
        Show a progress bar, for formats whose reading takes long.
    space : {"RAS", "LPS"}, optional
        Space of the points in a VTK file that names none; RAS by default. DIPY wrote LPS up to 1.11.

    Returns
    -------
    Streamlines
        RAS+ mm. ``dropped`` counts the omitted parts.

    Raises
    ------
    FormatError
        If the file is damaged and cannot be read safely.
    UnknownFormatError
        If no format has this suffix.
    ValueError
        If `space` is unknown, or given for a format that fixes the space.
    """
    place = _place(path)
    streamlines: Streamlines = module_for(place, "read").read(place, progress=progress, **_space(place, space))
    return streamlines


def iter_chunks(
    path: str | PathLike[str], max_points: int = 1 << 22, *, space: str | None = None
) -> Iterator[Streamlines]:
    """Read a tractogram file in pieces.

    Parameters
    ----------
    path : str or PathLike
    max_points : int
        Points per piece; a single streamline that is longer makes a piece of its own.
    space : {"RAS", "LPS"}, optional
        As for :func:`read`.

    Yields
    ------
    Streamlines
        Consecutive streamlines, at least one piece even for an empty file; joined by
        :meth:`Streamlines.concatenate` they equal what :func:`read` gives. The memory used
        depends on `max_points` and not on the file's size, save for the formats that this
        module's table marks.

    Raises
    ------
    FormatError
        As for :func:`read`, when the reading gets there.
    """
    if max_points < 1:
        raise ValueError(f"max_points is {max_points}, expected at least 1")
    place = _place(path)
    yield from module_for(place, "iter_chunks").iter_chunks(place, max_points, **_space(place, space))


def info(path: str | PathLike[str], *, space: str | None = None) -> dict[str, Any]:
    """Facts of a file, from its header where the format has them there."""
    place = _place(path)
    return {"format": suffix_of(place), **module_for(place, "info").info(place, **_space(place, space))}


def _space(place: str | Path, space: str | None) -> dict[str, Space]:
    """Return the arguments for formats without a fixed space."""
    if space is None:
        return {}
    if suffix_of(place) not in SPACED:
        raise ValueError(f"{place}: space is an option of {', '.join(SPACED)} files; leave it out")
    return {"space": checked(space)}


def _place(path: str | PathLike[str]) -> str | Path:
    """A path with its ``~`` expanded, or an address of a format that is read from there."""
    return fspath(path) if is_url(path) and suffix_of(path) == ".fiblets" else path_of(path)


def write(path: str | PathLike[str], streamlines: Streamlines, *, double: bool = False) -> list[str]:
    """Write a tractogram file; it appears under its name only when it is complete.

    Parameters
    ----------
    path : str or PathLike
        Its suffix chooses the format.
    streamlines : Streamlines
    double : bool
        Write the points of a ``.tck`` or ``.vtk`` file as float64. MRtrix reads such ``.tck`` files; nibabel, DIPY and
        scilpy refuse them. MRtrix takes the doubles of a ``.vtk`` file for floats. Otherwise points are float32, and a
        warning states the error where it is over a micrometre. The other formats take no such option: ``.trk`` holds
        float32 only, ``.trx`` and ``.vtp`` keep the type.

    Returns
    -------
    list of str
        What the format cannot hold and was left out, such as ``"groups"`` in a trk file.

    Raises
    ------
    UnknownFormatError
        If no format has this suffix, or it cannot be written.
    TypeError
        If there are no Streamlines to be written.
    ValueError
        If a name or value does not fit the format, with the fix.
    """
    path = path_of(path)
    module = module_for(path, "write")
    if not isinstance(streamlines, Streamlines):
        raise TypeError(
            f"write takes a path and Streamlines, got {type(streamlines).__name__}; Streamlines.from_list(arrays) "
            "makes some, and a FibletSet has save(path)"
        )
    if double and suffix_of(path) not in DOUBLES:
        raise ValueError(f"{path}: double is an option of {' and '.join(DOUBLES)} files; leave it out")
    module.write(path, streamlines, **({"double": True} if double else {}))
    holds = getattr(module, "HOLDS", None)
    parts = ("per_point", "per_streamline", "groups", "per_group")
    if holds is None:
        return []
    return [part for part in parts if getattr(streamlines, part) and part not in holds]


def attach(streamlines: Streamlines, path: str | PathLike[str], name: str | None = None) -> str:
    """Add the values of a side file to the streamlines (see :mod:`pvfiblets.formats.attachments`).

    Parameters
    ----------
    streamlines : Streamlines
        Changed in place.
    path : str or PathLike
        ``.tsf`` (per point), ``.npy`` or ``.txt`` (per point or per streamline, by their count).
    name : str, optional
        Under which the values are kept; the file's name without suffix if not given.

    Returns
    -------
    str
        ``"per_point"`` or ``"per_streamline"``: where the values went.

    Raises
    ------
    FormatError
        If the file is damaged, or its counts fit neither points nor streamlines.
    """
    from pvfiblets.formats import attachments

    return attachments.attach(streamlines, path_of(path), name)
