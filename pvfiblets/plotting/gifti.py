"""Surfaces of GIFTI as PyVista's meshes, with the numbers and labels of their vertices."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv

from pvfiblets.errors import FormatError
from pvfiblets.slices.labels import table_of_gifti
from pvfiblets.volumes.gifti_files import SUFFIXES, read_gifti

__all__ = ["read_surface", "with_vertex_values"]

POINTS, TRIANGLES, LABELS = 1008, 1009, 1002
"""NIFTI_INTENT_POINTSET, NIFTI_INTENT_TRIANGLE and NIFTI_INTENT_LABEL."""


def read_surface(path: str | PathLike[str]) -> pv.PolyData:
    """Read a surface from a file of GIFTI, such as ``lh.pial.surf.gii``."""
    place = Path(path).expanduser()
    image = read_gifti(place)
    points = [one.data for one in image.darrays if one.intent == POINTS]
    faces = [one.data for one in image.darrays if one.intent == TRIANGLES]
    if len(points) != 1 or len(faces) != 1:
        raise FormatError(
            place, None, f"{len(points)} sets of points and {len(faces)} of triangles",
            "a surface, such as .surf.gii: one of each; numbers of vertices are given to a surface",
        )  # fmt: skip
    corners, triangles = np.asarray(points[0], np.float64), np.asarray(faces[0])
    if corners.ndim != 2 or corners.shape[1] != 3 or triangles.ndim != 2 or triangles.shape[1] != 3:
        found = f"shapes {corners.shape} and {triangles.shape}"
        raise FormatError(place, None, found, "(n, 3) points and (m, 3) corners of triangles")
    if not np.isfinite(corners).all():
        raise FormatError(place, None, "points that are no numbers", "finite mm")
    reach = (int(triangles.min()), int(triangles.max())) if triangles.size else (0, -1)
    if triangles.dtype.kind not in "iu" or reach[0] < 0 or reach[1] >= len(corners):
        raise FormatError(place, None, "corners that are no numbers of points", f"0 to {len(corners) - 1}")
    mesh = pv.PolyData.from_regular_faces(corners, triangles.astype(np.int64))
    _add(mesh, place, image)
    return mesh


def with_vertex_values(mesh: pv.PolyData, path: str | PathLike[str]) -> pv.PolyData:
    """Return a surface with the numbers of a file of GIFTI as point data."""
    place = Path(path).expanduser()
    found = mesh.copy(deep=False)
    if not _add(found, place, read_gifti(place)):
        raise FormatError(place, None, "no numbers of vertices", f"one for each of the mesh's {mesh.n_points:,}")
    return found


def name_of(path: str | PathLike[str]) -> str:
    """Return what numbers of a file are called: its name, without suffix."""
    name = Path(fspath(path)).name
    lower = name.lower()
    name = name[: -len(next((one for one in reversed(SUFFIXES) if lower.endswith(one)), "")) or None]
    return name.removesuffix(".label").removesuffix(".shape").removesuffix(".func").removesuffix(".surf")


def _add(mesh: pv.PolyData, place: Path, image: Any) -> list[str]:
    """Add numbers of vertices to a mesh; return their names."""
    arrays = [one for one in image.darrays if one.intent not in (POINTS, TRIANGLES)]
    names: list[str] = []
    for one in arrays:
        values = np.asarray(one.data)
        if not values.ndim or len(values) != mesh.n_points:
            raise FormatError(
                place, None, f"numbers for {len(values) if values.ndim else 1:,} vertices",
                f"one for each of the mesh's {mesh.n_points:,}: give the surface that they are of",
            )  # fmt: skip
        name = name_of(place) if not names else f"{name_of(place)} {len(names) + 1}"
        values = values.astype(values.dtype.newbyteorder("="))  # VTK takes the machine's order alone
        mesh.point_data[name] = values[:, 0] if values.ndim == 2 and values.shape[1] == 1 else values
        names.append(name)
        if one.intent == LABELS:
            numbers, codes = np.unique(values.ravel().astype(np.int64), return_inverse=True)
            table = table_of_gifti(place, image)
            colours = table.rows(numbers)
            for row, number in enumerate(numbers.tolist()):  # of surfaces label 0 has its colour, too
                colours[row] = table.colours.get(number, colours[row])
            colours[colours[:, 3] == 0, :3] = 128  # what is not to be seen of a surface is grey
            mesh.point_data[f"{name}_rgb"] = colours[codes.ravel(), :3]
    return names
