"""Conditions on the position of streamlines, joined by ``&``, ``|`` and ``~``.

A streamline is the line through its decoded points: it passes a region that it crosses between two of them, however
far apart they are (`segments`). With ``sampling="points"`` only the points count, as for MRtrix's ``tckedit``.

A streamline without points passes nothing, ends nowhere and stays nowhere; ``~passes(region)`` therefore holds for it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from ...streamlines import Streamlines
from ..regions.region import Region
from .point_flags import ALL, ANY, FIRST, LAST, Sampling, check_sampling

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

Mask = npt.NDArray[np.bool_]
Flags = npt.NDArray[np.uint8]
Ends = Literal["any", "both", "first", "last"]
FlagsOf = Callable[[Region, Sampling], Flags]
"""A function that returns a region's flags of every streamline, as :func:`.passing.region_flags` does."""

_Key = tuple[Region, Sampling]


class Predicate(ABC):
    """A condition on streamlines; immutable, equal and hashed by content."""

    def __and__(self, other: Predicate) -> Predicate:
        return _Joined(self, other, "&") if isinstance(other, Predicate) else NotImplemented

    def __or__(self, other: Predicate) -> Predicate:
        return _Joined(self, other, "|") if isinstance(other, Predicate) else NotImplemented

    def __invert__(self) -> Predicate:
        return _Not(self)

    def __bool__(self) -> bool:
        raise TypeError("a condition is neither true nor false; join conditions with &, | and ~, not with and, or, not")

    @abstractmethod
    def conditions(self) -> Iterator[Condition]:
        """Yield the conditions of the expression."""

    @abstractmethod
    def holds(self, flags: Callable[[Condition], Flags]) -> Mask:
        """Return which streamlines satisfy it, ``(n_streamlines,)`` bool, from the flags of its regions."""

    def choose(self, fiblets: FibletSet | Streamlines, *, flags: FlagsOf | None = None) -> Mask:
        """Return the streamlines of a set that satisfy it; see :func:`select`."""
        return select(fiblets, self, flags=flags)


@dataclass(frozen=True)
class Condition(Predicate):
    """The relation of a streamline to one region."""

    region: Region
    needed: int  # flags of `.passing`
    every: bool = False  # whether all of these flags must be set, or any one
    sampling: Sampling = "lines"  # what of the streamline counts

    def conditions(self) -> Iterator[Condition]:  # noqa: D102 - Predicate's
        yield self

    def holds(self, flags: Callable[[Condition], Flags]) -> Mask:  # noqa: D102 - Predicate's
        found = flags(self) & np.uint8(self.needed)
        return found == self.needed if self.every else found != 0


@dataclass(frozen=True)
class _Joined(Predicate):
    a: Predicate
    b: Predicate
    how: Literal["&", "|"]

    def conditions(self) -> Iterator[Condition]:
        yield from self.a.conditions()
        yield from self.b.conditions()

    def holds(self, flags: Callable[[Condition], Flags]) -> Mask:
        a, b = self.a.holds(flags), self.b.holds(flags)
        return a & b if self.how == "&" else a | b


@dataclass(frozen=True)
class _Not(Predicate):
    a: Predicate

    def conditions(self) -> Iterator[Condition]:
        yield from self.a.conditions()

    def holds(self, flags: Callable[[Condition], Flags]) -> Mask:
        return ~self.a.holds(flags)


@dataclass(frozen=True, eq=False)
class Listed(Predicate):
    """Streamlines that are known already, to be joined with conditions."""

    mask: Mask  # `(n_streamlines,)` bool

    def conditions(self) -> Iterator[Condition]:  # noqa: D102 - Predicate's
        return iter(())

    def holds(self, flags: Callable[[Condition], Flags]) -> Mask:  # noqa: ARG002, D102 - Predicate's
        return self.mask


def passes(region: Region, *, sampling: Sampling = "lines") -> Predicate:
    """Return the condition that a streamline passes through the region, at a point or between two points.

    Parameters
    ----------
    region : Region
        Region in mm.
    sampling : {'lines', 'points'}
        ``'lines'``: the segments between points count too. ``'points'``: only points count, as for MRtrix's
        ``tckedit``.

    Raises
    ------
    TypeError
        If `region` is not a region.
    ValueError
        If `sampling` is unknown.

    Notes
    -----
    The parts of each segment inside each shape are computed in float64 and joined like the shapes: a segment passes
    ``a & b`` if one of its positions lies in both. A segment passes a voxel of labels if some of its length lies
    inside; it passes any other shape even if it only touches the boundary.
    """
    return Condition(_region(region, "passes"), ANY, sampling=check_sampling(sampling))


def stays_in(region: Region, *, sampling: Sampling = "lines") -> Predicate:
    """Return the condition that a streamline lies entirely in the region; parameters as for :func:`passes`."""
    return Condition(_region(region, "stays_in"), ALL, sampling=check_sampling(sampling))


def ends_in(region: Region, which: Ends = "any") -> Predicate:
    """Return the condition that a streamline's first or last point lies in the region.

    Parameters
    ----------
    region : Region
        Region in mm.
    which : {'any', 'both', 'first', 'last'}
        Ends that must lie in the region: at least one, both, the first point or the last point.

    Raises
    ------
    TypeError
        If `region` is not a region.
    ValueError
        If `which` is unknown.
    """
    if which not in get_args(Ends):
        raise ValueError(f"which is {which!r}; give one of {', '.join(map(repr, get_args(Ends)))}")
    needed = {"first": FIRST, "last": LAST}.get(which, FIRST | LAST)
    return Condition(_region(region, "ends_in"), needed, every=which == "both")


def select(fiblets: FibletSet | Streamlines, predicate: Predicate, *, flags: FlagsOf | None = None) -> Mask:
    """Return the streamlines, compressed or not, that satisfy a condition."""
    if not isinstance(predicate, Predicate):
        hint = "; ask passes(region), ends_in(region) or stays_in(region)" if isinstance(predicate, Region) else ""
        raise TypeError(f"a {type(predicate).__name__} is no condition on streamlines{hint}")
    needed = _needed(predicate)
    found: dict[_Key, Flags] = {}
    for (region, sampling), bits in needed.items():
        if flags is not None:
            found[region, sampling] = flags(region, sampling)
        elif isinstance(fiblets, Streamlines):
            from .line_flags import line_flags

            found[region, sampling] = line_flags(fiblets.points, fiblets.offsets, region, sampling)
        else:
            from .passing import region_flags

            found[region, sampling] = region_flags(fiblets, region, sampling, bits=bits)
    for listed in _listed(predicate):
        if listed.mask.shape != (len(fiblets),):
            raise ValueError(f"a mask of streamlines has the shape {listed.mask.shape}; give {len(fiblets):,}")
    return predicate.holds(lambda condition: found[_key(condition, needed)])


def _listed(predicate: Predicate) -> Iterator[Listed]:
    """Yield the lists that a condition is made of."""
    if isinstance(predicate, Listed):
        yield predicate
    for part in (getattr(predicate, "a", None), getattr(predicate, "b", None)):
        if isinstance(part, Predicate):
            yield from _listed(part)


def _needed(predicate: Predicate) -> dict[_Key, int]:
    """Flags that are needed of each region and sampling."""
    bits: dict[_Key, int] = {}
    # Ends are points, whatever lies between them: they are computed along with another condition on their region.
    for condition in sorted(predicate.conditions(), key=_asks_for_ends):
        key = _key(condition, bits)
        bits[key] = bits.get(key, 0) | condition.needed
    return bits


def _asks_for_ends(condition: Condition) -> bool:
    return not condition.needed & (ANY | ALL)


def _key(condition: Condition, there: dict[_Key, int]) -> _Key:
    key = (condition.region, condition.sampling)
    if _asks_for_ends(condition) and key not in there:
        return next((other for other in there if other[0] == condition.region), key)
    return key


def _region(region: Any, name: str) -> Region:
    if not isinstance(region, Region):
        raise TypeError(f"{name} needs a region such as pvfiblets.regions.Sphere(center, radius), got {region!r}")
    return region
