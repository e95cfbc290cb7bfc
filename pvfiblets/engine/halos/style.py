"""`HaloStyle`: a style that knows the look of halos."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...halos.style import Look
from ..view import Style

__all__ = ["HaloStyle"]


@dataclass(frozen=True)
class HaloStyle(Style):
    """How lines or points with halos become pixels.

    Of the fields of `Style`, ``values`` is looked at: the name of numbers or colours of the points. ``line_width`` is
    what a line takes at least in pixels, for whoever asks how far pixels may lie from an axis.

    Parameters
    ----------
    look : Look
    """

    look: Look = field(kw_only=True)

    @property
    def reach(self) -> float:
        """Millimetres from the axis to the edge of a strip."""
        return 0.5 * self.look.strip_width
