"""One slice in a renderer: a rectangle with a texture that is made anew when it is out of date."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pyvista as pv
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkWeakReference
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import vtkTexture

if TYPE_CHECKING:
    from pvfiblets.slices.frames import PlaneGrid

__all__ = ["SliceActor", "before_render"]

_DISCARD = "//VTK::TCoord::Impl\n  if (gl_FragData[0].a <= 0.002) { discard; }\n"


class SliceActor(pv.Actor):
    """A rectangle that shows colours of a plane, unlit; nothing is drawn, nor hides anything, where they are clear."""

    def __init__(self) -> None:
        self._quad = pv.PolyData(np.zeros((4, 3)), faces=[4, 0, 1, 2, 3])
        self._quad.active_texture_coordinates = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)
        mapper = pv.DataSetMapper(self._quad)
        mapper.SetScalarVisibility(False)
        super().__init__(mapper=mapper)
        self._image = vtkImageData()
        texture = vtkTexture()
        texture.SetInputData(self._image)
        texture.EdgeClampOn()
        texture.RepeatOff()
        texture.SetColorModeToDirectScalars()
        self.SetTexture(texture)
        self._pixels: npt.NDArray[np.uint8] | None = None
        self.prop.lighting = False
        self.prop.color = "white"
        self.GetShaderProperty().AddFragmentShaderReplacement("//VTK::TCoord::Impl", True, _DISCARD, False)

    def place(self, grid: PlaneGrid) -> None:
        """Lie where a plane's pixels are."""
        along, up = grid.along * grid.shape[0], grid.up * grid.shape[1]
        corners = grid.corner + np.array([0.0 * along, along, along + up, up])
        self._quad.points = corners
        self._quad.Modified()

    def show(self, pixels: npt.NDArray[np.uint8], smooth: bool = True) -> None:
        """Show colours.

        Parameters
        ----------
        pixels : numpy.ndarray
            ``(height, width, 4)`` uint8, the lowest row first.
        smooth : bool
            Whether colours between the centres of pixels are interpolated.
        """
        height, width = pixels.shape[:2]
        self._pixels = np.ascontiguousarray(pixels)
        image = self._image
        image.SetDimensions(width, height, 1)
        image.GetPointData().SetScalars(numpy_to_vtk(self._pixels.reshape(-1, 4)))
        image.Modified()
        texture = self.GetTexture()
        texture.SetInterpolate(smooth)
        texture.Modified()
        alpha = pixels[..., 3]
        clear = bool(((alpha > 0) & (alpha < 255)).any())
        self.SetForceOpaque(not clear)
        self.SetForceTranslucent(clear)

    @property
    def pixels(self) -> npt.NDArray[np.uint8] | None:
        """``(height, width, 4)`` uint8: the colours that it shows, the lowest row first; None before the first."""
        return None if self._pixels is None else self._pixels.copy()


def before_render(renderer: Any, owner: Any, method: str) -> Any:
    """Call an owner's method whenever a renderer begins to draw; neither keeps the other alive.

    Returns
    -------
    callable
        Ends it; twice is harmless.
    """
    reference = weakref.ref(owner)

    def started(*_: Any) -> None:
        alive = reference()
        if alive is not None:
            getattr(alive, method)()

    tags = [renderer.AddObserver("StartEvent", started)]
    kept = vtkWeakReference()
    kept.Set(renderer)

    def end() -> None:
        there = kept.Get()
        while tags:
            tag = tags.pop()
            if there is not None:
                there.RemoveObserver(tag)

    return end
