"""Time limits of frames for engines that fetch parts of their sets, and which of them want another one.

An engine of a set larger than GPU memory (`pvfiblets.engine.fiblets.parts.streamed_renderer`) draws a complete picture
if no other frame is waiting. In a window that draws more frames while idle (`Picture.paced`) each frame
takes `PATIENCE` at most, and the next goes on; while the camera moves, nothing is fetched.
"""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from pvfiblets.mappers.frames.idle_windows import picture_of
from pvfiblets.mappers.frames.scene import in_motion, streamed
from pvfiblets.mappers.frames.shifted_cameras import draws_sample

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

PATIENCE = 0.25  # seconds of a frame in which parts are fetched: events of mouse and keys are heard as often


def pace(engine: Any, renderer: vtkRenderer) -> None:
    """Set the time limit of an engine of parts before it draws."""
    picture = picture_of(renderer)
    engine.hurried = in_motion(renderer)
    paced = picture is not None and picture.refinement is not None and picture.paced() and not draws_sample(renderer)
    engine.patience = PATIENCE if paced else None
    streamed.setdefault(renderer.GetAddressAsString(""), weakref.WeakSet()).add(engine)
