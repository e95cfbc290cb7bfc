"""Reading through VTK's image readers, whose complaints become errors."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from pvfiblets.errors import FormatError
from pvfiblets.formats.vtk_sizes import stated_bytes
from pvfiblets.formats.vtk_xml import Element, XmlFile
from pvfiblets.support.memory import check_room

__all__ = ["check_sizes", "read"]


def read(reader: Any, path: Path) -> Any:
    """Return what a VTK reader gives."""
    with path.open("rb"):  # says plainly what is wrong with a path
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


def check_sizes(path: Path) -> None:
    """Compare the sizes that a ``.vti`` file tells with each other and with its own.

    VTK takes memory for whatever a file says, and if there is not as much it ends the process.
    """
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
