"""Which streamlines, and which parts of them, an actor shows: criteria, regions, groups, subsets, and cuts.

Choices add up: a streamline is shown where all of them agree. What is not shown is culled on the GPU, not only hidden,
and nothing is compressed or copied anew.
"""

from __future__ import annotations

import numbers
import operator
import os
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from pvfiblets.images.sources import as_image, is_image
from pvfiblets.plotting.fiblets.scalars import warn_if_apart
from pvfiblets.plotting.filtering.clipping import ClippedActor, without
from pvfiblets.plotting.filtering.state import (
    Choices,
    Condition,
    Criterion,
    as_predicate,
    checked_range,
    in_groups,
    unique_name,
)

if TYPE_CHECKING:
    from pvfiblets.mappers.engine_mapper import FilteredMapper
    from pvfiblets.plotting.filtering.state import Subject
    from pvfiblets.query.selection.predicates import Predicate


def _predicate(condition: Any) -> Predicate:
    from pvfiblets.plotting.filtering.region_sources import as_region

    return as_predicate(condition, as_region)


class FilteredActor(ClippedActor):
    """Actor of lines with filters; changes apply from the next render on."""

    _mapper: FilteredMapper[Any]
    _subject: Subject
    _choices: Choices

    # Values -------------------------------------------------------------------------------------

    @property
    def criteria(self) -> Mapping[str, tuple[float, float]]:
        """Ranges of all criteria, by name; to change one, call :meth:`criterion` again."""
        return MappingProxyType({name: c.range for name, c in self._choices.criteria.items()})

    def criterion(
        self,
        what: Any,
        range: Any,  # noqa: A002 - the word users look for
        *,
        keep_nan: bool = False,
        name: str | None = None,
    ) -> str:
        """Show only streamlines or segments with values in a range.

        Parameters
        ----------
        what : str, array, Distance or image
            ``"length"``, ``"n_points"``, ``"mean_curvature"``, ``"end_distance"`` or any number
            per streamline: streamlines are shown or not. ``"curvature"``, ``"arc_length"`` or any
            number per point: a streamline's segments are shown if both points are in
            range. An array with one number per streamline, or per point; or
            :class:`pvfiblets.regions.Distance` to a region or a point (mm); or an image, whose
            values at the points count: a path, ``(array, affine)``, an image of nibabel or an
            ImageData. The name of a criterion that there is changes that one's range.
        range : (float, float)
            Least and greatest value that is shown; infinite ends, and None, are open.
        keep_nan : bool, default: False
            Whether to show missing values.
        name : str, optional
            Replaces the criterion of the same name. By default that of the values; the same array
            or distance again changes its range, another one is one more criterion.

        Returns
        -------
        str
            The name.

        Raises
        ------
        KeyError
            If the values do not exist; the message lists the existing ones.
        ValueError
            If the range is invalid, or an array has the wrong length.
        """
        low, high = checked_range(range)
        known = self._choices.criteria
        if name is None and (not isinstance(what, str) or is_image(what)):
            name = next((known_as for known_as, c in known.items() if _same(c.what, what)), None)
        if isinstance(what, str) and what in known and name in (None, what):
            values, name, what = known[what].values, what, known[what].what
        elif name in known and _same(known[name].what, what):
            values = known[name].values
        else:
            values = self._subject.measure(what)
            if is_image(what) and not keep_nan and np.isnan(values.array()).all():
                warn_if_apart(self._subject.lines, as_image(what), "nothing is shown", stacklevel=3)
        if name is None:
            by_name = isinstance(what, str) and not is_image(what)
            is_new_file = isinstance(what, (str, os.PathLike)) and values.name not in known
            name = values.name if by_name or is_new_file else unique_name(known, values.name)
        criterion = Criterion(name, what, values, (low, high), bool(keep_nan))
        self._choose(criteria={**known, name: criterion})
        return name

    def remove_criterion(self, name: str | None = None) -> None:
        """Remove a criterion by its `name`, or all."""
        self._choose(criteria=without(self._choices.criteria, name, "criterion"))

    # Regions ------------------------------------------------------------------------------------

    def include(self, condition: Any, *, name: str | None = None) -> str:
        """Show only streamlines that satisfy a condition.

        Parameters
        ----------
        condition : Predicate, region-like or numpy.ndarray
            ``regions.passes(…)``, ``regions.ends_in(…)``, ``regions.stays_in(…)`` and what ``&``,
            ``|`` and ``~`` make of them. A region alone, a closed mesh, a label volume or six
            bounds stand for the streamlines that pass through it. In data coordinates. A mask,
            (n_streamlines,) bool, stands for itself.
        name : str, optional
            Replaces the condition of the same name.

        Returns
        -------
        str
            The name, for :meth:`remove_condition`.
        """
        return self._add_condition(_predicate(condition), name, "include")

    def exclude(self, condition: Any, *, name: str | None = None) -> str:
        """Hide streamlines that satisfy a condition; parameters and result as for :meth:`include`."""
        return self._add_condition(~_predicate(condition), name, "exclude")

    @property
    def conditions(self) -> Mapping[str, Predicate]:
        """Conditions that visible streamlines satisfy, by name."""
        return MappingProxyType({n: c.predicate for n, c in self._choices.conditions.items()})

    def remove_condition(self, name: str | None = None) -> None:
        """Remove a condition by its `name`, or all."""
        self._choose(conditions=without(self._choices.conditions, name, "condition"))

    def streamlines_where(self, condition: Any) -> np.ndarray:
        """Return the streamlines that satisfy a condition.

        Parameters
        ----------
        condition : Predicate or region-like
            As for :meth:`include`.

        Returns
        -------
        numpy.ndarray
            (n_streamlines,) bool, True if it holds. Computed on the GPU where possible, with the
            same answer.
        """
        return self._subject.where(_predicate(condition))

    # Subsets ------------------------------------------------------------------------------------

    def subset(self, amount: float | None = None, *, seed: int = 0, every: int | None = None) -> None:
        """Show a random or regular subset of the streamlines.

        Parameters
        ----------
        amount : float or int, optional
            A share below 1, or a number of streamlines, drawn at random.
        seed : int, default: 0
            Other seeds draw others. A smaller amount is a part of a larger one of the same seed.
        every : int, optional
            Streamlines 0, n, 2n and so on, instead.

        Raises
        ------
        ValueError
            If the amount or ``every`` is out of range, or both are given. Neither shows all again.
        """
        self._choose(subset=_subset(len(self._subject.lines), amount, seed, every))

    @property
    def groups_shown(self) -> tuple[str, ...] | None:
        """Names of the visible groups; None for all streamlines, also those without a group."""
        return self._choices.groups

    @groups_shown.setter
    def groups_shown(self, names: Iterable[str] | None) -> None:
        wanted = None if names is None else tuple([names] if isinstance(names, str) else names)
        if wanted is not None:
            in_groups(self._subject.lines, wanted)
        self._choose(groups=wanted, ungrouped=False)

    def show_only(self, ids: Any) -> None:
        """Show the streamlines of these `ids` only: numbers, a mask, a slice, a condition or region; None for all."""
        self._choose(ids=None if ids is None else self._mask_of(ids))

    def _mask_of(self, ids: Any) -> np.ndarray:
        from pvfiblets.codec.decompress import select_streamlines
        from pvfiblets.query.regions.region import Region
        from pvfiblets.query.selection.predicates import Predicate

        if isinstance(ids, Predicate | Region):
            return self.streamlines_where(ids)
        count = len(self._subject.lines)
        mask = np.zeros(count, np.bool_)
        mask[select_streamlines(count, getattr(ids, "ids", ids))] = True
        return mask

    @property
    def shown(self) -> np.ndarray:
        """Visible streamlines, (n_streamlines,) bool; cuts and per-point criteria do not count."""
        mask = self._choices.mask(self._subject.lines)
        return np.ones(len(self._subject.lines), bool) if mask is None else mask.copy()

    def show_all(self) -> None:
        """Remove all criteria, conditions, subsets and cuts."""
        self._choices = Choices()
        self._choose()
        self._cut({})

    # Inside -------------------------------------------------------------------------------------

    def _add_condition(self, predicate: Predicate, name: str | None, stem: str) -> str:
        known = self._choices.conditions
        name = unique_name(known, stem) if name is None else name
        mask = self._subject.where(predicate)
        self._choose(conditions={**known, name: Condition(name, predicate, mask)})
        return name

    def _choose(self, **changes: Any) -> None:
        """Make choices; one that is refused leaves all as they were."""
        before, self._choices = self._choices, self._choices.copy()
        for key, value in changes.items():
            setattr(self._choices, key, value)
        try:
            self._choices.show(self._subject)
        except Exception:
            self._choices = before
            raise

    def _explain_choices(self) -> dict[str, Any]:
        return {**self._choices.explain(self._subject.lines), "clips": list(self._clips)}

    def _values_of_criterion(self, scalars: Any) -> Any:
        """Return what a criterion was made of, where its name colours; all else as it is."""
        if isinstance(scalars, str) and scalars in self._choices.criteria:
            return self._choices.criteria[scalars].what
        return scalars

    def _be_like(self, other: Self, deep: bool) -> None:
        super()._be_like(other, deep)
        self._choices = other._choices.copy()
        self._choose()


def _same(a: Any, b: Any) -> bool:
    """Return True if two criteria have the same values: arrays by identity, distances by target, files by path."""
    from pvfiblets.query.measures.measures import Distance

    if isinstance(a, tuple) and isinstance(b, tuple):  # an array and its affine
        return len(a) == len(b) and all(map(operator.is_, a, b))
    kinds = (Distance, str, os.PathLike)
    return a is b or (isinstance(a, kinds) and isinstance(b, kinds) and a == b)


def _subset(count: int, amount: float | None, seed: int, every: int | None) -> np.ndarray | None:
    """Return (count,) bool, None for all."""
    if amount is not None and every is not None:
        raise ValueError(f"amount is {amount} and every is {every}; give one of them")
    if every is not None:
        if not isinstance(every, numbers.Real) or not every >= 1 or every % 1:
            raise ValueError(f"every is {every!r}; give a whole number above zero")
        return np.arange(count) % int(every) == 0
    if amount is None:
        return None
    whole = isinstance(amount, (int, np.integer)) and not isinstance(amount, bool)
    if whole and not 0 <= amount <= count:
        raise ValueError(f"amount is {amount}; there are {count} streamlines")
    if not whole and not (isinstance(amount, numbers.Real) and 0.0 <= amount <= 1.0):
        raise ValueError(f"amount is {amount!r}; give a share from 0 to 1, or a whole number")
    wanted = int(amount) if whole else round(float(amount) * count)
    mask = np.zeros(count, bool)
    mask[np.random.default_rng(seed).permutation(count)[:wanted]] = True
    return mask
