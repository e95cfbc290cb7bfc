"""Writing through VTK's own writers, to a temporary file that takes the name when complete."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

from pvfiblets.errors import FibletsError
from pvfiblets.streamlines import Streamlines
from pvfiblets.whole_files import replacing


def write_with(writer: Any, path: str | PathLike[str], streamlines: Streamlines) -> None:
    """Let a VTK writer write the streamlines as poly data.

    Raises
    ------
    FibletsError
        If VTK reports a failure.
    """
    writer.SetInputData(streamlines.to_polydata())
    with replacing(path) as file:
        writer.SetFileName(file.name)
        done = writer.Write()
        size = Path(file.name).stat().st_size
        if done != 1 or size == 0:
            raise FibletsError(f"{path}: VTK could not write the file; is the disk full?")
