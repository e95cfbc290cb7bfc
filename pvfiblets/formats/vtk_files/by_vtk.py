"""Lines in files that VTK reads: ``.vtu``, ``.vtm``, ``.vtkhdf``, and files of pieces (``.pvtp``, ``.pvtu``).

VTK's readers trust sizes of a damaged file and may end the process; the formats of tractograms from elsewhere have
parsers of our own. Names of blocks become groups. Coordinates are RAS+ mm, or LPS+ by the field data
(:mod:`pvfiblets.support.vtk_space`).
"""

from __future__ import annotations

import warnings
from os import PathLike
from pathlib import Path
from typing import Any

from pvfiblets.errors import FormatError
from pvfiblets.formats.read_whole import only_finite, whole_file
from pvfiblets.formats.vtk_files.sizes import check_memory
from pvfiblets.formats.vtk_files.xml_arrays import XmlFile
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.vtk_space import FIELD, OURS, Space, space_of_dataset, space_taken


def read_dataset(path: str | PathLike[str]) -> Any:
    """Read whatever dataset a file holds."""
    import pyvista as pv

    if not str(path).lower().endswith(".vtkhdf"):
        XmlFile(path, None)  # broken XML is an error before VTK prints it
    elif not Path(path).is_file():
        raise FileNotFoundError(2, "No such file", str(path))
    check_memory(path)
    try:
        with warnings.catch_warnings(), pv.VtkErrorCatcher(raise_errors=True, send_to_logging=False):
            warnings.simplefilter("ignore", UserWarning)  # PyVista's, of the same errors
            return pv.read(path)
    except RuntimeError as error:
        text = str(error).strip().splitlines()[-1]
        raise FormatError(path, None, f"an error of VTK's reader ({text})", "a whole file") from error


def _read(path: str | PathLike[str], given: Space | None) -> tuple[Streamlines, dict[str, str]]:
    """Read the streamlines, and the facts of their space."""
    from pvfiblets.other_libraries import streamlines_of

    dataset = read_dataset(path)
    named = space_of_dataset(dataset)
    space, why = space_taken(named, given)
    if named is None and space != OURS:
        dataset.field_data[FIELD] = [space]
    try:
        found = streamlines_of(dataset)
    except TypeError as error:
        raise FormatError(path, None, str(error), "lines") from error
    assert found is not None
    return only_finite(found), {"space": space, "space_from": why}


read, iter_chunks, info = whole_file(_read)
