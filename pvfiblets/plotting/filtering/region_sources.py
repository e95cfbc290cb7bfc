"""Conversion of sources to regions: meshes, bounds, planes and label volumes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.images.sources import as_image, is_image
from pvfiblets.support.vtk_space import space_of_dataset, to_ras

if TYPE_CHECKING:
    from pvfiblets.regions import Region

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
            return _labels(dataset)
        raise TypeError(
            f"a {type(dataset).__name__} is no region; give its surface: dataset.extract_surface().triangulate()"
        )
    if isinstance(what, str) and what.lstrip("+-").lower() in AXES:
        raise ValueError(f"{what!r} is an axis, and no region; give the plane as ({what!r}, origin)")
    if isinstance(what, (str, Path)) and _is_surface(str(what).lower()):
        from pvfiblets.plotting.meshes import read_mesh

        return _surface(read_mesh(what))
    if isinstance(what, (str, Path)) or is_image(what):
        return _labels(what)
    if isinstance(what, np.ndarray) and what.ndim == 3:
        raise TypeError(
            f"an array of shape {what.shape} is no region: it has no position; "
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


def _is_surface(path: str) -> bool:
    from pvfiblets.volumes.freesurfer_files import SURFACES
    from pvfiblets.volumes.gifti_files import SUFFIXES

    return path.endswith((*SUFFIXES, *SURFACES))


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


def _labels(image: Any) -> Region:
    from pvfiblets import regions

    found = as_image(image, "the region")
    return regions.Labels(found.labels, found.affine)


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
