"""Mouse gestures: clicks, rectangles and lassos, in places of the window.

Observers stand on the interactor, before its style and after widgets. A click leaves the event to the style, so that
the camera still turns when the mouse is dragged; while an area is drawn the style gets none of the left button's
events. A style that turns the camera takes all events to itself until the button is up: that it has stopped is heard
from the style.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pyvista as pv

from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.plotting.fiblets.pick_overlay import Outline

PRIORITY = 0.25  # widgets have 0.5, styles 0
STILL = 3.0  # pixels: a mouse that moved less between press and release has clicked
APART = 2.0  # pixels between corners of a lasso
TOGGLE = "r"  # PyVista's key for its own rectangle

Found = Callable[[np.ndarray, bool, str], None]


class Pointing:
    """Mouse events of one plotter."""

    def __init__(
        self,
        plotter: pv.BasePlotter,  # whose events
        *,
        mode: str,  # what the user draws
        button: str,  # that clicks; areas are drawn with the left one
        # called with the corners `(k, 2)` in window pixels, whether they are a click, and the mode of selecting that
        # the keys held down ask for
        found: Found,
        # called with the pixel when the mouse moves and no button is down
        hovered: Callable[[tuple[int, int]], None] | None,
        color: Any,  # of outlines
        start: bool,  # draw areas at once, before the key is pressed
    ) -> None:
        self._plotter = plotter
        self._interactor = plotter.iren.interactor
        self._mode = mode
        self._found = found
        self._hovered = hovered
        self._color = color
        self._ends: dict[str, Callable[[], None]] = {}
        self._forget_style: Callable[[], None] = lambda: None
        self._pressed: tuple[int, int] | None = None
        self._corners: list[tuple[int, int]] = []
        self._outline: Outline | None = None
        self.drawing = bool(start) and mode != "click"
        name = button.capitalize()
        if mode == "click":
            self._listen(f"{name}ButtonPressEvent", self._press_click)
            self._listen(f"{name}ButtonReleaseEvent", self._release_click)
        else:
            self._listen("LeftButtonPressEvent", self._press_area)
            self._listen("LeftButtonReleaseEvent", self._release_area)
            self._listen("MouseMoveEvent", self._move_area)
            self._listen("CharEvent", self._key)
        if hovered is not None and "MouseMoveEvent" not in self._ends:
            self._listen("MouseMoveEvent", self._move_area)

    def _listen(self, event: str, handler: Callable[[], bool]) -> None:
        """Call a handler; if it returns True, the event goes no further."""
        self._ends[event] = observe(self._interactor, (event,), weakly(handler), PRIORITY)

    def stop(self) -> None:
        """Take all observers back; twice is harmless."""
        for end in self._ends.values():
            end()
        self._ends.clear()
        self._forget_style()
        self._end_outline()

    @property
    def pixel(self) -> tuple[int, int]:
        """Position of the mouse, from the window's lower left corner."""
        x, y = self._interactor.GetEventPosition()
        return x, y

    def _selecting(self) -> str:
        if self._interactor.GetControlKey():
            return "toggle"
        return "add" if self._interactor.GetShiftKey() else "replace"

    # Clicks -------------------------------------------------------------------------------------

    def _press_click(self) -> bool:
        self._pressed = self.pixel
        self._forget_style()
        style = self._interactor.GetInteractorStyle()
        if style is not None:
            self._forget_style = observe(style, ("EndInteractionEvent",), weakly(self._release_click))
        return False

    def _release_click(self) -> bool:
        pressed, self._pressed = self._pressed, None
        self._forget_style()
        if pressed is not None and math.dist(pressed, self.pixel) <= STILL:
            self._tell(np.array([self.pixel], np.float64), click=True)
        return False

    def _tell(self, corners: np.ndarray, *, click: bool) -> None:
        pv.try_callback(self._found, corners, click, self._selecting())

    # Areas --------------------------------------------------------------------------------------

    def _key(self) -> bool:
        if str(self._interactor.GetKeyCode()).lower() != TOGGLE:
            return False
        self.drawing = not self.drawing
        self._corners.clear()
        self._end_outline()
        return True

    def _press_area(self) -> bool:
        if not self.drawing:
            return False
        x, y = self.pixel
        renderer = self._interactor.FindPokedRenderer(x, y)
        self._corners = [(x, y)]
        self._end_outline()
        self._outline = Outline(renderer, self._color)
        return True

    def _move_area(self) -> bool:
        if self._outline is None:
            if self._hovered is not None and self._pressed is None:
                pv.try_callback(self._hovered, self.pixel)
            return False
        if self._mode == "box":
            self._corners = [self._corners[0], self.pixel]
        elif math.dist(self._corners[-1], self.pixel) >= APART:
            self._corners.append(self.pixel)
        self._outline.show(self._area())
        self._plotter.render()
        return True

    def _release_area(self) -> bool:
        if self._outline is None:
            return False
        if self._mode == "box":
            self._corners = [self._corners[0], self.pixel]
        self._end_outline()
        self._plotter.render()  # or its pixels would count as something in front of the streamlines
        corners = np.array(self._corners, np.float64)
        click = bool((np.ptp(corners, axis=0) <= STILL).all())
        self._tell(corners[:1] if click else self._area(), click=click)
        return True

    def _area(self) -> np.ndarray:
        """Corners of the outline so far."""
        if self._mode == "lasso":
            return np.array(self._corners, np.float64)
        from pvfiblets.plotting.fiblets.pick_result import checked_box

        return checked_box([*self._corners[0], *self._corners[-1]])

    def _end_outline(self) -> None:
        if self._outline is not None:
            self._outline.remove()
            self._outline = None
