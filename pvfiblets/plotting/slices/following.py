"""What follows the frames of a renderer."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.mappers.frames.scene import partly_shown

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

_PREPARE = "UserEvent"


def before_render(renderer: vtkRenderer, method: Callable[[], object]) -> Callable[[], None]:
    """Call a method whenever a renderer begins to draw; return what ends that."""
    update = weakly(method)

    # `prepare` does it, too, for renderers that may have nothing to draw.
    def begun(_renderer: Any, event: str) -> None:
        if event == _PREPARE or not partly_shown:
            update()

    return observe(renderer, ("StartEvent", _PREPARE), begun)


def prepare(renderer: vtkRenderer) -> None:
    """Update everything that waits for :func:`before_render`, though the renderer does not draw yet."""
    renderer.InvokeEvent(_PREPARE)
