"""A tractogram's file as it is: mapped where it is compressed, else read."""

from __future__ import annotations

from os import PathLike, fspath
from typing import TYPE_CHECKING

from .. import formats

if TYPE_CHECKING:
    from ..streamlines import Streamlines
    from .fibletset import FibletSet

__all__ = ["open_lines"]


def open_lines(path: str | PathLike[str]) -> FibletSet | Streamlines:
    """Map a ``.fiblets`` file, or read one of another format.

    Parameters
    ----------
    path : str or PathLike

    Raises
    ------
    FormatError, OSError
        As of :meth:`.FibletSet.open` and :func:`pvfiblets.formats.read`.
    """
    from .fibletset import FibletSet

    return FibletSet.open(path) if fspath(path).lower().endswith(".fiblets") else formats.read(path)
