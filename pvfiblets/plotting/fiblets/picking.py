"""Picking: which streamlines lie under the mouse, in a box, or within a lasso."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.fiblets.mouse_gestures import Pointing
from pvfiblets.plotting.fiblets.pick_overlay import Tooltip, standing_out
from pvfiblets.plotting.fiblets.pick_result import Picked, everything, visible

if TYPE_CHECKING:
    import pyvista as pv

    from pvfiblets.plotting.fiblets.actor import FibletActor

MODES = ("click", "box", "lasso")
BUTTONS = ("left", "right")
MESSAGES = {
    "click": "{} click picks streamlines",
    "box": "Press R to toggle selection tool",
    "lasso": "Press R to toggle selection tool",
}
_MESSAGE = "_fiblets_picking_message"
_REST = 4.0  # a tooltip takes a fifth of the time at most


class MousePicking:
    """Streamlines of one plotter picked with the mouse, from `begin` to `stop`; arguments as of ``enable_picking``."""

    def __init__(
        self,
        plotter: pv.BasePlotter,
        actors: Iterable[FibletActor],
        callback: Callable[[Picked], Any] | None,
        *,
        mode: str,
        through: bool,
        button: str,
        tolerance: float,
        tooltip: bool | Callable[[Picked], str],
        select: bool,
    ) -> None:
        if callback is not None and not callable(callback):
            raise TypeError(f"callback is a {type(callback).__name__}; give a function that takes the result")
        if mode not in MODES:
            raise ValueError(f"mode is {mode!r}; choose one of {', '.join(MODES)}")
        if button not in BUTTONS:
            raise ValueError(f"button is {button!r}; choose one of {', '.join(BUTTONS)}")
        if not (math.isfinite(tolerance) and tolerance >= 0.0):
            raise ValueError(f"tolerance is {tolerance!r}; give pixels, 0 or more")
        if getattr(plotter, "iren", None) is None:
            raise RuntimeError("this plotter is closed and has no mouse; make a new one")
        self._plotter, self._actors, self._callback = plotter, actors, callback
        self._mode, self._button = mode, button
        self._through, self._tolerance, self._selects = through, float(tolerance), select
        self.tooltip = Tooltip() if tooltip else None
        self._say = tooltip if callable(tooltip) else describe
        self._rested = 0.0
        self._pointing: Pointing | None = None
        self._message = False

    def begin(self, *, start: bool, show_message: bool | str, font_size: int, color: Any) -> None:
        """Listen to the mouse."""
        if color is None:
            color = standing_out(self._plotter.renderer.background_color)
        self._pointing = Pointing(
            self._plotter,
            mode=self._mode,
            button=self._button,
            found=self._found,
            hovered=None if self.tooltip is None else self._hovered,
            color=color,
            start=start,
        )
        self._message = bool(show_message)
        if show_message:
            usual = MESSAGES[self._mode].format(self._button.capitalize())
            text = usual if show_message is True else show_message
            self._plotter.add_text(text, font_size=font_size, color=color, name=_MESSAGE, render=False)

    def stop(self) -> None:
        """Listen no longer, and take tooltip and message away."""
        if self._pointing is not None:
            self._pointing.stop()
        if self.tooltip is not None:
            self.tooltip.remove()
        if self._message:
            self._plotter.remove_actor(_MESSAGE, render=False)

    def _found(self, corners: np.ndarray, click: bool, selecting: str) -> None:
        if self.tooltip is not None and self.tooltip.remove():
            self._plotter.render()  # or covered lines would count as occluded
        results = self._pick(corners, click, self._through)
        if self._selects:
            self._select(results, selecting)
        for picked in results:
            if self._callback is not None:
                self._callback(picked)
        self._plotter.render()

    def _hovered(self, pixel: tuple[int, int]) -> None:
        began = time.monotonic()
        if self.tooltip is None or began < self._rested:
            return
        results = self._pick(np.array([pixel], np.float64), True, False)
        text = self._say(results[0]) if results else ""
        renderer = self._plotter.iren.interactor.FindPokedRenderer(*pixel)
        if self.tooltip.show(renderer, text, pixel):
            self._plotter.render()
        now = time.monotonic()
        self._rested = now + _REST * (now - began)

    def _pick(self, corners: np.ndarray, click: bool, through: bool) -> list[Picked]:
        """Return the picks under a click or in an area, one entry for each actor."""
        x, y = corners[0]
        renderer = self._plotter.iren.interactor.FindPokedRenderer(round(x), round(y))
        if renderer is None:
            return []
        reach = self._tolerance if click else 0.0
        results = []
        for actor in self._actors:
            if not (renderer.HasViewProp(actor) and actor.visibility and actor.pickable):
                continue
            if through:
                picked = everything(actor, corners, tolerance=reach, renderer=renderer)
            else:
                picked = visible(actor, corners, tolerance=reach, nearest=click, renderer=renderer)
            if picked is not None:
                results.append(picked)
        if click and not through:
            results.sort(key=lambda picked: (picked.distance, picked.depths[0]))
            return results[:1]
        return results

    def _select(self, results: list[Picked], selecting: str) -> None:
        for picked in results:
            picked.actor.select(picked, mode=selecting)
        if selecting == "replace":
            chosen = [picked.actor for picked in results]
            for actor in self._actors:
                if actor not in chosen and len(actor.selection):
                    actor.deselect()


def describe(picked: Picked) -> str:
    """Return what a tooltip says of the first streamline picked."""
    streamline, place, value = int(picked.ids[0]), float(picked.places[0]), float(picked.values[0])
    lines = [f"streamline {streamline}", f"point {place:.1f}"]
    if math.isfinite(value):
        lines.append(f"{picked.actor.scalars_title or 'value'}: {value:.4g}")
    groups = picked.actor.fiblets.groups
    names = [name for name, members in groups.items() if (np.asarray(members) == streamline).any()]
    if names:
        lines.append(f"in {', '.join(names)}")
    return "\n".join(lines)
