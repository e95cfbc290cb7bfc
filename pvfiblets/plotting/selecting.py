"""Streamlines that a user singled out: highlighted, counted, measured, saved."""

from __future__ import annotations


class Selecting:
    """The part of :class:`~pvfiblets.plotting.actor.FibletActor` that keeps a selection."""
