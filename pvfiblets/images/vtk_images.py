"""VTK images and ``.vti`` files: VTK's messages become errors."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.errors import FormatError
from pvfiblets.formats.vtk_files.sizes import stated_bytes
from pvfiblets.formats.vtk_files.xml_arrays import Element, XmlFile
from pvfiblets.support.memory import check_room

from .image import Image


def read_vti(path: Path) -> Image:
    """Read an image of VTK's."""
    return of_vtk(open_vti(path), path.name)


def open_vti(path: Path) -> Any:
    """Return the ``vtkImageData`` of a file."""
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader

    _check_sizes(path)
    return _read(vtkXMLImageDataReader(), path)


def of_vtk(image: Any, what: str) -> Image:
    """Return an image of VTK's: its points are the centres of voxels, and of numbers of cells, their middles."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    array, of_cells = _found(image, None)
    sides = [max(n - 1, 1) if of_cells else n for n in image.GetDimensions()]
    n = 1 if array is None else array.GetNumberOfComponents()
    shape = (*sides, n) if n > 1 else tuple(sides)
    place = place_of(image)
    place[:3, 3] += place[:3, :3] @ [0.5 if of_cells and n > 1 else 0.0 for n in image.GetDimensions()]

    def read() -> npt.NDArray[Any]:
        # Points run along the first axis first, and the components of each lie together.
        stored = vtk_to_numpy(array_of(image, None)[0]).reshape(*reversed(sides), *shape[3:])
        return np.moveaxis(stored, (0, 1, 2), (2, 1, 0))

    return Image(shape, place, read, "" if array is None else array.GetName() or "", what)


def place_of(image: Any) -> npt.NDArray[np.float64]:
    """Return the ``(4, 4)`` matrix from the indices of an image's points, counted from its first, to mm."""
    matrix = image.GetIndexToPhysicalMatrix()
    place = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
    place[:3, 3] += place[:3, :3] @ np.array(image.GetExtent()[0::2], np.float64)
    return place


def array_of(image: Any, name: str | None) -> tuple[Any, bool]:
    """Return an array of an image or grid of VTK's, the active one by default, and whether it is of its cells."""
    array, of_cells = _found(image, name)
    if array is None:
        names = [each.GetArrayName(i) for each in _data(image) for i in range(each.GetNumberOfArrays())]
        lacking = "no active scalars" if name is None else f"no array {name!r} of numbers"
        choose = "set_active_scalars(name)" if name is None else "scalars=..."
        raise ValueError(f"the image has {lacking} among its arrays {names}; choose one by {choose}")
    return array, of_cells


def _data(image: Any) -> tuple[Any, Any]:
    return image.GetPointData(), image.GetCellData()


def _found(image: Any, name: str | None) -> tuple[Any, bool]:
    """Return an array, None if there is none, and whether it is of cells."""
    data = _data(image)
    if name is not None:
        found = [attributes.GetArray(name) for attributes in data]
    else:
        found = [attributes.GetScalars() for attributes in data]
        if hasattr(image, "active_scalars_info"):  # PyVista says which of the two is meant
            association, active = image.active_scalars_info
            if active is not None:
                found = [each.GetArray(active) for each in data]
                if getattr(association, "name", "POINT") == "CELL":
                    found[0] = None
        # Filters leave arrays without an active one; a single array counts as chosen.
        for i, attributes in enumerate(data):
            # == would ask VTK's arrays for each of their numbers.
            if all(array is None for array in found) and attributes.GetNumberOfArrays() == 1:
                found[i] = attributes.GetArray(0)
    return (found[0], False) if found[0] is not None else (found[1], found[1] is not None)


def _read(reader: Any, path: Path) -> Any:
    """Return what a VTK reader gives."""
    with path.open("rb"):  # raises a clear error for a bad path
        pass
    complaints: list[str] = []

    def complain(_caller: Any, _event: str, text: str) -> None:
        complaints.append(text.strip().splitlines()[-1])

    complain.CallDataType = "string0"  # type: ignore[attr-defined]
    executive = reader.GetExecutive()
    observed = [(thing, thing.AddObserver("ErrorEvent", complain)) for thing in (reader, executive)]
    reader.SetFileName(str(path))
    reader.Update()
    for thing, tag in observed:
        thing.RemoveObserver(tag)
    if complaints or reader.GetErrorCode():
        what = complaints[0] if complaints else "an error that VTK does not name"
        raise FormatError(path, None, what, f"a file that {type(reader).__name__} can read")
    return reader.GetOutput()


def _check_sizes(path: Path) -> None:
    """Compare the sizes that a ``.vti`` file tells with each other and with its own."""
    # VTK takes the memory that a file declares, and ends the process if there is too little.
    file = XmlFile(path, "ImageData")
    pieces = [(piece, _sides(file, piece, "Extent")) for piece in file.content.children("Piece")]
    whole, held = math.prod(_sides(file, file.content, "WholeExtent")), sum(math.prod(sides) for _, sides in pieces)
    if not whole:
        extent = file.content.attributes["WholeExtent"]
        raise FormatError(file.path, file.content.position, f"WholeExtent={extent!r}", "a point along each axis")
    if whole > held:
        raise FormatError(file.path, file.content.position, f"{held} points in pieces", f"{whole}, its whole extent")
    for piece, sides in pieces:
        for name, rows in (("PointData", math.prod(sides)), ("CellData", math.prod(max(n - 1, 1) for n in sides))):
            for array in _arrays(piece.child(name)):
                file.check_sizes(array, rows)
    for array in _arrays(file.content.child("FieldData")):
        file.check_sizes(array, array.count("NumberOfTuples"))
    check_room(stated_bytes(file))


def _arrays(holder: Element | None) -> list[Element]:
    return [] if holder is None else [array for array in holder.elements if array.tag in ("DataArray", "Array")]


def _sides(file: XmlFile, element: Element, name: str) -> list[int]:
    """Return how many points an extent has along each axis."""
    text = element.attributes.get(name, "").split()
    try:
        ends = [int(end) for end in text]
    except ValueError:
        ends = []
    if len(ends) != 6 or any(not -(2**31) <= end < 2**31 for end in ends):
        raise FormatError(file.path, element.position, f"{name}={' '.join(text)[:80]!r}", "six whole numbers")
    return [max(last - first + 1, 0) for first, last in zip(ends[::2], ends[1::2], strict=True)]
