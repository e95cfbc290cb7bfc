"""What a user chose of lines, as the engine draws by it: a mask of lines, and bits of points.

Everything that is chosen is joined by *and*. Nothing here knows an actor or a window: what is chosen from is a
:class:`Subject`, which may ask the GPU.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import reduce
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeAlias

import numpy as np

from pvfiblets.query.selection.predicates import Listed, Predicate, passes

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.query.measures.measures import Values
    from pvfiblets.regions import Region
    from pvfiblets.streamlines import Streamlines

    Lines: TypeAlias = FibletSet | Streamlines


class Subject(Protocol):
    """Lines that an actor draws, of which a user chooses some."""

    NOUN: ClassVar[str]

    @property
    def lines(self) -> Lines:
        """What criteria and conditions are about."""
        ...

    def where(self, predicate: Predicate) -> np.ndarray:
        """Return where a condition holds, (n_lines,) bool."""
        ...

    def measure(self, what: Any) -> Values:
        """Return a value for each line or point."""
        ...

    def show(self, mask: np.ndarray | None, words: np.ndarray | None) -> None:
        """Draw those lines of a mask, and of these what lies between points that have bits; None for all."""
        ...



@dataclass(frozen=True, eq=False)
class Criterion:
    """A range of values outside of which nothing is shown."""

    name: str
    what: Any  # as given: a name, an array, a `Distance`
    values: Any  # `pvfiblets.query.measures.measures.Values`
    range: tuple[float, float]  # both ends included
    keep_nan: bool  # whether NaN is shown

    def within(self) -> tuple[Any, float, float, bool]:
        """What :mod:`pvfiblets.query.selection.bits` asks for."""
        return self.values, *self.range, self.keep_nan


@dataclass(frozen=True, eq=False)
class Condition:
    """A condition on streamlines, and where it holds."""

    name: str
    predicate: Predicate
    mask: np.ndarray


@dataclass
class Choices:
    """All that a user chose; see :class:`~pvfiblets.plotting.filtering.filtering.FilteredActor`."""

    criteria: dict[str, Criterion] = field(default_factory=dict)
    conditions: dict[str, Condition] = field(default_factory=dict)
    subset: np.ndarray | None = None
    groups: tuple[str, ...] | None = None
    ungrouped: bool = False  # streamlines in no group too, where only some groups are shown
    ids: np.ndarray | None = None
    # Bits of the points, and the criteria that they are of: these stay while others change.
    _words: tuple[tuple[Criterion, ...], np.ndarray] | None = None

    @property
    def any(self) -> bool:
        """Whether something is chosen."""
        whole = self.subset is None and self.ids is None and self.groups is None
        return bool(self.criteria or self.conditions) or not whole

    def copy(self) -> Choices:
        """The same choices, to be changed on their own."""
        return replace(self, criteria=dict(self.criteria), conditions=dict(self.conditions))

    def mask(self, lines: Lines) -> np.ndarray | None:
        """Which streamlines are shown, (n_streamlines,) bool; None for all."""
        masks = [condition.mask for condition in self.conditions.values()]
        if per_streamline := self._of_kind("streamline"):
            from pvfiblets.query.selection.bits import streamline_mask

            masks.append(streamline_mask(lines, [c.within() for c in per_streamline]))
        masks += [mask for mask in (self.subset, self.ids) if mask is not None]
        if self.groups is not None:
            shown = in_groups(lines, self.groups)
            masks.append(shown | ~in_groups(lines, lines.groups) if self.ungrouped else shown)
        return reduce(operator.and_, masks) if masks else None

    def points(self, lines: Lines) -> np.ndarray | None:
        """Bits of the points that are shown, uint32, in coded order; None for all."""
        per_point = self._of_kind("point")
        if not per_point:
            return None
        if self._words is None or self._words[0] != per_point:
            from pvfiblets.query.selection.bits import point_words

            self._words = per_point, point_words(lines, [c.within() for c in per_point])
        return self._words[1]

    def _of_kind(self, kind: str) -> tuple[Criterion, ...]:
        return tuple(c for c in self.criteria.values() if c.values.kind == kind)

    def show(self, subject: Subject) -> None:
        """Have shown what is chosen."""
        if self.any:
            subject.show(self.mask(subject.lines), self.points(subject.lines))
        else:
            subject.show(None, None)

    def made_for(self, subject: Subject, before: Subject) -> Choices:
        """Return the same choices for other lines than those before."""
        if not self.any:
            return Choices()
        lines, criteria = subject.lines, {}
        for name, c in self.criteria.items():
            try:
                values = subject.measure(c.what)
            except (KeyError, ValueError) as error:
                raise type(error)(
                    f"criterion {name!r} does not fit these {subject.NOUN}: {error.args[0]}; "
                    f"remove_criterion({name!r}) first"
                ) from error
            criteria[name] = replace(c, values=values)
        conditions = {n: replace(c, mask=subject.where(c.predicate)) for n, c in self.conditions.items()}
        same = len(lines) == len(before.lines)
        return Choices(
            criteria=criteria,
            conditions=conditions,
            groups=self.groups if self.groups and set(self.groups) <= set(lines.groups) else None,
            ungrouped=self.ungrouped,
            subset=self.subset if same else None,
            ids=self.ids if same else None,
        )

    def explain(self, lines: Lines) -> dict[str, Any]:
        """Return what is chosen, and of how many streamlines."""
        mask, total = self.mask(lines), len(lines)
        return {
            "streamlines": {"total": total, "shown": total if mask is None else int(mask.sum())},
            "criteria": {name: c.range for name, c in self.criteria.items()},
            "conditions": list(self.conditions),
            "groups_shown": self.groups,
        }


def in_groups(lines: Lines, names: Iterable[str]) -> np.ndarray:
    """Which streamlines are in any of some groups, (n_streamlines,) bool."""
    mask = np.zeros(len(lines), bool)
    for name in names:
        if name not in lines.groups:
            there = ", ".join(repr(group) for group in lines.groups) or "none"
            raise KeyError(f"there is no group {name!r}; there are: {there}")
        mask[np.asarray(lines.groups[name])] = True
    return mask


OPEN = (-math.inf, math.inf)


def checked_range(limits: Any) -> tuple[float, float]:
    """Return both ends of a range; an end that is None is open."""
    try:
        low, high = (end if given is None else float(given) for given, end in zip(limits, OPEN, strict=True))
    except (TypeError, ValueError) as error:
        raise ValueError(f"range is {limits!r}; give two numbers, (low, high), None for an open end") from error
    if math.isnan(low) or math.isnan(high) or low > high:
        raise ValueError(f"range is ({low:g}, {high:g}); give two numbers, the low one first")
    return low, high


def as_predicate(condition: Any, make_region: Callable[[Any], Region]) -> Predicate:
    """Return a predicate; of a region alone, that of streamlines which pass through it, of a mask that of its own."""
    if isinstance(condition, np.ndarray) and condition.dtype == bool and condition.ndim == 1:
        return Listed(condition.copy())
    return condition if isinstance(condition, Predicate) else passes(make_region(condition))


def unique_name(taken: Iterable[str], stem: str) -> str:
    """Return the first of ``stem 1``, ``stem 2`` … that is not taken."""
    taken = set(taken)
    return next(name for i in range(1, len(taken) + 2) if (name := f"{stem} {i}") not in taken)

