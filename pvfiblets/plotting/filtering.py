"""Which streamlines, and which parts of them, an actor shows: criteria, regions, groups, subsets, and cuts."""

from __future__ import annotations


class Filtering:
    """The part of :class:`~pvfiblets.plotting.actor.FibletActor` that chooses what is there to be drawn."""
