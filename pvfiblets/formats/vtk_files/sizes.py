"""Memory that VTK would take for a file: it takes whatever the file says, and ends the process if it cannot."""

from __future__ import annotations

import re
from os import PathLike
from pathlib import Path

from pvfiblets.errors import FormatError
from pvfiblets.formats.vtk_files.xml_arrays import XmlFile
from pvfiblets.support.memory import check_room, limited_to

_XML = (".vtp", ".vtu", ".vti")
_HEAD = 1 << 16  # bytes in which a header is looked for
_ROWS = {
    ".ply": rb"^\s*element\s+\S+\s+(\d{1,18})\s*$",
    ".vtk": rb"^\s*(?:POINTS|POINT_DATA|CELL_DATA|CELLS|VERTICES|LINES|POLYGONS|TRIANGLE_STRIPS)\s+(\d{1,18})\b",
}
_COPIES = 2  # while VTK reads
_ROW = 12  # bytes of three coordinates, or of a triangle


def check_memory(path: str | PathLike[str]) -> None:
    """Refuse a file that says that it takes more memory than is left, where memory is limited."""
    place = Path(path)
    name = place.name.lower()
    if name.endswith(_XML) and limited_to() is not None:
        check_room(_COPIES * stated_bytes(XmlFile(path, None)))
    elif (pattern := _ROWS.get(place.suffix.lower())) is not None:
        with place.open("rb") as file:
            head = file.read(_HEAD).partition(b"end_header")[0]
        rows = max(map(int, re.findall(pattern, head, re.MULTILINE | re.IGNORECASE)), default=0)
        if rows > (size := place.stat().st_size):  # each takes a byte or more
            raise FormatError(path, None, f"{size} bytes", f"the {rows} rows that its header says")
        check_room(_COPIES * _ROW * rows)


def stated_bytes(file: XmlFile) -> int:
    """Return how many bytes the arrays of a file say that they take, or the numbers of points and cells do."""
    total = 0
    for piece in file.content.children("Piece"):
        numbers = {name: piece.count(name) for name in piece.attributes if name.startswith("NumberOf")}
        points = numbers.pop("NumberOfPoints", 0)
        rows = {
            "Points": points,
            "PointData": points,
            "CellData": sum(numbers.values()),
            "Cells": sum(numbers.values()),
        }
        for holder in piece.elements:
            held = rows.get(holder.tag, numbers.get(f"NumberOf{holder.tag}", 0))
            for array in holder.children("DataArray"):
                # How many points a cell has stands in its array only.
                total += file.stated(array, 0 if array.attributes.get("Name") == "connectivity" else held)
    return total
