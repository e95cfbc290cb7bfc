"""One slice in a renderer: a rectangle with a texture that is made anew when it is out of date."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pyvista as pv
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import vtkTexture

from pvfiblets.plotting.slices.following import before_render
from pvfiblets.slices.frames import checked_position, covered, grid_of, plane_axes, turned

if TYPE_CHECKING:
    from collections.abc import Callable

    from vtkmodules.vtkRenderingCore import vtkRenderer

    from pvfiblets.plotting.slices.stack import SliceStack
    from pvfiblets.slices.frames import PlaneGrid

Array = npt.NDArray[np.float64]

OVERSAMPLED = 2  # pixels of a slice in the 3-D view along the finest voxel of all layers
MOST_ACROSS = 768  # pixels along a side of a slice in the 3-D view, whatever its voxels are

_CLEAR = "//VTK::TCoord::Impl\n  if (gl_FragData[0].a <= 0.002) { discard; }\n"
# Pixels are clear or opaque. Blended, the edge between them would let the background through: it is cut at one half.
_CUT = """//VTK::TCoord::Impl
  if (gl_FragData[0].a < 0.5) { discard; }
  gl_FragData[0] = vec4(gl_FragData[0].rgb / gl_FragData[0].a, 1.0);
"""


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
        self.shows = 0  # number of images set so far
        self.prop.lighting = False
        self.prop.color = "white"
        self._code = ""

    def place(self, grid: PlaneGrid) -> None:
        """Lie where a plane's pixels are."""
        along, up = grid.along * grid.shape[0], grid.up * grid.shape[1]
        corners = grid.corner + np.array([0.0 * along, along, along + up, up])
        self._quad.points = corners
        self._quad.Modified()

    def show(self, pixels: npt.NDArray[np.uint8], smooth: bool = True) -> None:
        """Show colours."""
        height, width = pixels.shape[:2]
        self._pixels = np.ascontiguousarray(pixels)
        self.shows += 1
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
        code = _CLEAR if clear else _CUT
        if code != self._code:
            self._code = code
            self.GetShaderProperty().AddFragmentShaderReplacement("//VTK::TCoord::Impl", True, code, False)

    @property
    def pixels(self) -> npt.NDArray[np.uint8] | None:
        """``(height, width, 4)`` uint8: the colours that it shows, the lowest row first; None before the first."""
        return None if self._pixels is None else self._pixels.copy()


class SlicePlane:
    """One of the planes of a stack.

    Attributes
    ----------
    name : str
    actor : SliceActor
    """

    def __init__(self, stack: SliceStack, name: str, axes: tuple[Array, Array] | None = None) -> None:
        self._stack = weakref.proxy(stack)
        self._base, self._axes = axes, axes
        self._grid: PlaneGrid | None = None
        self._stale = True
        self._visible = True
        self.name = name
        self.renderer: Any = None
        self._origin: Array | None = None
        self.actor = SliceActor()
        self._end: Callable[[], None] = lambda: None

    @property
    def axes(self) -> tuple[Array, Array]:
        """Unit directions along and up the slice, ``(3,)`` each."""
        return plane_axes(self._stack.frame, self.name) if self._axes is None else self._axes

    @property
    def normal(self) -> Array:
        """Unit direction across the slice; setting it turns the plane about the stack's position."""
        along, up = self.axes
        return np.cross(along, up)

    @normal.setter
    def normal(self, normal: Any) -> None:
        # From the same axes each time: how the slice lies in its plane depends on the normal alone.
        self._axes = turned(plane_axes(self._stack.frame, self.name) if self._base is None else self._base, normal)
        self.update()

    @property
    def origin(self) -> Array:
        """``(3,)`` mm: a point of the plane; the stack's position, unless it is set."""
        return self._stack.position if self._origin is None else self._origin.copy()

    @origin.setter
    def origin(self, origin: Any) -> None:
        self._origin = None if origin is None else checked_position("origin", origin)
        self.update()

    def place(self) -> tuple[Array, Array] | None:
        """Return a point of the plane and its normal; None where it is not shown."""
        return (self.origin, self.normal) if self._visible and self._grid is not None else None

    @property
    def visible(self) -> bool:
        """Whether it is shown."""
        return self._visible

    @visible.setter
    def visible(self, visible: bool) -> None:
        self._visible = bool(visible)
        self.update()

    @property
    def corners(self) -> Array:
        """``(8, 3)`` mm: corners of the lowest image."""
        corners: Array = self._stack.layers[0].image.corners
        return corners

    @property
    def grid(self) -> PlaneGrid | None:
        """Pixels of the slice; None where the plane misses all images."""
        return self._grid

    def update(self) -> None:
        """Move to the stack's position; the next render updates the colours."""
        stack, (along, up) = self._stack, self.axes
        layers = [layer for layer in stack.layers if layer.visible]
        origin = self.origin
        bounds = covered((layer.image.corners for layer in layers), origin, along, up)
        self._grid = None
        if bounds is not None:
            pixel = min(float(layer.image.voxel_size.min()) for layer in layers) / OVERSAMPLED
            pixel = max(pixel, float(max(bounds[1] - bounds[0], bounds[3] - bounds[2])) / MOST_ACROSS)
            self._grid = grid_of(bounds, origin, along, up, pixel)
            self.actor.place(self._grid)
        self.actor.visibility = self._visible and self._grid is not None
        self._stale = True

    def refresh(self) -> None:
        """Update the colours if they are out of date and the plane is visible."""
        if self._stale and self._grid is not None and self._visible:
            self.actor.show(self._stack.pixels(self._grid, in_3d=True), self._stack.smooth)
            self._stale = False

    def enter(self, renderer: vtkRenderer) -> None:
        """Follow a renderer's frames."""
        self.renderer = renderer
        self._end = before_render(renderer, self.refresh)

    def leave(self) -> None:
        """Follow them no more."""
        self._end()
