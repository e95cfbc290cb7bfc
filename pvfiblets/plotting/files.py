"""Tractogram files for :func:`pyvista.read` and :meth:`pyvista.PolyData.save`."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import pyvista as pv
from pyvista.core.utilities.reader_registry import LocalFileRequiredError

from pvfiblets import formats
from pvfiblets.streamlines import Streamlines


def read_dataset(path: str, **_options: Any) -> pv.PolyData:
    """Read any tractogram format into PolyData of lines with its point and cell data."""
    if "://" in str(path):
        raise LocalFileRequiredError
    return pv.wrap(formats.read(path).to_polydata())


def write_dataset(dataset: pv.DataSet, path: str, **_options: Any) -> None:
    """Write PolyData of lines as a tractogram; the suffix says which format."""
    if not isinstance(dataset, pv.PolyData):
        raise TypeError(
            f"a {type(dataset).__name__} cannot be written as {Path(path).suffix}; expected "
            "PolyData with lines"
        )
    lines = Streamlines.from_polydata(dataset)
    if lost := formats.write(path, lines):
        names = ", ".join(f"{part} ({', '.join(getattr(lines, part))})" for part in lost)
        warnings.warn(f"{path}: a {Path(path).suffix} file cannot hold {names}", UserWarning, stacklevel=6)
