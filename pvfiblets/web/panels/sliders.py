"""Sliders act while they are dragged.

Browsers send a slider's newest value when the one before has been taken, so that nothing piles up. Meanwhile the page's
record of the slider is left alone, or its thumb would jump back to where it was a moment ago; only its number follows.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pvfiblets.web.actions import Actions
from pvfiblets.web.panels.charts import short

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer

FILTERS = ("region", "handle", "criterion", "share")
SETTLED = 3.0  # seconds without a word from the slider after which the page is brought in step


class SlideActions(Actions):
    """The sliders of an application."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self.moving = False
        self._timer: asyncio.TimerHandle | None = None
        self._moves: dict[str, Callable[[Any, Any, Any], None]] = {
            "property": lambda layer, name, value: app.scene.set(layer, name, value),
            "clip": lambda clip, name, value: app.cuts.set_value(clip, name, value),
            "region": lambda row, name, value: app.regions.set_value(row, name, value),
            "handle": lambda row, name, place: app.regions.drag(row, name, place),
            "criterion": lambda _, name, value: app.filtering.set_criterion(name, value),
            "oblique": lambda _, which, value: app.slices.set_angle(int(which == "1"), value),
            "share": lambda _, __, value: app.filtering.set_share(value),
        }

    def slide(self, kind: str, owner: Any, name: str, value: Any) -> None:
        """Take a value that a slider passes."""
        move = self._moves.get(kind) if isinstance(kind, str) else None
        if move is None:
            raise ValueError(f"there are no sliders of {str(kind)[:40]!r}; there are {', '.join(self._moves)}")
        app = self._app
        app.history.held = True
        self.moving = True
        try:
            move(owner, name, value)
        finally:
            self.moving = False
            self._settle_later()
        ends = value if isinstance(value, list) else [value]
        held = {"at": f"{kind} {owner} {name}", "shown": [short(float(end)) for end in ends]}
        if kind in FILTERS:
            held["counted"] = app.filtering.counted()
        with app.state:
            app.page.held = held

    def release(self) -> None:
        """Note that a slider was released: its next move is another step to undo."""
        self._app.history.held = False
        if self._timer is not None:
            self._settle()

    def _settle_later(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        self._timer = asyncio.get_running_loop().call_later(SETTLED, self._settle)

    def _settle(self) -> None:
        """Bring the page in step."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        with self._app.state:
            self._app.page.held = {}
        self._app.refresh()
