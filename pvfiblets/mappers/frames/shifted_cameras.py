"""Cameras whose window is shifted for a moment: by a part of a pixel for a sample, by many to look beside a tile.

A user does not point at these frames: a mapper does not remember them as its last picture, and code that reads
the depths of a window asks for them by `with_exact_depths`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkCamera, vtkRenderer, vtkRenderWindow

_cameras: set[str] = set()
_renderers: set[str] = set()
_exact: set[str] = set()
_samples: set[str] = set()


def shift(camera: vtkCamera, size: tuple[int, int], by: tuple[float, float]) -> Callable[[], None]:
    """Shift a camera's window by some pixels."""
    kept, address = camera.GetWindowCenter(), camera.GetAddressAsString("")
    first = address not in _cameras
    _set_centre(camera, size, by)
    if any(by):
        _cameras.add(address)
    left = [kept]

    def back() -> None:
        if left:
            camera.SetWindowCenter(*left.pop())
            if first:
                _cameras.discard(address)

    return back


def shifted_copy(camera: vtkCamera, size: tuple[int, int], by: tuple[float, float]) -> vtkCamera:
    """Return a camera that shows what another one would if it were shifted: see `shift`."""
    copy = camera.NewInstance()
    copy.DeepCopy(camera)
    _set_centre(copy, size, by)
    return copy


def _set_centre(camera: vtkCamera, size: tuple[int, int], by: tuple[float, float]) -> None:
    kept = camera.GetWindowCenter()
    camera.SetWindowCenter(*(at + 2.0 * part / side for at, part, side in zip(kept, by, size, strict=True)))


@contextmanager
def shifted(camera: vtkCamera, size: tuple[int, int], by: tuple[float, float]) -> Iterator[None]:
    """Do something with a camera that is shifted: see `shift`."""
    back = shift(camera, size, by)
    try:
        yield
    finally:
        back()


def is_shifted(camera: vtkCamera) -> bool:
    """Return whether a camera is shifted now."""
    return camera.GetAddressAsString("") in _cameras


def note_sample(renderer: vtkRenderer, *, begun: bool) -> None:
    """Note that a renderer begins a frame that is one of many of the same picture, or that the frame has ended."""
    (_samples.add if begun else _samples.discard)(renderer.GetAddressAsString(""))


def draws_sample(renderer: vtkRenderer) -> bool:
    """Return whether a renderer draws such a frame: what all of them are to share was found out in the one before."""
    return renderer.GetAddressAsString("") in _samples


def note_depths(renderer: vtkRenderer, *, exact: bool) -> None:
    """Note whether a renderer's depths belong to its unshifted camera."""
    (_renderers.discard if exact else _renderers.add)(renderer.GetAddressAsString(""))


def with_exact_depths(window: vtkRenderWindow) -> vtkRenderWindow:
    """Return a window with the depths of unshifted cameras, redrawn if necessary."""
    found = window.GetRenderers()
    shown = {found.GetItemAsObject(index).GetAddressAsString("") for index in range(found.GetNumberOfItems())}
    if shown & _renderers:
        _exact.update(shown)
        try:
            window.Render()
        finally:
            _exact.difference_update(shown)
    return window


def exact_wanted(renderer: vtkRenderer) -> bool:
    """Return True if a renderer must provide the depths of its unshifted camera."""
    return renderer.GetAddressAsString("") in _exact
