"""A PyVista window as the studies draw in it: off the screen, each frame waited for."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .cameras import Camera
from .timing import Turns, clock_of


class Window:
    """A window to add to, then to :meth:`show`.

    ``multisampled`` leaves VTK's own anti-aliasing on; ``headlight`` replaces PyVista's lights by one at the eye.
    """

    def __init__(
        self, size: Sequence[int], background: str = "black", *, multisampled: bool = False, headlight: bool = False
    ) -> None:
        if sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
            os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
        import pyvista as pv

        lighting = {"lighting": "none"} if headlight else {}
        self.plotter: Any = pv.Plotter(off_screen=True, window_size=list(size), **lighting)
        if headlight:
            self.plotter.add_light(pv.Light(light_type="headlight"))
        if not multisampled:
            self.plotter.disable_anti_aliasing()
        self.plotter.picture.antialias = "off"
        self.plotter.set_background(background)

    def show(self) -> None:
        """Open the window, and find the clock that measures its frames."""
        from pvfiblets.mappers.frames.windows import borrowed_context

        self.plotter.show(auto_close=False)
        with borrowed_context(self.plotter.render_window) as ctx:
            self.driver = f"{ctx.info['GL_RENDERER']}, {ctx.info['GL_VERSION']}"
            self.clock, self.clock_name = clock_of(ctx)

    @property
    def turns(self) -> Turns:
        """Calls that take turns, timed by the window's clock."""
        return Turns(self.clock, self.clock_name)

    def render(self) -> None:
        """Draw a frame and wait for it."""
        self.plotter.render()
        self.wait()

    def wait(self) -> None:
        """Wait until the frame is there: reading one pixel needs all of it."""
        self.plotter.render_window.WaitForCompletion()
        self.plotter.render_window.GetPixelData(0, 0, 0, 0, 0, 0)

    def draw(self, camera: Camera) -> None:
        """Draw what a camera sees."""
        camera.aim(self.plotter)
        self.render()

    def colours(self) -> npt.NDArray[np.float64]:
        """Return the frame, ``(height, width, 3)`` from 0 to 1, row 0 at the bottom."""
        return np.asarray(self.plotter.screenshot(None))[::-1, :, :3] / 255.0

    def depths(self) -> npt.NDArray[np.float32]:
        """Return the frame's window depths, ``(height, width)``, row 0 at the bottom; 1 where nothing is drawn."""
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonCore import vtkFloatArray

        width, height = self.plotter.render_window.GetSize()
        depth = vtkFloatArray()
        self.plotter.render_window.GetZbufferData(0, 0, width - 1, height - 1, depth)
        found: npt.NDArray[np.float32] = vtk_to_numpy(depth).reshape(height, width)
        return found

    def release(self) -> None:
        """Close the window."""
        self.plotter.close()
