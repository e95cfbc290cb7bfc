"""From what users hold to regions: meshes, bounds, planes and label volumes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.query.measures.image_samples import three_axes
from pvfiblets.support.nifti_space import affine_of
from pvfiblets.support.vtk_space import space_of_dataset, to_ras
from pvfiblets.volumes.freesurfer_files import SURFACES as FREESURFER
from pvfiblets.volumes.gifti_files import SUFFIXES as GIFTI

if TYPE_CHECKING:
    from pvfiblets.regions import Region

__all__ = ["as_region", "direction_of", "slab"]

OTHERS = (".mif", ".mif.gz", ".mih", ".nrrd", ".nhdr", ".mhd", ".mha", ".vti")
"""Suffixes of volumes that nibabel does not read."""
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def as_region(what: Any) -> Region:
    """Return the region that something stands for."""
    from pvfiblets import regions

    if isinstance(what, regions.Region):
        return what
    if isinstance(what, pv.DataSet) or hasattr(what, "IsA"):
        dataset = pv.wrap(what)
        if isinstance(dataset, pv.PolyData):
            return _surface(dataset)
        if isinstance(dataset, pv.ImageData):
            return _image_labels(dataset)
        raise TypeError(
            f"a {type(dataset).__name__} is no region; give its surface: "
            "dataset.extract_surface().triangulate()"
        )
    if isinstance(what, str) and what.lstrip("+-").lower() in AXES:
        raise ValueError(f"{what!r} is an axis, and no region; give the plane as ({what!r}, origin)")
    if isinstance(what, (str, Path)) and str(what).lower().endswith(OTHERS):
        from pvfiblets.slices.image import as_slice_image

        image = as_slice_image(what)
        return regions.Labels(_whole_numbers(image.values), image.affine)
    if isinstance(what, (str, Path)) and str(what).lower().endswith((*GIFTI, *FREESURFER)):
        from pvfiblets.plotting.meshes import read_mesh

        return _surface(read_mesh(what))
    if isinstance(what, (str, Path)):
        import nibabel

        what = nibabel.load(what)
    if hasattr(what, "affine") and hasattr(what, "dataobj"):
        affine = affine_of(what)
        if affine is None:
            raise ValueError("the image has no affine; give regions.Labels(array, affine)")
        return regions.Labels(_whole_numbers(np.asanyarray(what.dataobj)), affine)
    if isinstance(what, np.ndarray) and what.ndim == 3:
        raise TypeError(
            f"an array of shape {what.shape} is no region: it does not say where it lies; "
            "give regions.Labels(array, affine)"
        )
    numbers = _numbers(what)
    if numbers is not None and numbers.shape == (6,):
        return regions.Box(numbers)
    if isinstance(what, (tuple, list)) and len(what) == 2:
        normal, origin = what
        return regions.Plane(direction_of(normal), origin)
    raise TypeError(
        f"{what!r} is no region; give one of pvfiblets.regions, a closed mesh, "
        "(xmin, xmax, ymin, ymax, zmin, zmax), or (normal, origin)"
    )


def slab(normal: Any, origin: Any, thickness: float) -> Region:
    """Return a slab; an origin that is one number counts along the normal, which is an axis."""
    from pvfiblets import regions

    direction = np.asarray(direction_of(normal), float)
    if np.ndim(origin) == 0:
        origin = float(origin) * direction / np.linalg.norm(direction)
    return regions.Slab(direction, origin, thickness)


def _surface(mesh: pv.PolyData) -> Region:
    from pvfiblets import regions

    if mesh.GetNumberOfPolys() + mesh.GetNumberOfStrips() == 0:
        raise ValueError(
            f"the mesh has {mesh.n_points} points and no faces, and encloses nothing; give a closed surface"
        )
    triangles = mesh if mesh.is_all_triangles else mesh.triangulate()
    faces = np.asarray(triangles.regular_faces, np.int64)
    return regions.Surface(to_ras(np.asarray(mesh.points, np.float64), space_of_dataset(mesh)), faces)


def _image_labels(image: pv.ImageData) -> Region:
    from pvfiblets import regions

    values = image.active_scalars
    if values is None or values.ndim != 1:
        raise ValueError("the image has no active data of one number each; set_active_scalars()")
    of_cells = image.active_scalars_info.association == pv.FieldAssociation.CELL
    sides = tuple(max(n - 1, 1) if of_cells else n for n in image.dimensions)
    volume = np.asarray(values).reshape(sides, order="F")
    affine = np.eye(4)
    affine[:3, :3] = np.asarray(image.direction_matrix) * np.asarray(image.spacing)
    affine[:3, 3] = image.origin
    # Extents need not begin at zero; points count from the first one that there is, voxels from its middle.
    first = np.asarray(image.extent[::2], float)
    if of_cells:
        first += [0.5 if n > 1 else 0.0 for n in image.dimensions]
    affine[:3, 3] = affine[:3, :3] @ first + affine[:3, 3]
    return regions.Labels(_whole_numbers(volume), affine)


def _whole_numbers(volume: np.ndarray) -> np.ndarray:
    """Return labels as integers, as which files that scale their data do not always give them."""
    volume = three_axes(volume)
    if volume.ndim != 3:
        raise ValueError(f"labels have shape {volume.shape}; expected three axes")
    if volume.dtype.kind in "biu":
        return volume
    rounded = np.rint(volume)
    if not np.array_equal(rounded, volume):
        raise ValueError(
            "the volume holds fractions, not labels; compare it first, as in (volume > 0.5).astype(int)"
        )
    return rounded.astype(np.int64)


def direction_of(normal: Any) -> Any:
    """Return three numbers; an axis may be named ``"x"`` or ``"-x"``."""
    if isinstance(normal, str):
        sign = -1.0 if normal.startswith("-") else 1.0
        axis = normal.lstrip("+-").lower()
        if axis not in AXES:
            raise ValueError(f"normal is {normal!r}; give 'x', 'y', 'z', '-x' …, or three numbers")
        return tuple(sign * part for part in AXES[axis])
    return normal


def _numbers(what: Any) -> np.ndarray | None:
    try:
        return np.asarray(what, np.float64)
    except (TypeError, ValueError):
        return None
