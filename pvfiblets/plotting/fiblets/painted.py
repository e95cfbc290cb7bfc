"""Painted regions that filter an actor for as long as they are painted."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from pvfiblets.plotting.filtering.state import unique_name
from pvfiblets.query.selection.predicates import Listed

if TYPE_CHECKING:
    from collections.abc import Mapping

    from pvfiblets.query.painting.live import LiveRegions


def follow_painted(actor: Any, live: LiveRegions, name: str | None, how: Mapping[str, Any]) -> str:
    """Add a condition that painted regions make, and make it anew after each stroke until it is taken back."""
    chosen = unique_name(actor.conditions, "painted") if name is None else name
    held = [Listed(live.select(**how))]
    actor.include(held[0], name=chosen)
    reference = weakref.ref(actor)
    listeners = live.painter.listeners

    def stroke(_stroke: Any) -> None:
        alive = reference()
        if alive is None or alive.conditions.get(chosen) is not held[0]:  # another has its name, or none
            listeners.remove(stroke)
            return
        held[0] = Listed(live.select(**how))
        alive.include(held[0], name=chosen)

    listeners.append(stroke)
    return chosen
