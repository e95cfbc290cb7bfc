"""Sources of ray-cast volumes, gathered into one form, in RAS+ mm."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from pvfiblets.images.files import SUFFIXES, read_image
from pvfiblets.images.image import Image
from pvfiblets.images.sources import as_image, colour_fields, filled, is_image
from pvfiblets.images.vtk_images import array_of, open_vti, place_of
from pvfiblets.support.value_reference import value_reference

from .smoothing import smoothed
from .volume import RaycastVolume

_EXPECTED = (
    "a pyvista.ImageData, an (nx, ny, nz) array, an (array, affine) tuple, an image of nibabel, a RaycastVolume or the "
    f"path of one of {', '.join(SUFFIXES)}"
)
UNIT_LENGTH = 1e-3  # tolerance of a direction's length of 1: headers keep few digits

Array = npt.NDArray[np.float64]
Found = tuple[npt.NDArray[Any], Array, str]  # numbers, their affine, and a name


def as_raycast_volume(
    source: Any,
    *,
    scalars: Any = None,
    spacing: Any = None,
    origin: Any = None,
    direction: Any = None,
    affine: Any = None,
    shape: Any = None,
    dtype: Any = None,
    smooth: Any = None,
    smooth_unit: Literal["voxels", "mm"] = "voxels",
) -> RaycastVolume:
    """Take a volume from any source.

    Parameters
    ----------
    source : object
        - :class:`pyvista.ImageData` or another ``vtkImageData``: origin, spacing and direction matrix place it. Cell
          data become the mean of the cells around each point, as in ``Plotter.add_volume``.
        - :class:`pyvista.RectilinearGrid`: along axes whose planes are uneven, values are interpolated at the least
          distance of two, at up to four times the number of places.
          Four numbers of type uint8 for each point are RGBA: light then has the voxels' own colours and opacities.
        - ``(nx, ny, nz)`` numbers, masked arrays (masked voxels are missing) and memory maps; or ``(array, affine)``.
          ``(nx, ny, nz, 4)`` of type uint8 are RGBA.
        - An image of nibabel; of type RGBA its colours count.
        - A path: ``.nii``, ``.nii.gz``, ``.mgh``, ``.mgz``, ``.mif``, ``.mif.gz``, ``.mih``, ``.nrrd``,
          ``.nhdr``, ``.mhd``, ``.mha``, ``.vti``; of NRRD files in LPS+, and of MetaImage files always, coordinates
          are LPS+ and are turned to RAS+. Any other, such as ``.raw``: bare numbers, the first axis running fastest;
          they need ``shape`` and ``dtype``.
        - A :class:`.RaycastVolume`, or anything else with ``values`` and ``affine``.

        What has one voxel along an axis, as a slice has, becomes as thick as this voxel: two of the same value.
    scalars : str or array_like, optional
        Of images of VTK: the name of an array, or numbers, one for each point or cell. Default: the active ones.
    spacing : float or array_like, optional
        mm between voxels along each axis.
    origin : array_like, optional
        ``(3,)`` mm: the centre of voxel (0, 0, 0).
    direction : array_like, optional
        ``(3, 3)`` or 9 numbers, row by row: its columns are the directions of the axes, of length 1.
    affine : array_like, optional
        ``(4, 4)`` voxel indices to mm, in place of the three above. All four take the place of what the source says.
    shape : tuple of int, optional
        Voxels along each axis, of bare numbers in a file.
    dtype : dtype_like, optional
        Their type, such as ``'uint8'`` or ``'>i2'``.
    smooth : float or array_like, optional
        Standard deviation of a Gaussian to smooth with, one or along each axis.
    smooth_unit : {'voxels', 'mm'}, default: 'voxels'
        Of ``smooth``.

    Returns
    -------
    RaycastVolume

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    TypeError
        If the source is of another kind.
    ValueError
        If a file is damaged, there are more than one number per voxel or other than three axes, arguments contradict
        each other, or as of :class:`.RaycastVolume` and :func:`.smoothed`. The message names value and remedy.
    """
    path = os.fspath(source).lower() if isinstance(source, (str, os.PathLike)) else None
    is_raw = path is not None and not path.endswith(SUFFIXES)
    if (shape is not None or dtype is not None) and not is_raw:
        raise ValueError("shape and dtype are of files of bare numbers, such as .raw; leave them out")
    is_vtk = hasattr(source, "IsA") or (path is not None and path.endswith(".vti"))
    if scalars is not None and not is_vtk:
        raise ValueError(f"scalars={scalars!r} chooses among the arrays of a VTK image; leave it out")
    given = (spacing, origin, direction, affine)
    if isinstance(source, RaycastVolume):
        volume = source
        if any(part is not None for part in given):
            place = _placed(source.affine, *given)
            volume = RaycastVolume(source.numbers, place, name=source.name, colours=source.colours)
    else:
        if is_raw:
            found = _of_raw(Path(source), shape, dtype)
        elif is_vtk:
            found = _of_vtk(source if path is None else open_vti(Path(source)), scalars)
        elif path is not None:
            found = _of_image(read_image(Path(source)))
        else:
            found = _of_object(source)
        values, own, name = found
        values, colours = _apart(values)
        values, colours, place = _thick(values, colours, _placed(own, *given))
        volume = RaycastVolume(values, place, name=name, colours=colours)
    return volume if smooth is None else smoothed(volume, smooth, smooth_unit)


def _of_object(source: Any) -> Found:
    """The volume of something in memory."""
    if is_image(source) or (isinstance(source, tuple) and len(source) == 2 and _is_pair(*source)):
        return _of_image(as_image(source, "the volume"))
    if isinstance(source, np.ndarray) or hasattr(source, "__array__") or isinstance(source, (list, tuple)):
        try:
            values = filled(source)
        except ValueError:
            raise ValueError("the volume's rows are of unlike lengths; give an (nx, ny, nz) array") from None
        return _of_image(Image(values.shape, np.eye(4), lambda: values, what="the volume"))
    raise TypeError(f"rays cannot be cast through a {type(source).__name__}; give {_EXPECTED}")


def _of_image(image: Image) -> Found:
    """The numbers of an image, or its colours if they have an opacity."""
    if _is_rgba(image.shape, np.uint8) and _is_rgba(image.shape, image.values.dtype):
        return image.values, image.affine, image.name or "values"
    if len(image.shape) == 3 and image.values.dtype.names == ("R", "G", "B", "A"):
        return colour_fields(image.values), image.affine, image.name or "values"
    try:
        return image.single, image.affine, image.name or "values"
    except ValueError as error:
        if len(image.shape) == 4 and image.shape[3] == 4:
            raise ValueError(f"{error}; RGBA of type uint8 is drawn as it is") from None
        raise


def _thick(values: Any, colours: Any, affine: Any) -> tuple[Any, Any, Array]:
    """Double a single voxel along an axis: rays are cast between the middles of two."""
    place = np.array(affine, np.float64)
    if np.ndim(values) != 3 or np.size(values) == 0:
        return values, colours, place
    for axis in range(3):
        if values.shape[axis] == 1:
            values = np.repeat(values, 2, axis)
            colours = None if colours is None else np.repeat(colours, 2, axis)
            place[:3, 3] -= 0.5 * place[:3, axis]
    return values, colours, place


def _apart(values: Any) -> tuple[npt.NDArray[Any], npt.NDArray[np.uint8] | None]:
    """Numbers, and colours where the numbers are RGBA: then the numbers are alpha, the rest the colours."""
    return (values[..., 3], values[..., :3]) if _is_rgba(np.shape(values), values.dtype) else (values, None)


def _is_rgba(shape: tuple[int, ...], kind: Any) -> bool:
    return len(shape) == 4 and shape[3] == 4 and kind == np.uint8


def _is_pair(values: Any, affine: Any) -> bool:
    """Whether two things are a volume and its affine, right or wrong, and not two slices of a volume."""
    whole = [isinstance(each, np.ndarray) and each.ndim >= 3 for each in (values, affine)]
    try:
        return whole == [True, False] or np.shape(affine) == (4, 4)
    except ValueError:  # rows of unlike lengths
        return False


def _of_raw(path: Path, shape: Any, dtype: Any) -> Found:
    """A memory map of a file of bare numbers."""
    if shape is None or dtype is None:
        path.stat()  # first of all, whether it is there
        raise ValueError(
            f"{path.name} has none of the suffixes {', '.join(SUFFIXES)}; of bare numbers say shape=(nx, ny, nz) and "
            "dtype, such as 'uint8'"
        )
    sides = np.asarray(shape)
    if sides.shape != (3,) or sides.dtype.kind not in "iu" or (sides < 1).any():
        raise ValueError(f"shape={shape!r}; expected (nx, ny, nz), three whole numbers above 0")
    try:
        kind = np.dtype(dtype)
    except TypeError:
        raise ValueError(f"dtype={dtype!r}; expected a type of numbers, such as 'uint8', '>i2' or 'float32'") from None
    needed, size = int(np.prod(sides.astype(object))) * kind.itemsize, path.stat().st_size
    if size != needed:
        raise ValueError(
            f"{path} has {size} bytes; {' x '.join(map(str, sides))} voxels of {kind} take {needed}: check shape and "
            "dtype, or give numpy.memmap(path, dtype, 'r', offset, shape, 'F') for numbers behind a header"
        )
    return np.memmap(path, kind, "r", 0, tuple(sides.tolist()), "F"), np.eye(4), path.stem


def _of_vtk(image: Any, scalars: Any) -> Found:
    """An image's scalars where they lie."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    uneven = image.IsA("vtkRectilinearGrid")
    if image.IsA("vtkMultiBlockDataSet"):
        raise TypeError("a MultiBlock is no grid; take each of its blocks by itself, or choose one: blocks[0]")
    if not (uneven or image.IsA("vtkImageData")):
        raise TypeError(
            f"rays cannot be cast through a {type(image).__name__}; sample it on a grid first: "
            "pyvista.ImageData(...).sample(mesh)"
        )
    dims = image.GetDimensions()
    n_points, n_cells = image.GetNumberOfPoints(), image.GetNumberOfCells()
    if scalars is None or isinstance(scalars, str):
        array, of_cells = array_of(image, scalars)
        name = array.GetName() or "values"
        values = vtk_to_numpy(array)
        n = array.GetNumberOfComponents()
        if n != 1 and not (n == 4 and values.dtype == np.uint8 and not of_cells and not uneven):
            colours = {2: ", complex numbers perhaps", 3: ", RGB colours perhaps", 4: ", RGBA perhaps"}.get(n, "")
            raise ValueError(
                f"the image's array {name!r} has {n} numbers per voxel{colours}; one is needed, or four of type uint8, "
                "RGBA, for each point of an ImageData: take a column, or a norm such as numpy.abs, first"
            )
    else:
        values, name = np.asarray(scalars), "values"
        rgba = values.shape == (n_points, 4) and values.dtype == np.uint8 and not uneven
        if values.shape not in ((n_points,), (n_cells,)) and not rgba:
            raise ValueError(
                f"scalars have the shape {values.shape}; expected one number for each of the image's {n_points} points "
                f"or {n_cells} cells"
            )
        of_cells = len(values) != n_points
    if of_cells:
        values = _at_points(values.reshape([max(n - 1, 1) for n in dims], order="F"), dims)
    else:
        rgba = values.ndim == 2
        # Points run along the first axis first, and the components of each lie together.
        values = values.reshape(*dims[::-1], 4).transpose(2, 1, 0, 3) if rgba else values.reshape(dims, order="F")
    if uneven:
        from .rectilinear import evenly

        axes = (image.GetXCoordinates(), image.GetYCoordinates(), image.GetZCoordinates())
        x, y, z = (np.array(vtk_to_numpy(one), np.float64) for one in axes)
        return *evenly(values, (x, y, z)), name
    return values, place_of(image), name


def _at_points(cells: npt.NDArray[Any], dims: tuple[int, int, int]) -> npt.NDArray[Any]:
    """The mean of the cells around each point; as float64 where float32 would lose differences."""
    values = cells.astype(np.float64 if value_reference(cells) else np.float32)
    for axis in range(3):
        if dims[axis] > 1:
            first, last = values.take([0], axis), values.take([-1], axis)
            values = (np.concatenate([first, values], axis) + np.concatenate([values, last], axis)) / 2
    return values


def _placed(own: Any, spacing: Any, origin: Any, direction: Any, affine: Any) -> Array:
    """A source's affine, with arguments in place of its parts."""
    if affine is not None:
        if not (spacing is None and origin is None and direction is None):
            raise ValueError("affine says spacing, origin and direction too; give either it or those")
        return _floats("affine", affine, "a (4, 4) matrix from voxels to mm")
    if spacing is None and origin is None and direction is None:
        return np.asarray(own, np.float64)
    place = np.array(own, np.float64)
    lengths = np.linalg.norm(place[:3, :3], axis=0)
    axes = np.divide(place[:3, :3], lengths, out=np.eye(3), where=lengths > 0.0)
    if spacing is not None:
        lengths = _floats("spacing", spacing, "one or three finite lengths above 0, mm")
        if lengths.shape not in ((), (3,)) or not np.isfinite(lengths).all() or not (lengths > 0.0).all():
            raise ValueError(f"spacing={spacing!r}; expected one or three finite lengths above 0, mm")
    if direction is not None:
        axes = _floats("direction", direction, "a finite (3, 3) matrix or 9 numbers, row by row")
        axes = axes.reshape(3, 3) if axes.shape == (9,) else axes
        if axes.shape != (3, 3) or not np.isfinite(axes).all():
            raise ValueError(f"direction={direction!r}; expected a finite (3, 3) matrix or 9 numbers, row by row")
        sizes = np.linalg.norm(axes, axis=0)
        if (abs(sizes - 1.0) > UNIT_LENGTH).any():
            raise ValueError(
                f"the columns of direction have the lengths {sizes.tolist()}; expected 1: lengths belong into spacing"
            )
    if origin is not None:
        place[:3, 3] = _point(origin)
    place[:3, :3] = axes * lengths
    return place


def _floats(name: str, given: Any, expected: str) -> Array:
    """An argument as numbers."""
    try:
        return np.asarray(given, np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{name}={given!r}; expected {expected}") from None


def _point(origin: Any) -> Array:
    point = _floats("origin", origin, "three finite coordinates, mm")
    if point.shape != (3,) or not np.isfinite(point).all():
        raise ValueError(f"origin={origin!r}; expected three finite coordinates, mm")
    return point
