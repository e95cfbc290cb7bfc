"""Layouts of the views of a workspace in its window."""

from __future__ import annotations

Viewport = tuple[float, float, float, float]

LAYOUTS = ("grid", "row", "beside", "3d", "axial", "coronal", "sagittal", "oblique")

_ORDER = ("axial", "coronal", "sagittal", "3d")
_THIRD = 1.0 / 3.0


def viewports(layout: str, aspect: float = 1.5, *, oblique: bool = False) -> dict[str, Viewport]:
    """Return left, bottom, right and top, as shares of the window, of the views that a layout shows."""
    panes = (*_ORDER[:3], "oblique") if oblique else _ORDER[:3]
    share = 1.0 / len(panes)
    if layout == "grid" and oblique:
        above = {name: (n * _THIRD, 0.5, (n + 1) * _THIRD, 1.0) for n, name in enumerate(_ORDER[:3])}
        return {**above, "oblique": (0.0, 0.0, _THIRD, 0.5), "3d": (_THIRD, 0.0, 1.0, 0.5)}
    if layout == "grid":
        return {
            "axial": (0.0, 0.5, 0.5, 1.0), "coronal": (0.5, 0.5, 1.0, 1.0),
            "sagittal": (0.0, 0.0, 0.5, 0.5), "3d": (0.5, 0.0, 1.0, 0.5),
        }  # fmt: skip
    if layout == "row":
        row = (*panes, "3d")
        return {name: (n / len(row), 0.0, (n + 1) / len(row), 1.0) for n, name in enumerate(row)}
    if layout == "beside" and aspect < 1.0:
        top = min(max(1.2 * aspect * share, 0.2), 0.35)  # panes a little higher than wide
        below = {name: (n * share, 0.0, (n + 1) * share, top) for n, name in enumerate(panes)}
        return {"3d": (0.0, top, 1.0, 1.0), **below}
    if layout == "beside":
        small = {name: (0.7, 1.0 - (n + 1) * share, 1.0, 1.0 - n * share) for n, name in enumerate(panes)}
        return {"3d": (0.0, 0.0, 0.7, 1.0), **small}
    return {layout: (0.0, 0.0, 1.0, 1.0)}
