"""What filters fiblets alone: bundles, and painted regions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from pvfiblets.plotting.filtering.selection import SelectedActor

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.mappers.fiblets import FibletMapper
    from pvfiblets.query.bundles.bundle_list import Bundles
    from pvfiblets.query.measures.measures import Values
    from pvfiblets.query.selection.predicates import Predicate


@dataclass(frozen=True)
class FibletSubject:
    """A :class:`~pvfiblets.plotting.filtering.state.Subject`: fiblets, whose regions the GPU finds."""

    lines: FibletSet
    mapper: FibletMapper

    NOUN: ClassVar[str] = "fiblets"

    def where(self, predicate: Predicate) -> np.ndarray:
        """Return where a condition holds."""
        from pvfiblets.query.selection.predicates import select

        drawn = self.mapper.fiblets is self.lines
        return select(self.lines, predicate, flags=self.mapper.region_flags if drawn else None)

    def measure(self, what: Any) -> Values:
        """Return a value for each streamline or point."""
        from pvfiblets.query.measures.measures import measure

        return measure(self.lines, what)

    def show(self, mask: np.ndarray | None, words: np.ndarray | None) -> None:
        """Draw some."""
        from pvfiblets.engine.fiblets.data.filter_textures import Filter

        self.mapper.filtering = None if mask is None and words is None else Filter(mask, words)


class BundledActor(SelectedActor):
    """Actor of fiblets with bundles."""

    _fiblets: FibletSet

    def include_painted(self, live: Any, *, name: str | None = None, **how: Any) -> str:
        """Show only streamlines that satisfy conditions on painted regions, updated after each stroke.

        Parameters
        ----------
        live : LiveRegions
            Of this actor's fiblets (:class:`pvfiblets.regions.LiveRegions`).
        name : str, optional
            Replaces the condition of the same name.
        **how
            Of :meth:`.LiveRegions.select`: ``include``, ``exclude``, ``ends_in``, ``stays_in``, ``in_order``, each
            names of regions.

        Returns
        -------
        str
            The name, for :meth:`remove_condition`, after which strokes change nothing here.

        Raises
        ------
        KeyError
            If there is no region of a name.
        ValueError
            If the painted regions are about other fiblets.

        Examples
        --------
        >>> import numpy as np
        >>> import pyvista as pv
        >>> from pvfiblets import Streamlines, regions
        >>> lines = [np.array([(0, y, 0), (9, y, 0)], float) for y in (1, 5)]
        >>> pl = pv.Plotter(off_screen=True)
        >>> actor = pl.add_fiblets(Streamlines.from_list(lines))
        >>> painter = regions.RegionPainter(((10, 10, 3), np.eye(4)))
        >>> region = painter.add("A")
        >>> live = regions.LiveRegions(actor.fiblets, painter)
        >>> _ = painter.paint("A", (4, 5, 0), 1.0)
        >>> name = actor.include_painted(live, include="A")
        >>> actor.shown.tolist()
        [False, True]
        >>> _ = painter.paint("A", (4, 1, 0), 1.0)
        >>> actor.shown.tolist()
        [True, True]
        """
        if live.fiblets is not self._fiblets:
            raise ValueError("live is of other fiblets; make it of this actor's: regions.LiveRegions(actor.fiblets, …)")
        from pvfiblets.plotting.fiblets.painted import follow_painted

        return follow_painted(self, live, name, how)

    @property
    def bundles(self) -> Bundles:
        """The groups as an ordered list; changes of visibility, and of colours by ``"group"``, are shown.

        Streamlines in no bundle stay shown whichever bundles are hidden.
        """
        from pvfiblets.query.bundles.bundle_list import Bundles

        return Bundles(self._fiblets, self._bundles_changed)

    def _bundles_changed(self) -> None:
        from pvfiblets.query.bundles.bundle_list import hidden_groups

        hidden = hidden_groups(self._fiblets.per_group) & set(self._fiblets.groups)
        shown = tuple(name for name in self._fiblets.groups if name not in hidden) if hidden else None
        self._choose(groups=shown, ungrouped=hidden != set())
        if isinstance(self.scalars, str) and self.scalars == "group":
            self.scalars = "group" if self._fiblets.groups else None
