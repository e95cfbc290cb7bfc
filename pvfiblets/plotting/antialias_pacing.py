"""Timing of the samples of an idle picture: one at a time, between the user's events."""

from __future__ import annotations

import asyncio
import time
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pvfiblets.mappers.frames.observers import observe, weakly

if TYPE_CHECKING:
    import pyvista as pv
    from vtkmodules.vtkRenderingCore import vtkRenderWindowInteractor

__all__ = ["REST", "Pacer"]

REST = 0.15  # seconds without a frame after which a picture is at rest

PAUSE = 1  # milliseconds between samples, in which events of mouse and keys are heard

EARLY = 0.002  # seconds that a timer may come before its time


class Pacer:
    """Has the pictures of a plotter refined while nothing happens.

    In a window with an event loop, each frame starts a one-shot timer: of `REST` after a plain frame, of
    `PAUSE` after a sample. A window whose interactor must not render is a server's, such as a notebook's: there the
    running ``asyncio`` loop takes the steps, and in the end the plotter renders once more, for servers that send its
    pictures.
    """

    def __init__(
        self, plotter: pv.BasePlotter, step: Callable[[], bool], wanted: Callable[[], tuple[bool, int]]
    ) -> None:
        self._plotter = weakref.proxy(plotter)
        # says whether one is, and how many have been taken
        self._step, self._wanted = step, wanted  # draws a sample; says whether another one is wanted
        self.by_hand = False  # whether somebody else calls for the samples
        self._timer: int | None = None
        self._due = 0.0
        self._end: Callable[[], None] | None = None
        self._call: Any = None

    @property
    def seen(self) -> bool:
        """Whether every frame is seen by somebody: that of a window on a screen."""
        interactor = self._interactor()
        window = None if interactor is None else interactor.GetRenderWindow()
        return bool(window is not None and not window.GetOffScreenRendering() and interactor.GetInitialized())

    @property
    def paces(self) -> bool:
        """Whether an idle picture is refined by further frames."""
        interactor = self._interactor()
        return self.by_hand or self.seen or (interactor is not None and not interactor.GetEnableRender())

    def frame_drawn(self) -> None:
        """Ask to be called again; a frame has been drawn, by ourselves or by others."""
        interactor = self._interactor()
        if self.by_hand or interactor is None:
            return
        wanted, taken = self._wanted()
        if not wanted:
            return
        wait = PAUSE / 1000.0 if taken else REST
        if not interactor.GetEnableRender():
            self._ask_loop(wait)
        elif self.seen:
            self._ask_timer(interactor, wait)

    def _interactor(self) -> Any:
        return getattr(self._plotter.iren, "interactor", None)

    # Timers of a window

    def _ask_timer(self, interactor: vtkRenderWindowInteractor, wait: float) -> None:
        self._stop_timer(interactor)
        if self._end is None:
            self._end = observe(interactor, ("TimerEvent",), weakly(self._heard))
        self._due = time.monotonic() + wait
        # PyVista calls the callbacks of `add_timer_event` at every timer's event: wait for its own timers.
        theirs = getattr(self._plotter.iren, "_timer", None)
        if theirs is None or theirs.step + 1 >= theirs.max_steps:
            self._timer = interactor.CreateOneShotTimer(max(round(1000.0 * wait), 1))

    def _stop_timer(self, interactor: vtkRenderWindowInteractor) -> None:
        timer, self._timer = self._timer, None
        if timer is not None:  # of one shot or not: some toolkits repeat every timer until it is destroyed
            interactor.DestroyTimer(timer)

    def _heard(self) -> None:
        interactor = self._interactor()
        if interactor is None or not self._due or time.monotonic() < self._due - EARLY:
            return
        self._due = 0.0
        self._stop_timer(interactor)
        style = interactor.GetInteractorStyle()
        if style is not None and hasattr(style, "GetState") and style.GetState() != 0:
            return  # the mouse turns something: a frame will come of it
        self._step()

    # A server's loop

    def _ask_loop(self, wait: float) -> None:
        try:
            loop = asyncio.get_running_loop()
        except RuntimeError:
            return
        self._stop_call()
        self._call = loop.call_later(wait, weakly(self._called))

    def _stop_call(self) -> None:
        call, self._call = self._call, None
        if call is not None:
            call.cancel()

    def _called(self) -> None:
        self._call = None
        if self._wanted()[0] and not self._step():
            self._plotter.render()

    def release(self) -> None:
        """Ask for nothing any more; twice is harmless."""
        interactor = self._interactor()
        self._due = 0.0
        self._stop_call()
        if interactor is not None:
            self._stop_timer(interactor)
        if self._end is not None:
            self._end()
        self._end = None
