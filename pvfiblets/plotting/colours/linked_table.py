"""Changes that users make to an actor's look-up table, as to ``actor.mapper.lookup_table`` of a mesh, take effect.

The table is written by the actor's settings, and by users. What somebody else has written counts as settings from then
on: pictures and scalar bars show it, and other scalars keep it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista as pv

from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.plotting.actors.linked_property import is_own_write


@dataclass(frozen=True)
class _Written:
    """The contents of a table."""

    values: np.ndarray
    clim: tuple[float, float]
    log_scale: bool
    colours: tuple[Any, Any, Any]
    annotations: dict[float, str]

    @classmethod
    def from_table(cls, table: pv.LookupTable) -> _Written:
        low, high = table.scalar_range
        colours = table.nan_color, table.below_range_color, table.above_range_color
        words = {
            table.GetAnnotatedValue(i).ToDouble(): table.GetAnnotation(i)
            for i in range(table.GetNumberOfAnnotatedValues())
        }
        return cls(np.array(table.values), (float(low), float(high)), bool(table.log_scale), colours, words)


class LinkedTable:
    """Changes of an actor's look-up table by other code than its settings.

    A method of the actor, ``modified``, is called at each change by other code, which may not have finished.
    """

    touched = False  # whether others have changed it since `note`

    def __init__(self, table: pv.LookupTable, modified: Callable[[], None]) -> None:
        self._table = table
        self._written: _Written | None = None
        self._modified = weakly(modified)
        observe(table, ("ModifiedEvent",), weakly(self._changed))

    def _changed(self) -> None:
        if not is_own_write() and self._written is not None:
            self.touched = True
            self._modified()

    def note(self) -> None:
        """Remember what the settings have made of the table."""
        self._written, self.touched = _Written.from_table(self._table), False

    def settings(self) -> dict[str, Any]:
        """Return what others have written since, as settings of colours."""
        if not self.touched:
            return {}
        before, self.touched = self._written, False
        if before is None:
            return {}
        now, found = _Written.from_table(self._table), dict[str, Any]()
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
