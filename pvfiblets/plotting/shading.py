"""How an actor's lines are shaded: each effect is off, and costs nothing, until it is set."""

from __future__ import annotations


class Shading:
    """The part of :class:`~pvfiblets.plotting.actor.FibletActor` that shades."""
