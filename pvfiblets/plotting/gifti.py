"""Surfaces of GIFTI and FreeSurfer as PyVista's meshes, with the numbers and labels of their vertices."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pyvista as pv

from pvfiblets.errors import FormatError
from pvfiblets.slices.labels import table_of_gifti
from pvfiblets.support.surface_space import NO_VOLUME, Placed, in_scanner_space, numbers_of
from pvfiblets.volumes import freesurfer_files
from pvfiblets.volumes.gifti_files import SUFFIXES, read_gifti

POINTS, TRIANGLES, LABELS = 1008, 1009, 1002  # NIFTI_INTENT_POINTSET, NIFTI_INTENT_TRIANGLE and NIFTI_INTENT_LABEL
SCANNER = 1  # NIFTI_XFORM_SCANNER_ANAT

Array = npt.NDArray[np.float64]


def placed_surface(path: str | PathLike[str]) -> tuple[pv.PolyData, Placed]:
    """Read the surface of a file such as ``lh.pial.surf.gii`` or FreeSurfer's ``lh.pial``, and what places it."""
    place = Path(path).expanduser()
    if place.name.lower().endswith(freesurfer_files.SURFACES):
        corners, triangles, footer = freesurfer_files.read_geometry(place)
        placed = _of_footer(place, _checked(place, corners, triangles), footer)
        return pv.PolyData.from_regular_faces(placed.points, triangles.astype(np.int64)), placed
    image = read_gifti(place)
    points = [one for one in image.darrays if one.intent == POINTS]
    faces = [one.data for one in image.darrays if one.intent == TRIANGLES]
    if len(points) != 1 or len(faces) != 1:
        raise FormatError(
            place, None, f"{len(points)} sets of points and {len(faces)} of triangles",
            "a surface, such as .surf.gii: one of each; numbers of vertices are given to a surface",
        )  # fmt: skip
    corners, triangles = np.asarray(points[0].data, np.float64), np.asarray(faces[0])
    placed = _of_metadata(place, _checked(place, corners, triangles), points[0], image)
    mesh = pv.PolyData.from_regular_faces(placed.points, triangles.astype(np.int64))
    _add(mesh, place, image)
    return mesh, placed


def _checked(place: Path, corners: Array, triangles: Any) -> Array:
    """Return the points of a surface, if they and its triangles are right."""
    if corners.ndim != 2 or corners.shape[1] != 3 or triangles.ndim != 2 or triangles.shape[1] != 3:
        found = f"shapes {corners.shape} and {triangles.shape}"
        raise FormatError(place, None, found, "(n, 3) points and (m, 3) corners of triangles")
    if not np.isfinite(corners).all():
        raise FormatError(place, None, "points that are no numbers", "finite mm")
    reach = (int(triangles.min()), int(triangles.max())) if triangles.size else (0, -1)
    if triangles.dtype.kind not in "iu" or reach[0] < 0 or reach[1] >= len(corners):
        raise FormatError(place, None, "corners that are no numbers of points", f"0 to {len(corners) - 1}")
    return corners


def _of_metadata(place: Path, corners: Array, points: Any, image: Any) -> Placed:
    """Return points of GIFTI in the scanner's space, by FreeSurfer's metadata."""
    if points.coordsys is not None and points.coordsys.dataspace == SCANNER:
        return Placed(corners)
    said = dict(image.meta or {}) | dict(points.meta or {})
    names = [f"VolGeomC_{axis}" for axis in "RAS"]
    if not all(name in said for name in names):
        return Placed(corners, space_from=NO_VOLUME)
    middle = numbers_of([said[name] for name in names])
    if middle is None:
        found = ", ".join(f"{name} {said[name]!r}" for name in names)
        raise FormatError(place, None, f"the metadata {found}", "three finite mm, or none for points in place")
    axes = [numbers_of([said.get(f"VolGeom{axis}_{way}") for way in "RAS"]) for axis in "XYZ"]
    known = [one for one in axes if one is not None]
    return in_scanner_space(place, corners, middle, known if len(known) == len(axes) else None)


def _of_footer(place: Path, corners: Array, footer: dict[str, Any]) -> Placed:
    """Return points of FreeSurfer's own format in the scanner's space."""
    if list(footer.get("head", ()))[:2] == [2, 1]:  # moved by mris_convert --to-scanner
        return Placed(corners)
    middle, *axes = (footer.get(name, np.zeros(0)) for name in ("cras", "xras", "yras", "zras"))
    if not str(footer.get("valid", "")).startswith("1") or middle.shape != (3,):
        return Placed(corners, space_from=NO_VOLUME)
    return in_scanner_space(place, corners, middle, axes if all(one.shape == (3,) for one in axes) else None)


def with_vertex_values(mesh: pv.PolyData, path: str | PathLike[str]) -> pv.PolyData:
    """Return a surface with the numbers or labels of a file of GIFTI or FreeSurfer as point data."""
    place = Path(path).expanduser()
    found = mesh.copy(deep=False)
    if place.name.lower().endswith(freesurfer_files.VALUES):
        return _with_freesurfer(found, place)
    if not _add(found, place, read_gifti(place)):
        raise FormatError(place, None, "no numbers of vertices", f"one for each of the mesh's {mesh.n_points:,}")
    return found


def shown_array(mesh: pv.DataSet, path: str | PathLike[str]) -> str:
    """Return the array to colour by of a file of values: of labels, the colours of their table."""
    name = name_of(path)
    return f"{name}_rgb" if f"{name}_rgb" in mesh.point_data else name


def _with_freesurfer(mesh: pv.PolyData, place: Path) -> pv.PolyData:
    """Return a mesh that was copied with the numbers, or the labels and their colours, of a file of FreeSurfer."""
    name, colours = name_of(place), None
    values: npt.NDArray[Any]
    if place.name.lower().endswith(".annot"):
        values, colours = freesurfer_files.read_annotation(place)
    else:
        values = freesurfer_files.read_numbers(place)
    _check_length(mesh, place, len(values))
    mesh.point_data[name] = values
    if colours is not None:
        mesh.point_data[f"{name}_rgb"] = colours
    return mesh


def name_of(path: str | PathLike[str]) -> str:
    """Return what numbers of a file are called: its name, without suffix."""
    name = Path(fspath(path)).name
    lower = name.lower()
    ends = (*reversed(SUFFIXES), ".annot")
    name = name[: -len(next((one for one in ends if lower.endswith(one)), "")) or None]
    return name.removesuffix(".label").removesuffix(".shape").removesuffix(".func").removesuffix(".surf")


def _check_length(mesh: pv.PolyData, place: Path, n: int) -> None:
    if n != mesh.n_points:
        raise FormatError(
            place, None, f"numbers for {n:,} vertices",
            f"one for each of the mesh's {mesh.n_points:,}: give the surface that they are of",
        )  # fmt: skip


def _add(mesh: pv.PolyData, place: Path, image: Any) -> list[str]:
    """Add numbers of vertices to a mesh; return their names."""
    arrays = [one for one in image.darrays if one.intent not in (POINTS, TRIANGLES)]
    names: list[str] = []
    for one in arrays:
        values = np.asarray(one.data)
        _check_length(mesh, place, len(values) if values.ndim else 1)
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
            colours[colours[:, 3] == 0, :3] = 128  # invisible parts of a surface are grey
            mesh.point_data[f"{name}_rgb"] = colours[codes.ravel(), :3]
    return names
