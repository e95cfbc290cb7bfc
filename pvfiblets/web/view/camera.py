"""Actions of the bar's buttons on the camera, and the overlay at the picture's edges."""

from __future__ import annotations

from typing import Any

import numpy as np

from pvfiblets.support import memory
from pvfiblets.web.actions import Actions
from pvfiblets.web.panels.charts import short
from pvfiblets.web.panels.describe import typed, typed_or_none
from pvfiblets.web.scene.cameras import LARGEST_PICTURE
from pvfiblets.web.values import whole

LONGEST = 32_768  # pixels of a side


class CameraActions(Actions):
    """The camera of an application."""

    def refresh(self) -> None:
        """Show how the camera stands."""
        page, scene = self._app.page, self._app.scene
        page.parallel = scene.cameras.parallel
        page.edges = scene.cameras.edges() if scene.layers else {}

    def view(self, name: str) -> None:
        """Look from a named side."""
        self._app.scene.cameras.view(name)
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
        self._app.scene.cameras.reset()
        self._app.scene.slicing.show_all()
        self._app.stream.request()

    def toggle_parallel(self) -> None:
        """Change between parallel and perspective projection."""
        self._app.scene.cameras.parallel = not self._app.scene.cameras.parallel
        self._app.stream.request()

    def set_background(self, colour: str) -> None:
        """Set the colour behind everything."""
        self._app.scene.set_background(colour)

    def picture(self) -> bytes:
        """Return the picture as PNG."""
        return self._app.stream.picture()

    def ask_picture(self, times: int = 1) -> None:
        """Open the dialog for a picture of another size, so many times the view's."""
        width, height = self._app.stream.settle()
        factor = whole(times, "times", 1, 8)
        self._app.page.picture = {"width": factor * width, "height": factor * height}
        self._app.page.dialog = "picture"

    def save_picture(self, width: Any, height: Any, dpi: Any, transparent: Any) -> str:
        """Draw the picture at another size, and return where it can be fetched."""
        from PIL import Image

        app = self._app
        size = [whole(typed(text, name), name, 16, LONGEST)
                for text, name in ((width, "width"), (height, "height"))]  # fmt: skip
        if size[0] * size[1] > LARGEST_PICTURE:
            raise ValueError(
                f"a picture of {size[0]} x {size[1]} is too large; give {LARGEST_PICTURE:,} pixels at most"
            )
        dots = typed_or_none(dpi, "dpi")
        if dots is not None and not 1.0 <= dots <= 10_000.0:
            raise ValueError(f"dpi is {short(dots)}; give 1 to 10,000 pixels per inch, or nothing")
        taken = memory.within(lambda: app.stream.picture_of(*size, transparent=transparent is True))
        said = {} if dots is None else {"dpi": (dots, dots)}
        with app.exports.fresh("picture.png") as (place, offer):
            Image.fromarray(taken).save(place, "png", **said)
            return str(offer())
