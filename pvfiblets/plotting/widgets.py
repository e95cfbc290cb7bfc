"""Widgets that cut: planes, boxes, slabs and meshes that a user drags."""

from __future__ import annotations


class Widgets:
    """The part of :class:`~pvfiblets.plotting.component.FibletsComponent` that adds widgets."""
