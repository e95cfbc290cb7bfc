"""The next frame of a window, drawn before it and piece by piece.

VTK draws a frame in one call, without events in between. Most of its time goes into the G-buffers of fiblets where
OpenGL runs on the CPU. So code that may have to abort a frame has them drawn beforehand by `draw_in_pieces`: the frame
finds them drawn if nothing has changed since, and shows the same in any case.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING

from pvfiblets.mappers.fiblets import FibletMapper
from pvfiblets.mappers.frames.idle_windows import picture_of
from pvfiblets.mappers.frames.scene import actors_in, items_of

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow


def draw_in_pieces(window: vtkRenderWindow, *, refining: bool = False) -> Iterator[None]:
    """Draw the fiblets of a window's next frame, and yield after each piece."""
    # Scenes that cannot be drawn in pieces, as on a GPU, are skipped, and so are frames that are not ordinary: an
    # enlarged one, or one with a render pass.
    if tuple(window.GetTileScale()) != (1, 1) or window.GetStereoRender():
        return
    drawn: set[str] = set()
    for renderer in items_of(window.GetRenderers()):
        if not renderer.GetDraw() or renderer.GetPass() is not None:
            continue
        picture = picture_of(renderer) if refining else None
        camera, refinement = None, None
        if refining:
            if picture is not None and picture.unfinished and not picture.draws_at_once():
                refinement = picture.refinement
            camera = None if refinement is None else refinement.sample_camera(renderer)
            if camera is None:
                continue
        for mapper in _mappers(renderer):
            if refining and mapper.GetAddressAsString("") in drawn:  # its engine holds one sample
                continue
            drawn.add(mapper.GetAddressAsString(""))
            began = time.perf_counter()
            for _ in mapper.draw_in_pieces(renderer, camera):
                if refinement is not None:
                    refinement.spend(time.perf_counter() - began)
                yield
                began = time.perf_counter()


def _mappers(renderer: vtkRenderer) -> Iterator[FibletMapper]:
    """Yield the visible ones of a renderer."""
    for prop in items_of(renderer.GetViewProps()):
        for actor in actors_in(prop) if prop.GetVisibility() else ():
            mapper = actor.GetMapper()
            if actor.GetVisibility() and isinstance(mapper, FibletMapper):
                yield mapper
