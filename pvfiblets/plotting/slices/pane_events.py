"""Mouse and keys of the workspace.

Observers stand on the interactor, before the pickers of streamlines and before its style. Events in a pane never
reach the style; in the 3-D view only clicks are handled.
"""

from __future__ import annotations

import re
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.plotting.fiblets.mouse_gestures import Pointing

if TYPE_CHECKING:
    from pvfiblets.plotting.slices.layer import SliceLayer
    from pvfiblets.plotting.slices.pane import Pane
    from pvfiblets.plotting.slices.workspace import Workspace

PRIORITY = 0.4  # widgets have 0.5, picking 0.25
ZOOM = 1.15  # per notch of the wheel
WINDOWED = 400.0  # pixels of a drag that double a window's width, or move it by its width

_STEPS = {
    "Left": (-1, 0, 0), "Right": (1, 0, 0), "Up": (0, 1, 0), "Down": (0, -1, 0), "Prior": (0, 0, 1), "Next": (0, 0, -1),
}  # fmt: skip
_TYPED = re.compile(r"^\s*(v?)\s*([^v]*)$")


class PaneEvents:
    """Gestures of one workspace."""

    def __init__(self, workspace: Workspace, plotter: pv.BasePlotter) -> None:
        self._workspace = weakref.proxy(workspace)  # not kept alive
        self.windowed: list[Callable[[SliceLayer], Any]] = []  # called after a drag that changed a layer's window
        self._interactor = plotter.iren.interactor
        self._dragging: tuple[str, Pane] | None = None
        self._handle: int | None = None
        self._last = "axial"
        self._typed: str | None = None
        self._ends: list[Callable[[], None]] = []
        for button in ("Left", "Middle", "Right"):
            self._listen(f"{button}ButtonPressEvent", getattr(self, f"_press_{button.lower()}"))
            self._listen(f"{button}ButtonReleaseEvent", self._release)
        self._listen("MouseMoveEvent", self._move)
        self._listen("MouseWheelForwardEvent", self._wheel_forward)
        self._listen("MouseWheelBackwardEvent", self._wheel_backward)
        self._listen("KeyPressEvent", self._key)
        self._listen("CharEvent", self._char)
        self._clicks = Pointing(
            plotter, mode="click", button="left", found=weakly(self._clicked, passing=True), hovered=None,
            color="white", start=False,
        )  # fmt: skip

    def _listen(self, event: str, handler: Callable[[], bool]) -> None:
        """Call a handler for as long as this is alive; if it returns True, the event goes no further."""
        self._ends.append(observe(self._interactor, (event,), weakly(handler), PRIORITY))

    def stop(self) -> None:
        """Take all observers back; twice is harmless."""
        for end in self._ends:
            end()
        self._clicks.stop()

    @property
    def _pixel(self) -> tuple[int, int]:
        x, y = self._interactor.GetEventPosition()
        return x, y

    def _pane(self) -> Pane | None:
        pane: Pane | None = self._workspace.pane_at(*self._pixel)
        if pane is not None:
            self._last = pane.name
        return pane

    # Mouse --------------------------------------------------------------------------------------

    def _press_left(self) -> bool:
        return self._press("pan" if self._interactor.GetShiftKey() else "move")

    def _press_middle(self) -> bool:
        return self._press("pan")

    def _press_right(self) -> bool:
        return self._press("zoom" if self._interactor.GetControlKey() else "window")

    def _press(self, what: str) -> bool:
        pane = self._pane()
        if pane is None:
            return False
        self._dragging = what, pane
        if what == "move":
            self._handle = self._taken(pane)
            if self._handle is None:
                self._go(pane)
            else:
                self._workspace.oblique.hold(True)
        return True

    def _taken(self, pane: Pane) -> int | None:
        """Return which handle of the oblique slice's line the mouse has taken hold of."""
        oblique = self._workspace.oblique
        trace = None if oblique is None else oblique.traces.get(pane.name)
        return None if trace is None else trace.handle_at(*self._pixel)

    def _turn(self, pane: Pane) -> None:
        oblique = self._workspace.oblique
        normal = oblique.traces[pane.name].normal_towards(*self._pixel, self._handle)
        if normal is not None:
            oblique.normal = normal
            self._workspace.render()

    def _release(self) -> bool:
        dragging, self._dragging = self._dragging, None
        if dragging is not None and dragging[0] == "window":
            for callback in self.windowed:
                pv.try_callback(callback, self._workspace.active)
        if self._workspace.oblique is not None:
            self._workspace.oblique.hold(False)
        return dragging is not None

    def _move(self) -> bool:
        if self._dragging is None:
            return False
        what, pane = self._dragging
        # VTK's own last place: a window that gets another size within a drag moves it, too.
        right, up = np.subtract(self._pixel, self._interactor.GetLastEventPosition())
        if what == "move":
            if self._handle is None:
                self._go(pane)
            else:
                pv.try_callback(self._turn, pane)
            return True
        if what == "pan":
            pane.pan_by(right, up)
        elif what == "zoom":
            pane.zoom *= ZOOM ** (up / 20.0)
        else:
            self._window(right, up)
        self._workspace.render()
        return True

    def _go(self, pane: Pane) -> None:
        pv.try_callback(self._set, pane.position_at(*self._pixel))

    def _set(self, position: Any) -> None:
        self._workspace.position = position
        self._workspace.render()

    def _window(self, right: float, up: float) -> None:
        layer = self._workspace.active
        if layer.kind in ("labels", "rgb"):
            return
        low, high = layer.clim
        width = (high - low) * 2.0 ** (right / WINDOWED)
        middle = 0.5 * (low + high) - (high - low) * up / WINDOWED  # upwards brightens
        layer.clim = middle - 0.5 * width, middle + 0.5 * width

    def _wheel_forward(self) -> bool:
        return self._wheel(1)

    def _wheel_backward(self) -> bool:
        return self._wheel(-1)

    def _wheel(self, way: int) -> bool:
        pane = self._pane()
        if pane is None:
            return False
        if self._interactor.GetControlKey():
            pane.zoom *= ZOOM**way
            self._workspace.render()
        else:
            pv.try_callback(self._step, pane.name, 0, 0, way)
        return True

    def _step(self, name: str, *steps: int) -> None:
        self._workspace.step(name, *steps)
        self._workspace.render()

    def _clicked(self, corners: np.ndarray, _click: bool, _mode: str) -> None:
        position = self._workspace.picked_in_view(*corners[0])
        if position is not None:
            self._set(position)

    # Keys ---------------------------------------------------------------------------------------

    def _key(self) -> bool:
        word = self._interactor.GetKeySym()
        if self._typed is not None:
            return self._type(word)
        if word in _STEPS:
            self._pane()
            pv.try_callback(self._step, self._last, *_STEPS[word])
            return True
        if word in ("g", "G"):
            self._typed = ""
            self._prompt()
            return True
        return False

    def _char(self) -> bool:
        """Keep typed and stepping keys from the style."""
        return self._typed is not None or self._interactor.GetKeySym() in (*_STEPS, "g", "G")

    def _type(self, word: str) -> bool:
        assert self._typed is not None
        if word in ("Return", "KP_Enter"):
            text, self._typed = self._typed, None
            pv.try_callback(self._take, text)
        elif word == "Escape":
            self._typed = None
            self._workspace.say(None)
            self._workspace.render()
        else:
            if word == "BackSpace":
                self._typed = self._typed[:-1]
            else:
                code = str(self._interactor.GetKeyCode())
                self._typed += code if code in "0123456789.-+, vV" else ""
            self._prompt()
        return True

    def _prompt(self) -> None:
        self._workspace.say(f"go to (mm, or v for voxels): {self._typed}_")
        self._workspace.render()

    def _take(self, text: str) -> None:
        found = _TYPED.match(text.lower())
        try:
            parts = [float(part) for part in (found[2] if found else "").replace(",", " ").split()]
        except ValueError:
            parts = []
        if found is None or len(parts) != 3:
            self._workspace.say(f"{text!r} is no position; type three numbers")
        elif found[1]:
            self._workspace.voxel = parts
        else:
            self._workspace.position = parts
        self._workspace.render()
