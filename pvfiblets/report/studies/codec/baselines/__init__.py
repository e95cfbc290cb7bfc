"""Other methods of keeping streamlines, written plainly, for the study of the codec to compare with.

Each gives a :class:`Packed`. They are as compact as their description allows, and compiled where the codec is, for one
thread, which is what the study runs on: times can be compared. They are not meant for use.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

__all__ = ["COUNT_BYTES", "Packed"]

COUNT_BYTES = 4  # of every streamline, for how many points it has


class Packed(Protocol):
    """Streamlines in some compact form."""

    @property
    def nbytes(self) -> int:
        """Bytes of all that decoding needs, the numbers of points of all streamlines included."""
        ...

    def points(self) -> npt.NDArray[np.floating[Any]]:
        """Decode all points, ``(n, 3)``."""
        ...
