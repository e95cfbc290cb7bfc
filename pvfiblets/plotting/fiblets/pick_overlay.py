"""The overlay of picking: the outline of an area, and the text beside the mouse."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor2D, vtkPolyDataMapper2D, vtkTextActor

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

_BESIDE = (14, 10)  # pixels from the mouse to its text


def standing_out(background: Any) -> str:
    """Return black or white, whichever can be seen on a colour (luma of ITU-R BT.601)."""
    red, green, blue = pv.Color(background).float_rgb
    return "black" if 0.299 * red + 0.587 * green + 0.114 * blue > 0.5 else "white"


class Outline:
    """A closed line over one renderer."""

    def __init__(self, renderer: vtkRenderer, color: Any) -> None:
        self._renderer = renderer  # drawn over
        self._mapper = vtkPolyDataMapper2D()
        self._actor = vtkActor2D()
        self._actor.SetMapper(self._mapper)
        self._actor.SetPickable(False)
        self._actor.GetProperty().SetColor(pv.Color(color).float_rgb)
        self._actor.GetProperty().SetLineWidth(1.5)
        renderer.AddViewProp(self._actor)

    def show(self, corners: np.ndarray) -> None:
        """Draw around ``(k, 2)`` corners in window pixels."""
        points = np.zeros((len(corners), 3))
        points[:, :2] = corners - np.array(self._renderer.GetOrigin())
        order = np.append(np.arange(len(points)), 0)
        self._mapper.SetInputData(pv.PolyData(points, lines=np.append(len(order), order)))

    def remove(self) -> None:
        """Be gone; twice is harmless."""
        self._renderer.RemoveViewProp(self._actor)


class Tooltip:
    """A text beside the mouse."""

    def __init__(self) -> None:
        self._renderer: Any = None
        self._text = vtkTextActor()
        self._text.SetPickable(False)
        looks = self._text.GetTextProperty()
        looks.SetFontSize(13)
        looks.SetColor(pv.Color("white").float_rgb)
        looks.SetBackgroundColor(pv.Color("black").float_rgb)
        looks.SetBackgroundOpacity(0.7)

    @property
    def shown(self) -> str:
        """The text; empty while there is none."""
        return str(self._text.GetInput()) if self._renderer is not None else ""

    def show(self, renderer: vtkRenderer, text: str, pixel: tuple[int, int]) -> bool:
        """Show a text, or none if it is empty; returns whether the picture has changed."""
        if not text:
            return self.remove()
        if renderer is not self._renderer:
            self.remove()
            renderer.AddViewProp(self._text)
            self._renderer = renderer
        place = [pixel[axis] - renderer.GetOrigin()[axis] + _BESIDE[axis] for axis in (0, 1)]
        looks = self._text.GetTextProperty()
        # To the other side where the picture would cut it off.
        width, height = renderer.GetSize()
        if place[0] > 0.7 * width:
            place[0] -= 2 * _BESIDE[0]
        if place[1] > 0.8 * height:
            place[1] -= 2 * _BESIDE[1]
        looks.SetJustification(2 if place[0] + 2 * _BESIDE[0] > 0.7 * width + _BESIDE[0] else 0)
        looks.SetVerticalJustification(2 if place[1] + 2 * _BESIDE[1] > 0.8 * height + _BESIDE[1] else 0)
        self._text.SetInput(text)
        self._text.SetPosition(*place)
        return True

    def remove(self) -> bool:
        """Be gone; returns whether it was there."""
        if self._renderer is None:
            return False
        self._renderer.RemoveViewProp(self._text)
        self._renderer = None
        return True
