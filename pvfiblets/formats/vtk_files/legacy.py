"""Legacy VTK files (``.vtk``) of poly data, ASCII and binary, versions 1.0 to 5.1.

Format: https://docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html. Read by
:class:`LegacyParser`, which checks every size against the file, since VTK's own reader trusts a
damaged header: of 320 damaged files of both kinds (this and ``.vtp``) 37 ended the process, and 245
were read without a word. Written by VTK. Coordinates are RAS+ mm, or LPS+ by the title line or the
field data (:mod:`pvfiblets.support.vtk_space`): then x and y change sign.

The file must be read whole: the data of a streamline lie in several places of it.

Damage (a missing or unknown keyword, sizes that contradict each other or the file, point indices
outside the points) is a FormatError at the keyword or the number. Cells that are not lines,
points of no line, points with NaN or infinity and arrays of text are left out and counted; lines
are cut at the points with NaN or infinity. A file cut off exactly between two sections is a valid
file: nothing in it tells that more was meant.
"""

from __future__ import annotations

from os import PathLike

import numpy as np

from pvfiblets.errors import FormatError
from pvfiblets.formats.read_whole import only_finite, whole_file
from pvfiblets.formats.rows import check_rounding
from pvfiblets.formats.vtk_files.legacy_parser import LegacyParser
from pvfiblets.formats.vtk_files.writer import write_with
from pvfiblets.line_cells import parts_of_cells
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.vtk_space import OURS, Space, space_in_header, space_named, space_taken

HOLDS = ("per_point", "per_streamline", "groups", "per_group")
"""Parts of Streamlines besides the points that the format can carry (groups as field data)."""


def _read(path: str | PathLike[str], given: Space | None) -> tuple[Streamlines, dict[str, str]]:
    """Read the streamlines, and the facts of their space."""
    parser = LegacyParser(path)
    parser.parse()
    named = space_in_header(parser.title, parser.path) or space_named(parser.space, parser.path)
    space, why = space_taken(named, given)
    offsets, ids = parser.lines
    n = len(offsets) - 1
    first = parser.cells_before_lines
    try:
        parts = parts_of_cells(
            parser.points,
            offsets,
            ids,
            parser.point_data,
            {k: v[first : first + n] for k, v in parser.cell_data.items()},
            other_cells=parser.n_cells - n,
            field=parser.field,
            space_name=space,
        )
        streamlines = Streamlines(**parts)
    except ValueError as error:  # groups in the field data that name no streamlines
        raise FormatError(parser.path, None, str(error), "data that agree with each other") from error
    return only_finite(streamlines, parser.notes), {"space": space, "space_from": why}


read, iter_chunks, info = whole_file(_read)


def write(path: str | PathLike[str], streamlines: Streamlines, *, double: bool = False) -> None:
    """Write a binary legacy vtk file (see :func:`pvfiblets.formats.write`)."""
    # Version 4.2, which programs other than VTK read too; 5.1 where the indices need 64 bits. MRtrix's tckconvert takes
    # double coordinates for floats, so they are float32 unless `double`.
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter

    writer = vtkPolyDataWriter()
    writer.SetFileTypeToBinary()
    writer.SetHeader(f"pvfiblets SPACE={OURS}")
    words = streamlines.n_points + len(streamlines)
    writer.SetFileVersion(42 if words < 2**31 else 51)
    data = streamlines.to_polydata()
    if not double:
        check_rounding(path, streamlines.points)
        data.points = streamlines.points.astype(np.float32, copy=False)
    write_with(writer, path, data)
