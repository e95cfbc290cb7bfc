"""What users set of an actor's look-up table, as ``actor.mapper.lookup_table`` of a mesh, changes what is drawn.

The table is written by the actor's settings, and by users. What somebody else has written counts as settings from then
on: pictures and scalar bars show it, and other scalars keep it.
"""

from __future__ import annotations

import weakref
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista as pv

from pvfiblets.plotting.linked_property import is_own_write

__all__ = ["LinkedTable"]


@dataclass(frozen=True)
class _Written:
    """What a table says."""

    values: np.ndarray
    clim: tuple[float, float]
    log_scale: bool
    colours: tuple[Any, Any, Any]
    annotations: dict[float, str]

    @classmethod
    def of(cls, table: pv.LookupTable) -> _Written:
        low, high = table.scalar_range
        colours = table.nan_color, table.below_range_color, table.above_range_color
        words = {
            table.GetAnnotatedValue(i).ToDouble(): table.GetAnnotation(i)
            for i in range(table.GetNumberOfAnnotatedValues())
        }
        return cls(np.array(table.values), (float(low), float(high)), bool(table.log_scale), colours, words)


class LinkedTable:
    """The part of an actor that watches its look-up table."""

    _table: Any
    _settings: Any
    _written: _Written | None = None
    _touched = False

    def _watch_table(self) -> None:
        this = weakref.ref(self)

        def changed(_table: Any, _event: str) -> None:
            actor = this()
            if actor is not None and not is_own_write() and actor._written is not None:  # noqa: SLF001
                actor._touched = True  # noqa: SLF001 - a method would keep the actor alive for ever
                actor._table_touched()  # noqa: SLF001

        self._table.AddObserver("ModifiedEvent", changed)

    def _note_table(self) -> None:
        """Remember what the settings have made of the table."""
        self._written, self._touched = _Written.of(self._table), False

    def _table_touched(self) -> None:
        """Be told that somebody else is writing to the table, and may not be done."""

    def _table_settings(self) -> dict[str, Any]:
        """Return what somebody else has written since, as settings of colours."""
        before, self._touched = self._written, False
        if before is None:
            return {}
        now, found = _Written.of(self._table), dict[str, Any]()
        for name, old, new in (
            ("clim", before.clim, now.clim),
            ("log_scale", before.log_scale, now.log_scale),
            ("annotations", before.annotations, now.annotations),
            *zip(("nan_color", "below_color", "above_color"), before.colours, now.colours, strict=True),
        ):
            if new != old:
                found[name] = new
        if not np.array_equal(now.values, before.values):
            found |= self._map_settings(now.values)
        self._written = now
        return found

    def _map_settings(self, values: np.ndarray) -> dict[str, Any]:
        """Return the colour map of a table by its name, if it is one's; else a table."""
        named = self._table.cmap
        for flip in (False, True) if named is not None else ():
            like = pv.LookupTable()
            like.apply_cmap(named, len(values), flip=flip)
            if np.array_equal(like.values[:, :3], values[:, :3]) and (values[:, 3] == 255).all():
                return {"cmap": named, "n_colors": len(values), "flip_scalars": flip}
        own = pv.LookupTable()
        own.DeepCopy(self._table)
        return {"cmap": own, "n_colors": len(values), "flip_scalars": False}
