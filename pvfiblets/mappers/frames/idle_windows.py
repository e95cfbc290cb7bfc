"""Windows whose pictures at rest want more frames, for samples or for parts of their sets: one frame more, or all."""

from __future__ import annotations

import signal
import sys
import threading
import time
import warnings
import weakref
from contextlib import ExitStack, nullcontext
from typing import TYPE_CHECKING, Any, Self

from pvfiblets.mappers.frames.scene import keep_views
from pvfiblets.mappers.frames.scene_state import without_multisamples
from pvfiblets.support.progress_bar import progress_bar

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

__all__ = ["Finishing", "finish", "picture_of", "refine", "shown_pictures"]

PATIENCE = 1.0
"""Seconds after which it is shown how far pictures are."""

shown_pictures: weakref.WeakSet[Any] = weakref.WeakSet()
"""All `pvfiblets.mappers.picture.picture.Picture` that there are."""


def refine(window: vtkRenderWindow, *, cheaply: bool = False) -> bool:
    """Draw one more frame of the pictures of a window that want more samples or parts, or what it takes.

    Nothing if none does; return whether another one is wanted. `cheaply` leaves VTK's multisampling out where it
    changes nothing.
    """
    wanting = _unfinished(window)
    if any(picture.draw_part() for picture in wanting):
        return True
    singly = [picture for picture in wanting if picture.samples_others]
    # Somebody may wait for the window: it draws one view, where it draws no others along.
    some = 1 if window.GetAddressAsString("") in keep_views and not cheaply else None
    for picture in (singly or wanting)[:some]:
        picture.refinement.due = True  # also where parts are wanted: views that stay as they were are not drawn
        picture.hurries = cheaply
    if wanting:
        multisampled = not (singly or (cheaply and not any(picture.needs_multisamples for picture in wanting)))
        with nullcontext() if multisampled else without_multisamples(window):
            window.Render()
    return bool(_unfinished(window))


def finish(window: vtkRenderWindow) -> None:
    """Draw all frames that the pictures of a window want."""
    wanting = _unfinished(window)
    total = sum(picture.refinement.samples for picture in wanting)
    with Finishing(total) as finishing:
        while refine(window, cheaply=True) and finishing.reach(sum(picture.progress for picture in wanting)):
            pass
        few = [picture for picture in wanting if finishing.stopped and picture.refinement.few]
        for picture in few:
            picture.refinement.forget()
        if few:
            window.Render()


class Finishing:
    """Shows in a terminal or a notebook how many samples there are, and ends at Ctrl-C.

    VTK ends the program where a `KeyboardInterrupt` leaves what it calls: the first Ctrl-C only keeps `reach` from
    being true any more, a second one interrupts as usual.
    """

    def __init__(self, total: int) -> None:
        self._total = total
        self._done = self._shown = 0
        self._bar: Any = None
        self._held = ExitStack()
        self._begun = time.monotonic()
        self.stopped = False

    def __enter__(self) -> Self:
        main = threading.current_thread() is threading.main_thread()
        if main and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, self._stop)
            self._held.callback(signal.signal, signal.SIGINT, signal.default_int_handler)
        return self

    def _stop(self, *_: Any) -> None:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        self.stopped = True

    def reach(self, done: int) -> bool:
        """Show how many samples there are; return whether to go on."""
        if self._bar is None and time.monotonic() - self._begun >= PATIENCE:
            watched = sys.stderr.isatty() or "ipykernel" in sys.modules
            bar = progress_bar(watched, total=self._total, desc="smoothing", unit=" samples", leave=False)
            self._bar = self._held.enter_context(bar)
        if self._bar is not None:
            self._bar.update(done - self._shown)
            self._shown = done
        self._done = done
        return not self.stopped

    def __exit__(self, *_: object) -> None:
        self._held.close()
        if self.stopped:
            warnings.warn(f"stopped after {self._done} of {self._total} samples", RuntimeWarning, stacklevel=2)


def _unfinished(window: vtkRenderWindow) -> list[Any]:
    address = window.GetAddressAsString("")
    found = [picture for picture in shown_pictures if picture.unfinished]
    return [picture for picture in found if picture.renderer.GetRenderWindow().GetAddressAsString("") == address]


def picture_of(renderer: vtkRenderer) -> Any:
    """Return what is done to a renderer's picture; None if nothing is."""
    address = renderer.GetAddressAsString("")
    of = [(picture, picture.renderer) for picture in shown_pictures]
    return next((one for one, its in of if its is not None and its.GetAddressAsString("") == address), None)
