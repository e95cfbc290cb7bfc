"""A tractogram's file as it is: mapped where it is compressed, else read."""

from __future__ import annotations

from os import PathLike, fspath
from typing import TYPE_CHECKING

from ... import formats
from ...support.summary import warn_of_losses

if TYPE_CHECKING:
    from ...streamlines import Streamlines
    from ..fibletset import FibletSet


def open_lines(path: str | PathLike[str]) -> FibletSet | Streamlines:
    """Map a ``.fiblets`` file, or read one of another format, with a warning of what reading left out."""
    from ..fibletset import FibletSet

    if fspath(path).lower().endswith(".fiblets"):
        return FibletSet.open(path)
    streamlines = formats.read(path)
    warn_of_losses(fspath(path), streamlines.dropped, stacklevel=3)
    return streamlines
