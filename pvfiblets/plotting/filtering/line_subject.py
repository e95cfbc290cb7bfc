"""Lines of tubes and halos as a user chooses from them: :class:`LineSubject`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from pvfiblets.query.selection.predicates import FlagsOf, Predicate, select

if TYPE_CHECKING:
    from pvfiblets.mappers.engine_mapper import FilteredMapper
    from pvfiblets.query.measures.measures import Values
    from pvfiblets.streamlines import Streamlines


@dataclass(frozen=True, eq=False)
class Parts:
    """Lines, and the segments or points that are drawn of them."""

    lines: Streamlines  # with all data that criteria may name
    ends: np.ndarray  # `(n, 2)` int64: the points between which each part lies
    owners: np.ndarray  # `(n,)` int64: the line of each part
    # `(n_points,)` int64: the row that each point has in a user's array, where they differ
    rows: np.ndarray | None = None
    n_rows: int = 0  # rows of such arrays
    flags: FlagsOf | None = None  # how the lines lie to regions, where they are not straight between their points
    # measures that the lines' points alone do not give
    measured: Mapping[str, Callable[[], Values]] = field(default_factory=dict)


class LineSubject:
    """A :class:`~pvfiblets.plotting.filtering.state.Subject`: lines in memory."""

    NOUN: ClassVar[str] = "lines"

    def __init__(self, mapper: FilteredMapper[Any], make: Callable[[], Parts]) -> None:
        # returns the `Parts`, when something is first chosen from them
        self._mapper, self._make = mapper, make  # that draws them

    @cached_property
    def _parts(self) -> Parts:
        return self._make()

    @property
    def lines(self) -> Streamlines:
        """All lines with their data."""
        return self._parts.lines

    def where(self, predicate: Predicate) -> np.ndarray:
        """Return where a condition holds."""
        return select(self.lines, predicate, flags=self._parts.flags)

    def measure(self, what: Any) -> Values:
        """Return a value for each line or point."""
        from pvfiblets.query.measures.measures import measure

        parts, lines = self._parts, self.lines
        if isinstance(what, str) and what in parts.measured and what not in {**lines.per_streamline, **lines.per_point}:
            return parts.measured[what]()
        if parts.rows is not None and isinstance(what, (np.ndarray, list)):
            given = np.asarray(what)
            what = given[parts.rows] if given.shape == (parts.n_rows,) and parts.n_rows != len(lines) else given
        return measure(lines, what)

    def show(self, mask: np.ndarray | None, words: np.ndarray | None) -> None:
        """Draw some."""
        if mask is None and words is None:
            self._mapper.filtering = None
            return
        parts = self._parts
        shown = np.ones(len(parts.owners), bool) if mask is None else mask[parts.owners]
        if words is not None:
            bits = np.unpackbits(words.astype("<u4").view(np.uint8), bitorder="little").astype(bool)
            shown &= bits[parts.ends].all(axis=1)
        self._mapper.filtering = shown
