"""Where the views of a workspace lie in its window."""

from __future__ import annotations

__all__ = ["LAYOUTS", "viewports"]

Viewport = tuple[float, float, float, float]

LAYOUTS = ("grid", "row", "beside", "3d", "axial", "coronal", "sagittal")

_ORDER = ("axial", "coronal", "sagittal", "3d")
_THIRD = 1.0 / 3.0


def viewports(layout: str, aspect: float = 1.5) -> dict[str, Viewport]:
    """Return left, bottom, right and top, as shares of the window, of the views that a layout shows.

    Parameters
    ----------
    layout : str
        Of `LAYOUTS`.
    aspect : float, default: 1.5
        The window's width by its height: in one that is higher than wide, slices beside the 3-D view lie below it.
    """
    if layout == "grid":
        return {
            "axial": (0.0, 0.5, 0.5, 1.0), "coronal": (0.5, 0.5, 1.0, 1.0),
            "sagittal": (0.0, 0.0, 0.5, 0.5), "3d": (0.5, 0.0, 1.0, 0.5),
        }  # fmt: skip
    if layout == "row":
        return {name: (n / 4.0, 0.0, (n + 1) / 4.0, 1.0) for n, name in enumerate(_ORDER)}
    if layout == "beside" and aspect < 1.0:
        top = min(max(0.4 * aspect, 0.2), 0.35)  # panes a little higher than wide
        below = {name: (n * _THIRD, 0.0, (n + 1) * _THIRD, top) for n, name in enumerate(_ORDER[:3])}
        return {"3d": (0.0, top, 1.0, 1.0), **below}
    if layout == "beside":
        small = {name: (0.7, 1.0 - (n + 1) * _THIRD, 1.0, 1.0 - n * _THIRD) for n, name in enumerate(_ORDER[:3])}
        return {"3d": (0.0, 0.0, 0.7, 1.0), **small}
    return {layout: (0.0, 0.0, 1.0, 1.0)}
