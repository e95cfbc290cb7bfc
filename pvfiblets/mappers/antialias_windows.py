"""Windows whose pictures at rest want more frames, for samples or for parts of their sets: one frame more, or all."""

from __future__ import annotations

import weakref
from typing import Any

__all__ = ["finish", "picture_of", "refine", "shown_pictures"]

shown_pictures: weakref.WeakSet[Any] = weakref.WeakSet()
"""All `pvfiblets.mappers.picture.Picture` that there are."""


def refine(window: Any) -> bool:
    """Draw one more frame of the pictures of a window that want more samples or parts; nothing if none does.

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
        picture.refinement.due = True  # also where parts are wanted: views that stay as they were are not drawn
    if wanting:
        window.Render()
    return bool(_unfinished(window))


def finish(window: Any) -> None:
    """Draw all frames that the pictures of a window want."""
    wanting = _unfinished(window)
    for picture in wanting:
        picture.at_once = True
    try:
        while refine(window):
            pass
    finally:
        for picture in wanting:
            picture.at_once = False


def _unfinished(window: Any) -> list[Any]:
    address = window.GetAddressAsString("")
    found = [picture for picture in shown_pictures if picture.unfinished]
    return [picture for picture in found if picture.renderer.GetRenderWindow().GetAddressAsString("") == address]


def picture_of(renderer: Any) -> Any:
    """Return what is done to a renderer's picture; None if nothing is."""
    address = renderer.GetAddressAsString("")
    of = [(picture, picture.renderer) for picture in shown_pictures]
    return next((one for one, its in of if its is not None and its.GetAddressAsString("") == address), None)
