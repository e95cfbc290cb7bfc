"""Writing through VTK's own writers, to a temporary file that takes the name when complete."""

from __future__ import annotations

import os
from contextlib import suppress
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from pvfiblets.errors import FibletsError
from pvfiblets.support.whole_files import replacing

if TYPE_CHECKING:
    import pyvista


def write_with(writer: Any, path: str | PathLike[str], data: pyvista.PolyData, *, compressed: bool = False) -> None:
    """Write poly data with a VTK writer."""
    size = data.GetActualMemorySize() * 1024
    writer.SetInputData(data)
    said: list[str] = []
    for source in (writer, writer.GetExecutive()):  # else VTK prints pages of its own
        source.AddObserver("ErrorEvent", lambda *_: said.append("VTK could not write the file"))
    with replacing(path, None if compressed else size) as file:
        writer.SetFileName(file.name)
        done = writer.Write()
        with suppress(FileNotFoundError):  # VTK deletes unfinished files
            if done == 1 and not said and Path(file.name).stat().st_size > 0:
                return
        _find_cause(file, size)
        raise FibletsError(f"{path}: VTK could not write the file; write .trx or .trk, which other code writes")


def _find_cause(file: BinaryIO, size: int) -> None:
    """Raise the system's error, which VTK does not tell, if there is no room for `size` bytes."""
    file.seek(0, os.SEEK_END)
    for first in range(0, size, 1 << 20):
        file.write(bytes(min(1 << 20, size - first)))
    file.flush()
