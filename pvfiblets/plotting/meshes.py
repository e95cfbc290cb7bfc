"""Surfaces of every format that PyVista or this package reads, in RAS+ mm."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

import pyvista as pv

from pvfiblets.formats.registry import READ_BY_VTK
from pvfiblets.support.surface_space import as_stored, tkras_chosen
from pvfiblets.support.vtk_space import (
    FIELD,
    OURS,
    Space,
    checked,
    space_in_header,
    space_of_dataset,
    space_taken,
    unnamed,
)
from pvfiblets.volumes.freesurfer_files import SURFACES as FREESURFER
from pvfiblets.volumes.gifti_files import SUFFIXES as GIFTI

SUFFIXES = (".ply", ".stl", ".obj", ".off", *GIFTI, *FREESURFER)  # suffixes of files that hold only surfaces

OF_VTK = (".vtk", ".vtp", *READ_BY_VTK)
_HEAD = 1 << 16  # bytes in which titles and comments are looked for


def read_mesh(path: str | PathLike[str], *, space: str | None = None, tkras: bool | None = None) -> Any:
    """Read a surface of any format, GIFTI and FreeSurfer's included, in RAS+ mm.

    Parameters
    ----------
    path : str or PathLike
    space : {"RAS", "LPS"}, optional
        Of coordinates in a file of VTK (``.vtk``, ``.vtp``, ``.vtu`` and others) that names none; RAS by default.
    tkras : bool, optional
        Whether surfaces of FreeSurfer, GIFTI or not, stay in its surface space. By default they are moved to the
        scanner's space, by ``c_ras`` of the file, unless the file says that they are there (its coordinate system is
        the scanner's, or ``c_ras`` is 0).

    Returns
    -------
    pyvista.DataSet or pyvista.MultiBlock
        A mesh whose file names LPS+ as its space, as 3D Slicer writes it (the header of ``.stl``, a comment of ``.ply``
        and ``.obj``, the title of ``.vtk``, field data), has x and y negated, with its normals and vectors, and the
        field array ``SPACE`` says ``RAS``. Of files without a name, coordinates are as they are.

    Raises
    ------
    ValueError
        If the file holds no points, or `space` is unknown.
    """
    return _read(Path(path).expanduser(), space, tkras)[0]


def mesh_facts(path: str | PathLike[str]) -> dict[str, Any]:
    """Return the facts of a surface's file: counts, bounds in RAS+ mm, its space, and how it is moved from there."""
    place = Path(path).expanduser()
    mesh, of_space = _read(place)
    whole = mesh.combine() if isinstance(mesh, pv.MultiBlock) else mesh
    surface = isinstance(whole, pv.PolyData)
    triangles = whole.is_all_triangles if surface else set(whole.celltypes) == {pv.CellType.TRIANGLE}
    return {
        "format": next((one for one in SUFFIXES if place.name.lower().endswith(one)), place.suffix.lower()),
        "points": whole.n_points,
        "triangles" if triangles else "cells": whole.n_cells,
        "per_point": list(whole.point_data),
        "bounds_mm": list(whole.bounds),
        **of_space,
    }


def _read(place: Path, space: str | None = None, tkras: bool | None = None) -> tuple[Any, dict[str, Any]]:
    """Return the surface in a file, in RAS+ mm, and the facts of its space."""
    if place.name.lower().endswith((*GIFTI, *FREESURFER)):
        from pvfiblets.plotting.gifti import placed_surface

        with as_stored(tkras_chosen() if tkras is None else tkras):
            found, placed = placed_surface(place)
        return found, {"space": placed.space, "space_from": placed.space_from, "moved": placed.moved}
    mesh = pv.read(place)
    if isinstance(mesh, pv.DataSet) and not mesh.n_points:
        raise ValueError(f"{place} has no points to draw; check the program that wrote it")
    named, given = space_of_file(place, mesh), None if space is None else checked(space)
    of_vtk = place.name.lower().endswith(OF_VTK)
    taken = named or ((given or unnamed()) if of_vtk else None)
    why = space_taken(named, given)[1] if named or of_vtk else "assumed, the file names none"
    moved = "x and y negated" if taken == "LPS" else None
    return _in_ras(mesh, taken), {"space": taken or OURS, "space_from": why, "moved": moved}


def _in_ras(mesh: Any, space: Space | None) -> Any:
    """Return a mesh in RAS+; the blocks of a MultiBlock are in its space unless they name another."""
    if isinstance(mesh, pv.MultiBlock):
        for i, block in enumerate(mesh):
            if block is not None:
                mesh.replace(i, _in_ras(block, space_of_dataset(block) or space))
    elif isinstance(mesh, (pv.PolyData, pv.UnstructuredGrid, pv.StructuredGrid)) and space == "LPS":
        mesh = mesh.transform([[-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], inplace=False)
    else:
        return mesh
    if space is not None:
        mesh.field_data[FIELD] = [OURS]
    return mesh


def space_of_file(path: str | PathLike[str], mesh: Any) -> Space | None:
    """Return the space that a file names for its points, in its header or in the mesh's field data; None if none."""
    return space_in_header(_header(Path(path)), str(path)) or space_of_dataset(mesh)


def _header(place: Path) -> str:
    """Return the title or the comments of a file."""
    with place.open("rb") as file:
        head = file.read(_HEAD).decode("latin-1")
    lines = head.splitlines()
    match place.suffix.lower():
        case ".stl":
            return lines[0] if head.startswith("solid") and lines else head[:80]
        case ".vtk":
            return "".join(lines[1:2])
        case ".ply":
            lines = head.partition("end_header")[0].splitlines()
            return "\n".join(line for line in lines if line.startswith("comment"))
        case ".obj":
            return "\n".join(line for line in lines if line.startswith("#"))
    return ""
