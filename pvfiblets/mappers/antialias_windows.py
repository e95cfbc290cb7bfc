"""Windows whose pictures are refined: one frame more of all of them, or all that are left."""

from __future__ import annotations

import weakref
from typing import Any

__all__ = ["finish", "refine", "shown_pictures"]

shown_pictures: weakref.WeakSet[Any] = weakref.WeakSet()
"""All `pvfiblets.mappers.picture.Picture` that there are."""


def refine(window: Any) -> bool:
    """Draw one more frame of the pictures of a window that want more samples; nothing if none does.

    Parameters
    ----------
    window : vtkRenderWindow

    Returns
    -------
    bool
        Whether one of them wants another.
    """
    wanting = _unfinished(window)
    for picture in wanting:
        picture.refinement.due = True
    if wanting:
        window.Render()
    return bool(_unfinished(window))


def finish(window: Any) -> None:
    """Draw all frames that the pictures of a window want."""
    while refine(window):
        pass


def _unfinished(window: Any) -> list[Any]:
    address = window.GetAddressAsString("")
    found = [picture for picture in shown_pictures if picture.unfinished]
    return [picture for picture in found if picture.renderer.GetRenderWindow().GetAddressAsString("") == address]
