"""The result of a pick: streamlines, and their places under the mouse or an area."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules.vtkCommonMath import vtkMatrix4x4

from pvfiblets.mappers.frames.scene import to_array
from pvfiblets.mappers.picking import Layer, pick_area, shown_by
from pvfiblets.plotting.fiblets.scalars import point_values

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

    from pvfiblets.plotting.fiblets.selection import SelectableActor

_AT_ONCE = 4096  # streamlines that are decompressed together


@dataclass(frozen=True, eq=False)
class Picked:
    """Streamlines of one actor that were picked, the nearest to the viewer first.

    Attributes
    ----------
    actor : FibletActor
        Whose streamlines they are.
    ids : numpy.ndarray
        ``(n,)`` int64 streamlines, each once.
    places : numpy.ndarray
        ``(n,)`` float64: of each streamline's places under the mouse or the area the nearest to
        the viewer, as the index of the point before plus the fraction of the segment.
    depths : numpy.ndarray
        ``(n,)`` float64 window depth of those places.
    distance : float
        Pixels of the window between the mouse, or the area, and the nearest of them.
    through : bool
        Whether hidden streamlines are among them.

    Notes
    -----
    ``points``, ``pixels`` and ``values`` are computed when first asked for, from the data that the
    actor showed when it was picked.
    """

    actor: SelectableActor
    ids: np.ndarray
    places: np.ndarray
    depths: np.ndarray
    distance: float = 0.0
    through: bool = False
    _data: dict[str, Any] = field(default_factory=dict, repr=False)

    def __len__(self) -> int:
        return len(self.ids)

    @cached_property
    def points(self) -> np.ndarray:
        """``(n, 3)`` float64: the places in world mm."""
        local = [np.zeros((0, 3))]
        for first in range(0, len(self.ids), _AT_ONCE):
            part = slice(first, first + _AT_ONCE)
            lines = self._data["fiblets"].decompress(self.ids[part], dtype=np.float64)
            row, following, share = _between(lines.offsets, self.places[part])
            at = lines.points[row]
            local.append(at + share[:, None] * (lines.points[following] - at))
        model = self._data["model"]
        found: np.ndarray = np.concatenate(local) @ model[:3, :3].T + model[:3, 3]
        return found

    @cached_property
    def pixels(self) -> np.ndarray:
        """``(n, 2)`` float64: the places in pixels of the window, from its lower left corner."""
        if "pixels" in self._data:
            return np.asarray(self._data["pixels"])
        local = np.column_stack([self.points, np.ones(len(self))]) @ self._data["from_world"].T
        width, height = self._data["size"]
        scaled = (local[:, :2] / local[:, 3:] + 1.0) * 0.5 * (width, height)
        found: np.ndarray = scaled / self._data["enlarged"] + self._data["origin"] - 0.5
        return found

    @cached_property
    def values(self) -> np.ndarray:
        """``(n,)`` float64: the numbers that colour the places; NaN where colours are no numbers."""
        scalars = self._data["scalars"]
        nothing = np.full(len(self), np.nan)
        if scalars is None or scalars.kind in ("orientation", "streamline_rgba"):
            return nothing
        if scalars.kind == "streamline_scalar":
            return np.asarray(scalars.values[self.ids], np.float64)
        drawn = self._data.get("values")
        if drawn is not None and np.isfinite(drawn).any():
            return np.asarray(drawn)
        found = point_values(self._data["fiblets"], self.ids, scalars.name)
        if found is None:
            return nothing
        values, offsets = found
        row, following, share = _between(offsets, self.places)
        return np.asarray(values[row] + share * (values[following] - values[row]))


def _between(offsets: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the points before and after places along streamlines, and the fraction in between."""
    last = np.maximum(np.diff(offsets) - 1, 0)
    before = np.clip(np.floor(places).astype(np.int64), 0, last)
    share = np.where(before < last, places - before, 0.0)
    return offsets[:-1] + before, offsets[:-1] + np.minimum(before + 1, last), share


def visible(
    actor: SelectableActor,
    polygon: Any,
    *,
    tolerance: float = 0.0,
    nearest: bool = False,
    renderer: vtkRenderer | None = None,
) -> Picked | None:
    """Return the visible part of an actor in an area of the window; ``None`` if it is empty."""
    hits = pick_area(actor.picking_layers, polygon, renderer=renderer, tolerance=tolerance)
    if hits is None or not len(hits.ids):
        return None
    if nearest:
        rows = np.lexsort((hits.depths, hits.distances))[:1]
    else:
        order = np.lexsort((hits.depths, hits.ids))
        _, first = np.unique(hits.ids[order], return_index=True)
        rows = order[first]
        rows = rows[np.argsort(hits.depths[rows], kind="stable")]
    data = _context(actor) | {"pixels": hits.pixels[rows], "values": hits.values[rows]}
    closest = float(hits.distances[rows].min())
    return Picked(actor, hits.ids[rows], hits.places[rows], hits.depths[rows], closest, _data=data)


def everything(
    actor: SelectableActor, polygon: Any, *, tolerance: float = 0.0, renderer: vtkRenderer | None = None
) -> Picked | None:
    """Return all of an actor under an area of the window, hidden or not; ``None`` if it is empty."""
    # Arguments are as for `visible`. Lines left out by the actor's filters and cuts are not included. Visible lines of
    # the area are always included, even if only a line's pixel, not its middle, lies in it.
    from pvfiblets.query.selection.screen import ends_under_polygon, under_polygon

    shown = shown_by(actor.mapper, renderer)
    if shown is None:
        return None
    drawn, enlarged = shown.drawn, shown.enlarged
    view, filtering = drawn.view, shown.slot.versions.get("filtering")
    matrix = view.model_view_projection
    # What lies beside the picture is not under an area that reaches beyond it.
    sides = np.array([matrix[3] + sign * matrix[axis] for axis in (0, 1) for sign in (1.0, -1.0)])
    find, radius = under_polygon, 0.0
    if actor.mapper.ends:
        find, radius = ends_under_polygon, actor.mapper.drawn_width / 2.0
    under = find(
        actor.fiblets,
        matrix,
        drawn.viewport[2:],
        shown.to_viewport(polygon),
        (tolerance + radius) * float(enlarged.max()),
        streamlines=None if filtering is None else filtering.streamlines,
        points=None if filtering is None else filtering.points,
        planes=np.concatenate([sides, np.asarray(view.clip_planes).reshape(-1, 4)]),
        region=view.region,
    )
    ids, places, depths = under.ids, under.places, under.depths
    seen = visible(actor, polygon, tolerance=tolerance, renderer=renderer)
    if seen is not None:
        more = ~np.isin(seen.ids, ids)
        ids = np.concatenate([ids, seen.ids[more]])
        places = np.concatenate([places, seen.places[more]])
        depths = np.concatenate([depths, seen.depths[more]])
        order = np.argsort(depths, kind="stable")
        ids, places, depths = ids[order], places[order], depths[order]
    if not len(ids):
        return None
    data = _context(actor)
    data |= {
        "from_world": matrix @ np.linalg.inv(data["model"]),
        "size": drawn.viewport[2:],
        "enlarged": enlarged,
        "origin": shown.renderer.GetOrigin(),
    }
    return Picked(actor, ids, places, depths, 0.0, through=True, _data=data)


def _context(actor: SelectableActor) -> dict[str, Any]:
    """Return what the actor shows now."""
    model = vtkMatrix4x4()
    actor.GetModelToWorldMatrix(model)
    return {"fiblets": actor.fiblets, "model": to_array(model), "scalars": actor.active_scalars}


def checked_box(box: Any) -> np.ndarray:
    """Return the corners of a rectangle of pixels, those on its edges included."""
    ends = np.asarray(box, dtype=np.float64)
    if ends.shape != (4,) or not np.isfinite(ends).all():
        raise ValueError(f"box is {box!r}; give four pixels (x0, y0, x1, y1)")
    x0, x1 = sorted(ends[[0, 2]])
    y0, y1 = sorted(ends[[1, 3]])
    x0, y0, x1, y1 = x0 - 0.5, y0 - 0.5, x1 + 0.5, y1 + 0.5
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


__all__ = ["Layer", "Picked", "checked_box", "everything", "visible"]
