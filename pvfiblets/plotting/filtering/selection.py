"""Lines that a user singled out: highlighted, in a colour or outlined."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np
import pyvista as pv

from pvfiblets.mappers.effects.highlight import Highlight
from pvfiblets.plotting.filtering.filtering import FilteredActor

if TYPE_CHECKING:
    from pvfiblets.plotting.filtering.state import Subject

MODES = ("replace", "add", "remove", "toggle")
AS_BEFORE: Any = object()  # default of arguments that change nothing


@dataclass(frozen=True)
class SelectionStyle:
    """How selected lines stand out; width and tubes are for fiblets."""

    color: tuple[float, ...] | None = None  # RGB of those selected; `None` leaves them their own colours
    width: float | None = None  # pixels; `None` draws them as wide as all
    dim: float = 0.8  # how much of the others' colours gives way to the background, 0 to 1
    as_tubes: bool = False  # whether they are drawn as tubes
    radius: float = 0.5  # of the tubes, mm
    silhouette: tuple[float, float, float] | None = None  # RGB of an outline around them

    def changed(self, **given: Any) -> SelectionStyle:
        """Return another style; arguments that are `AS_BEFORE` change nothing, others are checked."""
        return replace(self, **{k: _CHECKS[k](v) for k, v in given.items() if v is not AS_BEFORE})


def _width(width: Any) -> float | None:
    if width is not None and not 1.0 <= float(width) <= 64.0:
        raise ValueError(f"width is {width!r}; give pixels from 1 to 64, or None")
    return None if width is None else float(width)


def _dim(dim: Any) -> float:
    if not 0.0 <= float(dim) <= 1.0:
        raise ValueError(f"dim is {dim!r}; give a number from 0 to 1")
    return float(dim)


def _radius(radius: Any) -> float:
    if not 0.0 < float(radius) < float("inf"):
        raise ValueError(f"radius is {radius!r}; give a length in mm above 0")
    return float(radius)


def _outline(wanted: Any) -> Any:
    return None if wanted is None or wanted is False else pv.Color("white" if wanted is True else wanted).float_rgb


_CHECKS = {
    "color": lambda color: None if color is None else pv.Color(color).float_rgb,
    "width": _width,
    "dim": _dim,
    "as_tubes": bool,
    "radius": _radius,
    "silhouette": _outline,
}


class SelectedActor(FilteredActor):
    """Actor of lines with a selection."""

    _selected: np.ndarray | None = None
    _selection_style = SelectionStyle()

    @property
    def selection(self) -> np.ndarray:
        """``(n,)`` int64: ids of the selected streamlines, rising."""
        if self._selected is None:
            return np.zeros(0, np.int64)
        return np.flatnonzero(self._selected).astype(np.int64)

    @selection.setter
    def selection(self, ids: Any) -> None:
        self.select(ids)

    def select(self, ids: Any, *, mode: str = "replace") -> None:
        """Select lines.

        Parameters
        ----------
        ids : array_like, slice, Picked, Predicate or Region
            Numbers (negative ones count from the end), a mask of bool, one for each line, a slice, a pick, or a
            condition or region as for :meth:`streamlines_where`.
        mode : {"replace", "add", "remove", "toggle"}
            Effect on the current selection.

        Raises
        ------
        IndexError
            If an id is out of range or a mask has the wrong length.
        ValueError
            If there is no such mode.
        """
        if mode not in MODES:
            raise ValueError(f"mode is {mode!r}; choose one of {', '.join(MODES)}")
        chosen = self._mask_of(ids)
        if self._selected is not None and mode != "replace":
            before = self._selected
            chosen = {"add": before | chosen, "remove": before & ~chosen, "toggle": before ^ chosen}[mode]
        elif mode == "remove":
            chosen[:] = False
        self._select(chosen)

    def deselect(self, ids: Any = None) -> None:
        """Remove lines from the selection, by default all; ``ids`` as for :meth:`select`."""
        if ids is None:
            self._select(None)
        else:
            self.select(ids, mode="remove")

    def invert_selection(self) -> None:
        """Invert the selection."""
        nothing = np.zeros(len(self._subject.lines), np.bool_)
        self._select(~(nothing if self._selected is None else self._selected))

    def selection_style(
        self, *, color: Any = AS_BEFORE, dim: float = AS_BEFORE, silhouette: Any = AS_BEFORE
    ) -> SelectionStyle:
        """Change the style of selected lines; omitted arguments stay unchanged.

        Parameters
        ----------
        color : color-like or None
            Of those selected; ``None`` leaves them their own colours.
        dim : float
            How much of the colours of all others gives way to the background, 0 to 1.
        silhouette : bool or color-like
            An outline around them, white where ``True``.

        Returns
        -------
        SelectionStyle
            As it is now.

        Raises
        ------
        ValueError
            If a number has no meaning; all stays as it was.
        """
        return self._restyle(color=color, dim=dim, silhouette=silhouette)

    def _restyle(self, **changes: Any) -> SelectionStyle:
        style = self._selection_style.changed(**changes)
        if style != self._selection_style:
            self._selection_style = style
            self._show_selection()
        return style

    def _select(self, selected: np.ndarray | None) -> None:
        self._selected = selected if selected is not None and selected.any() else None
        self._show_selection()

    def _show_selection(self) -> None:
        """Bring the picture up to date; an empty selection leaves nothing behind."""
        selected, style = self._selected, self._selection_style
        highlight = silhouette = None
        if selected is not None and (style.dim > 0.0 or style.color is not None):
            highlight = Highlight(selected, style.color, style.dim)
        if selected is not None and style.silhouette is not None and not self._stands_apart:
            from pvfiblets.mappers.effects.shading import Silhouette

            silhouette = Silhouette(selected, style.silhouette)
        for name, effect in (("selection", highlight), ("selection silhouette", silhouette)):
            if effect is not None or name in self._mapper.effects:
                self._mapper.set_effect(name, effect)

    @property
    def _stands_apart(self) -> bool:
        """Whether another actor draws the selection."""
        return False

    @contextmanager
    def _choosing_from(self, subject: Subject) -> Iterator[None]:
        """Keep filters and selection, as far as they fit, for other lines that are put in the place of all."""
        choices = self._choices.made_for(subject, self._subject)
        before, self._mapper.filtering = self._mapper.filtering, None  # it is of the lines before
        try:
            yield
        except Exception:
            self._mapper.filtering = before
            raise
        self._choices, self._subject = choices, subject
        self._choose()
        self._reselect(len(subject.lines))

    def _reselect(self, count: int) -> None:
        """Follow other data: the selection stays if the number of lines is the same."""
        if self._selected is not None and len(self._selected) != count:
            self._selected = None
        self._show_selection()

    def _be_like(self, other: Self, deep: bool) -> None:
        super()._be_like(other, deep)
        self._selection_style = other._selection_style
        self._select(None if other._selected is None else other._selected.copy())
