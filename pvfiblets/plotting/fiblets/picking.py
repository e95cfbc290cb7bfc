"""Picking: which streamlines lie under the mouse, in a box, or within a lasso."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.fiblets.mouse_gestures import Pointing
from pvfiblets.plotting.fiblets.pick_overlay import Tooltip, standing_out
from pvfiblets.plotting.fiblets.pick_result import Picked, everything, visible

if TYPE_CHECKING:
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


class Picking:
    """The part of :class:`~pvfiblets.plotting.fiblets.component.FibletsComponent` that picks."""

    _plotter: Any

    if TYPE_CHECKING:

        def __iter__(self) -> Iterator[FibletActor]: ...

    def _init_picking(self) -> None:
        self._pointing: Pointing | None = None
        self._tooltip: Tooltip | None = None
        self._message = False

    def enable_picking(
        self,
        callback: Callable[[Picked], Any] | None = None,
        *,
        mode: str = "click",
        through: bool = False,
        button: str = "left",
        tolerance: float = 4.0,
        tooltip: bool | Callable[[Picked], str] = False,
        select: bool = True,
        start: bool = False,
        show_message: bool | str = True,
        font_size: int = 18,
        color: Any = None,
    ) -> None:
        """Pick streamlines with the mouse; what was enabled before is disabled.

        Parameters
        ----------
        callback : callable, optional
            Called with a :class:`~pvfiblets.plotting.fiblets.pick_result.Picked` for each actor of which
            something was picked, and not at all where there is nothing.
        mode : {"click", "box", "lasso"}
            ``"click"``: the streamline nearest to the mouse; dragging still turns the camera.
            ``"box"`` and ``"lasso"``: all within what is drawn with the left button, after the
            ``r`` key has been pressed, which is PyVista's key for rectangles, until it is pressed
            again. A click picks then, too.
        through : bool, default: False
            Everything under the mouse or the area, hidden streamlines too. Else only what is seen:
            the ids are those of the picture. Opaque actors in front do hide streamlines;
            translucent ones do not.
        button : {"left", "right"}
            That clicks.
        tolerance : float, default: 4.0
            Pixels between the mouse and a streamline.
        tooltip : bool or callable, default: False
            Say beside the mouse which streamline is under it, where along it, its value and its
            groups; or what a function of a :class:`Picked` says.
        select : bool, default: True
            Select what is picked (:meth:`FibletActor.select`): with Shift it is added, with Control
            it changes sides. Nothing picked and no key held: nothing is selected.
        start : bool, default: False
            Draw areas at once, without the ``r`` key.
        show_message : bool or str, default: True
            Show how to pick.
        font_size : int, default: 18
            Of the message.
        color : color-like, optional
            Of the outline of areas and of the message; black or white by default, whichever stands
            out against the background.

        Raises
        ------
        TypeError
            If the callback cannot be called.
        ValueError
            If there is no such mode or button, or the tolerance is not a distance.
        RuntimeError
            If the plotter is closed.
        """
        if callback is not None and not callable(callback):
            raise TypeError(f"callback is a {type(callback).__name__}; give a function of what was picked")
        if mode not in MODES:
            raise ValueError(f"mode is {mode!r}; choose one of {', '.join(MODES)}")
        if button not in BUTTONS:
            raise ValueError(f"button is {button!r}; choose one of {', '.join(BUTTONS)}")
        if not (math.isfinite(tolerance) and tolerance >= 0.0):
            raise ValueError(f"tolerance is {tolerance!r}; give pixels, 0 or more")
        if getattr(self._plotter, "iren", None) is None:
            raise RuntimeError("this plotter is closed and has no mouse; make a new one")
        self.disable_picking()

        def found(corners: np.ndarray, click: bool, selecting: str) -> None:
            if self._tooltip is not None and self._tooltip.remove():
                self._plotter.render()  # or what it covered would count as hidden
            results = self._pick(corners, click, through, float(tolerance))
            if select:
                self._select(results, selecting)
            for picked in results:
                if callback is not None:
                    callback(picked)
            self._plotter.render()

        hovered = None
        if tooltip:
            say = tooltip if callable(tooltip) else describe
            self._tooltip = Tooltip()
            hovered = self._hover(self._tooltip, say, float(tolerance))
        if color is None:
            color = standing_out(self._plotter.renderer.background_color)
        self._pointing = Pointing(
            self._plotter,
            mode=mode,
            button=button,
            found=found,
            hovered=hovered,
            color=color,
            start=start,
        )
        if show_message:
            text = MESSAGES[mode].format(button.capitalize()) if show_message is True else show_message
            self._plotter.add_text(
                text, font_size=font_size, color=color, name=_MESSAGE, render=False
            )
            self._message = True

    def disable_picking(self) -> None:
        """Undo :meth:`enable_picking`; what is selected stays. Twice is harmless."""
        if self._pointing is not None:
            self._pointing.stop()
            self._pointing = None
        if self._tooltip is not None:
            self._tooltip.remove()
            self._tooltip = None
        if self._message:
            self._plotter.remove_actor(_MESSAGE, render=False)
            self._message = False

    def _pickable(self, renderer: Any) -> list[FibletActor]:
        """Return what may be picked in a renderer."""
        return [
            actor for actor in self if renderer.HasViewProp(actor) and actor.visibility and actor.pickable
        ]

    def _pick(
        self, corners: np.ndarray, click: bool, through: bool, tolerance: float
    ) -> list[Picked]:
        """Return what lies under a click or in an area, one entry for each actor."""
        x, y = corners[0]
        renderer = self._plotter.iren.interactor.FindPokedRenderer(round(x), round(y))
        if renderer is None:
            return []
        reach = tolerance if click else 0.0
        results = []
        for actor in self._pickable(renderer):
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
            for actor in self:
                if actor not in chosen and len(actor.selection):
                    actor.deselect()

    def _hover(
        self, shown: Tooltip, say: Callable[[Picked], str], tolerance: float
    ) -> Callable[[tuple[int, int]], None]:
        """Return what answers when the mouse has moved."""
        rested = 0.0

        def hovered(pixel: tuple[int, int]) -> None:
            nonlocal rested
            began = time.monotonic()
            if began < rested:
                return
            results = self._pick(np.array([pixel], np.float64), True, False, tolerance)
            text = say(results[0]) if results else ""
            renderer = self._plotter.iren.interactor.FindPokedRenderer(*pixel)
            if shown.show(renderer, text, pixel):
                self._plotter.render()
            now = time.monotonic()
            rested = now + _REST * (now - began)

        return hovered


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
