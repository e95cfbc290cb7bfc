"""The kind of layer of a file, by its suffix, and by its content for ambiguous suffixes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pvfiblets.codec.shards.manifest import is_set_in_shards
from pvfiblets.errors import FormatError
from pvfiblets.formats.registry import UnknownFormatError, is_trx_folder, suffix_of, suffixes
from pvfiblets.formats.vtk_files import sizes
from pvfiblets.images.files import SUFFIXES as VOLUMES
from pvfiblets.volumes.freesurfer_files import SURFACES as FREESURFER
from pvfiblets.volumes.freesurfer_files import VALUES as OF_FREESURFER
from pvfiblets.volumes.gifti_files import SUFFIXES as GIFTI
from pvfiblets.volumes.gifti_files import VALUES as OF_GIFTI

__all__ = [
    "GIFTI", "MESHES", "OF_VERTICES", "SPACED", "TABLES", "VALUES", "VOLUMES", "VTK_SUFFIXES", "is_tractogram_folder",
    "kind_of", "read_vtk",
]  # fmt: skip

MESHES = (".ply", ".stl", ".obj", ".vtu", ".vtp", ".vtk", ".off", ".glb", ".gltf", *GIFTI, *FREESURFER)
"""Suffixes of surfaces; files of VTK's formats may hold lines instead."""

OF_VERTICES = (*OF_GIFTI, *OF_FREESURFER)  # suffixes of files with a number or a label for each vertex of a surface

VALUES = (".tsf", ".csv", ".tsv", ".txt", ".npy", *OF_VERTICES)
"""Suffixes of files with values for the lines, or for the vertices, of another file."""

TABLES = (".txt", ".ctab", ".label", ".lbl", ".tsv", ".label.gii", ".label.gii.gz")
"""Suffixes of files with names and colours of labels."""

VTK_SUFFIXES = (".vtk", ".vtp")  # suffixes of VTK's files that hold lines, surfaces or volumes

SPACED = (*VTK_SUFFIXES, ".fib", ".vtu")
"""Suffixes of files that need not name the space of their coordinates: RAS+ or LPS+."""

_RADII = ("radius", "Radius", "MaximumInscribedSphereRadius")


def kind_of(path: Path) -> str:
    """Return the kind of layer that a file is for."""
    name = path.name.lower()
    if name.endswith(VOLUMES):
        return "volume"
    if name.endswith(VTK_SUFFIXES):
        import pyvista as pv

        data = read_vtk(path)
        if isinstance(data, pv.ImageData):
            return "volume"
        if isinstance(data, pv.PolyData) and data.n_lines:
            return "tubes" if any(radius in data.point_data for radius in _RADII) else "tractogram"
        return "mesh"
    if name.endswith(MESHES):
        return "mesh"
    try:
        suffix_of(path)
    except UnknownFormatError:
        known = ", ".join(dict.fromkeys([*suffixes(), *VOLUMES, *MESHES]))
        raise UnknownFormatError(f"{path.name}: this type of file cannot be opened; known types: {known}") from None
    return "tractogram"


def is_tractogram_folder(path: Path) -> bool:
    """Return whether a folder is opened as one tractogram: a set in shards, or the arrays of a TRX file."""
    return is_set_in_shards(path) or is_trx_folder(path)


def read_vtk(place: Path) -> Any:
    """Read a file with one of VTK's readers, which end the process where memory does not suffice."""
    from pvfiblets.plotting.meshes import read_mesh

    sizes.check_memory(place)
    try:
        return read_mesh(place)
    except RuntimeError:  # PyVista's error when VTK's reader returned nothing
        raise FormatError(place, None, "what VTK's reader cannot read", "a whole file of this kind") from None
