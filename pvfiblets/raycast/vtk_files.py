"""Reading through VTK's image readers, whose complaints become errors."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pvfiblets.errors import FormatError

__all__ = ["read"]


def read(reader: Any, path: Path) -> Any:
    """Return what a VTK reader gives.

    Parameters
    ----------
    reader : vtkAlgorithm
        With ``SetFileName``.
    path : Path

    Returns
    -------
    vtkImageData

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    FormatError
        If VTK complains.
    """
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
