"""Picking: which streamlines lie under the mouse, in a box, or within a lasso."""

from __future__ import annotations


class Picking:
    """The part of :class:`~pvfiblets.plotting.component.FibletsComponent` that picks."""
