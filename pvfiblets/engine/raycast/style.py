"""`RaycastStyle`: a style that knows how rays are cast."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...raycast.casting import Casting
from ..view import Style

__all__ = ["RaycastStyle"]


@dataclass(frozen=True)
class RaycastStyle(Style):
    """How a volume becomes pixels; none of the fields of `Style` is looked at.

    Parameters
    ----------
    casting : Casting
    """

    casting: Casting = field(kw_only=True)
