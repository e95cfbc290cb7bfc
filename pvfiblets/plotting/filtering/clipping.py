"""Cuts by regions of space, which add up: of actors of fiblets and of volumes."""

from __future__ import annotations

import operator
from collections.abc import Mapping
from functools import reduce
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

from pvfiblets.plotting.actors.coloured import ColouredActor
from pvfiblets.plotting.filtering.region_sources import as_region, slab
from pvfiblets.plotting.filtering.state import unique_name

if TYPE_CHECKING:
    from pvfiblets.mappers.engine_mapper import CutMapper
    from pvfiblets.regions import Region


class ClippedActor(ColouredActor):
    """Actor that regions of space can cut."""

    _mapper: CutMapper[Any]
    _clips: Mapping[str, Region] = MappingProxyType({})

    def clip(self, what: Any, inside: bool = True, *, name: str | None = None) -> str:
        """Show only the part inside a region, or outside.

        Parameters
        ----------
        what : region-like
            A region of :mod:`pvfiblets.regions`, a closed mesh, six bounds, or a plane as
            ``(normal, origin)``. In world coordinates. Several cuts add up; ``&``, ``|``, ``~`` of
            regions make others.
        inside : bool, default: True
            Show the inside; of a plane, the side to which its normal points. False shows the outside.
        name : str, optional
            Replaces the cut of the same name.

        Returns
        -------
        str
            The name, for :meth:`unclip`.

        Raises
        ------
        TypeError
            If that is no region.
        ValueError
            If a mesh is open, empty or inside-out, a number makes no sense, or it is of labels.
        """
        from pvfiblets.engine.regions.clip_planes import check_region

        region = as_region(what)
        check_region(region)
        name = unique_name(self._clips, "clip") if name is None else name
        self._cut({**self._clips, name: region if inside else ~region})
        return name

    def clip_slab(self, normal: Any, origin: Any, thickness: float, *, name: str | None = None) -> str:
        """Show only a slab, such as a thick radiological slice.

        Parameters
        ----------
        normal : str or (3,) array
            ``"x"``, ``"y"``, ``"z"``, or a direction.
        origin : float or (3,) array
            A point of its middle plane; for an axis a coordinate will do, mm.
        thickness : float
            mm.
        name : str, optional
            Replaces the cut of the same name.

        Returns
        -------
        str
            The name, for :meth:`unclip`.
        """
        return self.clip(slab(normal, origin, thickness), name=name)

    def unclip(self, name: str | None = None) -> None:
        """Remove a cut by its `name`, or all."""
        self._cut(without(self._clips, name, "cut"))

    @property
    def clips(self) -> Mapping[str, Region]:
        """Cuts by name, in order of creation."""
        return MappingProxyType(dict(self._clips))

    def _cut(self, clips: Mapping[str, Region]) -> None:
        """Cut by these, and no others."""
        self._mapper.region = reduce(operator.and_, clips.values()) if clips else None
        self._clips = clips

    def _be_like(self, other: Self, deep: bool) -> None:
        super()._be_like(other, deep)
        self._cut(other._clips)


def without(known: Mapping[str, Any], name: str | None, kind: str) -> dict[str, Any]:
    """Return a mapping without one of its entries, or, of None, an empty one."""
    if name is None:
        return {}
    if name not in known:
        there = ", ".join(repr(key) for key in known) or "none"
        raise KeyError(f"there is no {kind} {name!r}; there are: {there}")
    return {key: value for key, value in known.items() if key != name}
