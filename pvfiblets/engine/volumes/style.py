"""`VolumeStyle`: a style that knows how rays are cast."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...volumes.options import RaycastOptions
from ..view import Style

__all__ = ["VolumeStyle"]


@dataclass(frozen=True)
class VolumeStyle(Style):
    """How a volume becomes pixels; none of the fields of `Style` is looked at.

    Parameters
    ----------
    casting : RaycastOptions
    """

    casting: RaycastOptions = field(kw_only=True)
