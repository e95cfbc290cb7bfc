"""What the bar's buttons do to the camera, and what goes with it at the picture's edges."""

from __future__ import annotations

import numpy as np

from pvfiblets.web.actions import Actions


class CameraActions(Actions):
    """The camera of an application."""

    def refresh(self) -> None:
        """Show how the camera stands."""
        page, scene = self._app.page, self._app.scene
        page.parallel = scene.parallel
        page.edges = scene.edges() if scene.layers else {}

    def view(self, name: str) -> None:
        """Look from a named side."""
        self._app.scene.view(name)
        self._app.stream.request()

    def flip(self) -> None:
        """Look from the other side."""
        camera = self._app.plotter.camera
        focus, place = np.array(camera.focal_point), np.array(camera.position)
        camera.position = tuple(2.0 * focus - place)
        self._app.plotter.renderer.reset_camera_clipping_range()
        self._app.stream.request()

    def reset(self) -> None:
        """Show everything."""
        self._app.scene.reset()
        self._app.stream.request()

    def toggle_parallel(self) -> None:
        """Change between parallel and perspective projection."""
        self._app.scene.parallel = not self._app.scene.parallel
        self._app.stream.request()

    def set_background(self, colour: str) -> None:
        """Set the colour behind everything."""
        self._app.scene.set_background(colour)

    def picture(self) -> bytes:
        """Return the picture as PNG."""
        return self._app.stream.picture()
