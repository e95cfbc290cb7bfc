"""VTK's XML poly data (``.vtp``): inline or appended arrays, text, base64 or raw, zlib or LZMA.

Format: https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html. Read by a parser
of our own for the reason given in :mod:`pvfiblets.formats.vtk_files.legacy`, written by VTK. The file
must be read whole: the data of a streamline lie in several places of it. Several pieces are
joined. Coordinates are RAS+ mm, or LPS+ by the field data (:mod:`pvfiblets.support.vtk_space`).
Damage is a FormatError at the array; cells that are not lines, points of no line, points
with NaN or infinity and arrays of text are left out and counted; lines are cut at the points with
NaN or infinity.
"""

from __future__ import annotations

import re
from os import PathLike
from typing import Any
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from pvfiblets.errors import FormatError
from pvfiblets.formats.read_whole import TEXT_ARRAYS, only_finite, whole_file
from pvfiblets.formats.vtk_files.writer import write_with
from pvfiblets.formats.vtk_files.xml_arrays import Element, XmlFile
from pvfiblets.line_cells import parts_of_cells
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.vtk_space import FIELD, Space, space_named, space_taken

Array = NDArray[Any]

HOLDS = ("per_point", "per_streamline", "groups", "per_group")
"""Parts of Streamlines besides the points that the format can carry (groups as field data)."""

_CELLS = ("Verts", "Lines", "Polys", "Strips")


def _read(path: str | PathLike[str], given: Space | None) -> tuple[Streamlines, dict[str, str]]:
    """Read the streamlines, and the facts of their space."""
    file = XmlFile(path)
    holder = file.content.child("FieldData")
    field, text = _arrays(file, holder, None)
    named = [e for e in holder.children("Array") if e.attributes.get("Name") == FIELD] if holder else []
    texts = file.strings(named[0]) if named else []
    space, why = space_taken(space_named(texts[0] if texts else None, file.path), given)
    pieces = []
    for piece in file.content.children("Piece"):
        streamlines, more_text = _piece(file, piece)
        pieces.append(streamlines)
        text += more_text
    joined = Streamlines.concatenate(pieces)
    try:
        # The field data belong to the file, not to a piece, and name streamlines by number.
        parts = parts_of_cells(
            joined.points,
            joined.offsets,
            np.arange(joined.n_points),
            joined.per_point,
            joined.per_streamline,
            field=field,
            space_name=space,
        )
        whole = Streamlines(**parts)
    except ValueError as error:
        raise FormatError(file.path, None, str(error), "data that agree with each other") from error
    whole.dropped |= joined.dropped
    return only_finite(whole, {TEXT_ARRAYS: text - len(named)}), {"space": space, "space_from": why}


def _piece(file: XmlFile, piece: Element) -> tuple[Streamlines, int]:
    n_points = piece.count("NumberOfPoints")
    points = np.zeros((0, 3), np.float32)
    if n_points:
        holder = piece.child("Points")
        if holder is None or not holder.children("DataArray"):
            raise FormatError(file.path, piece.position, "no Points array", f"{n_points} points")
        points = file.values(holder.children("DataArray")[0], n_points, columns=3)
        if points.dtype not in (np.float32, np.float64):
            points = points.astype(np.float64)
    counts = {kind: piece.count(f"NumberOf{kind}") for kind in _CELLS}
    n, first = counts["Lines"], counts["Verts"]
    offsets, ids = np.zeros(1, np.int64), np.zeros(0, np.int64)
    if n:
        lines = piece.child("Lines")
        named = {a.attributes.get("Name"): a for a in lines.children("DataArray")} if lines else {}
        if not {"offsets", "connectivity"} <= set(named):
            raise FormatError(file.path, piece.position, f"arrays {list(named)}", "offsets and connectivity")
        # Read before memory is taken for as many as are promised.
        offsets = np.concatenate([offsets, file.values(named["offsets"], n)])
        if (np.diff(offsets) < 0).any():
            raise FormatError(file.path, named["offsets"].position, "offsets that decrease", "ascending offsets")
        ids = file.values(named["connectivity"], int(offsets[-1])).astype(np.int64)
        if len(ids) and not (ids.min() >= 0 and ids.max() < n_points):
            raise FormatError(
                file.path,
                named["connectivity"].position,
                f"point indices {ids.min()} to {ids.max()}",
                f"indices below {n_points}",
            )
    point_data, text = _arrays(file, piece.child("PointData"), n_points)
    cell_data, more = _arrays(file, piece.child("CellData"), sum(counts.values()))
    parts = parts_of_cells(
        points,
        offsets,
        ids,
        point_data,
        {k: v[first : first + n] for k, v in cell_data.items()},
        other_cells=sum(counts.values()) - n,
    )
    streamlines = Streamlines(**parts)
    return streamlines, text + more


def _arrays(file: XmlFile, holder: Element | None, rows: int | None) -> tuple[dict[str, Array], int]:
    """Read the arrays of an element by name, and count text arrays."""
    arrays: dict[str, Array] = {}
    if holder is None:
        return arrays, 0
    text = len(holder.children("Array"))
    for i, element in enumerate(holder.children("DataArray")):
        if element.attributes.get("type") == "String":
            text += 1
            continue
        n = element.count("NumberOfTuples") if rows is None else rows
        arrays[element.attributes.get("Name", f"array_{i}")] = file.values(element, n)
    return arrays, text


read, iter_chunks, info = whole_file(_read)


def write(path: str | PathLike[str], streamlines: Streamlines) -> None:
    """Write a vtp file, appended raw and zlib-compressed (see :func:`pvfiblets.formats.write`)."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    writer = vtkXMLPolyDataWriter()
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToZLib()
    writer.SetHeaderTypeToUInt64()
    data = streamlines.to_polydata()
    for holder in (data.GetPointData(), data.GetCellData(), data.GetFieldData()):
        for i in range(holder.GetNumberOfArrays()):
            array = holder.GetAbstractArray(i)
            array.SetName(_escaped(array.GetName()))  # VTK writes names as they are
    write_with(writer, path, data, compressed=True)


def _escaped(name: str) -> str:
    if bad := re.search(r"[\x00-\x08\x0b\x0c\x0e-\x1f]", name):
        raise ValueError(f"the name {name!r} has the character {bad[0]!r}, which XML cannot hold; rename it")
    return escape(name, {'"': "&quot;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"})
