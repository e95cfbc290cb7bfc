"""Reading volumes from MetaImage files (``.mhd``, ``.mha``).

VTK's reader gives the numbers. Where they lie is taken from the header: the reader transposes the directions, which
MetaImage lists axis by axis, and ITK, whose format this is, means LPS+ by its coordinates.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.errors import FormatError

__all__ = ["read_metaimage"]

LONGEST_HEADER = 1 << 16
PLACES = ("offset", "position", "origin")
DIRECTIONS = ("transformmatrix", "orientation", "rotation")

Array = npt.NDArray[np.float64]


def read_metaimage(path: str | os.PathLike[str]) -> tuple[npt.NDArray[Any], Array]:
    """Read a volume.

    Parameters
    ----------
    path : str or PathLike
        The file, or of data kept apart its header.

    Returns
    -------
    values : ndarray
        ``(nx, ny, nz)``, of the file's type.
    affine : ndarray
        ``(4, 4)`` voxel indices to mm, RAS+.

    Raises
    ------
    FileNotFoundError
        If the file, or the one of its data, is not there.
    FormatError
        If it is not such a file, is damaged, or has other than three axes or more than one number per voxel.
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOImage import vtkMetaImageReader

    from .vtk_files import read

    path = Path(path)
    fields = _fields(path)
    dims = _numbers(path, fields, ("dimsize",), None)
    if dims is None:
        raise FormatError(path, None, "no field DimSize", "a MetaImage header with one")
    if len(dims) != 3 or fields.get("elementnumberofchannels", "1").strip() != "1":
        channels = fields.get("elementnumberofchannels", "1")
        raise FormatError(
            path, None, f"{len(dims)} axes and {channels} numbers per voxel",
            "three axes and one number per voxel: save one of its volumes or components",
        )  # fmt: skip
    affine = _affine(path, fields)
    data = fields.get("elementdatafile", "LOCAL")
    if data.upper() not in ("LOCAL", "LIST") and "%" not in data and not (path.parent / data).exists():
        raise FileNotFoundError(f"{path}: its data are in {data!r}, and there is no file {path.parent / data}")
    image = read(vtkMetaImageReader(), path)
    scalars = image.GetPointData().GetScalars()
    shape = image.GetDimensions()
    if scalars is None or list(shape) != dims.astype(int).tolist():
        raise FormatError(path, None, f"{' x '.join(map(str, shape))} voxels", f"DimSize = {fields['dimsize']}")
    return vtk_to_numpy(scalars).reshape(shape, order="F"), affine


def _fields(path: Path) -> dict[str, str]:
    """The header's fields, names in lower case."""
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
                    return fields
                continue
            fields[name.strip().lower()] = value.strip()
            if name.strip().lower() == "elementdatafile":  # always the last
                return fields
    return fields


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


def _affine(path: Path, fields: dict[str, str]) -> Array:
    spacing = _numbers(path, fields, ("elementspacing", "elementsize"), 3)
    directions = _numbers(path, fields, DIRECTIONS, 9)
    origin = _numbers(path, fields, PLACES, 3)
    affine = np.eye(4)
    columns = np.eye(3) if directions is None else directions.reshape(3, 3).T
    affine[:3, :3] = columns * (1.0 if spacing is None else spacing)
    affine[:3, 3] = 0.0 if origin is None else origin
    affine[:2] *= -1.0  # LPS+ to RAS+
    return affine
