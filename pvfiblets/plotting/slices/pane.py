"""A pane of the workspace: one slice, straight from the front, with its cross-hair, letters and zoom of its own.

Its camera is parallel. The slice lies behind the slab that streamlines are cut to and the cross-hair before it, which
a parallel camera does not show.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pyvista as pv
from vtkmodules.vtkRenderingAnnotation import vtkCornerAnnotation

from pvfiblets.plotting.slices.following import before_render
from pvfiblets.plotting.slices.plane import SliceActor
from pvfiblets.slices.frames import PlaneGrid, covered, letters, plane_axes

if TYPE_CHECKING:

    from pvfiblets.plotting.slices.plane import SlicePlane
    from pvfiblets.plotting.slices.stack import SliceStack

Array = npt.NDArray[np.float64]

FILLED = 1.05  # height or width of the window per that of the images, to begin with
MOST_PIXELS = 4096
GAP = 6.0  # pixels of the cross-hair's middle that stay free
BACKING = 0.65  # opacity of the background of text
BEFORE = 1.0  # mm from the slab to the cross-hair and to the slice
FARTHEST = 1000.0  # mm from the slice to the camera

_LEFT, _RIGHT, _TOP, _BOTTOM, _SAID = 6, 5, 7, 4, 0  # places of a `vtkCornerAnnotation`


class Pane:
    """One slice in a renderer.

    Parameters
    ----------
    stack : SliceStack
        Images and position.
    orientation : str
        ``"axial"``, ``"coronal"`` or ``"sagittal"``.
    renderer : pyvista.Renderer
    color : color-like
        Of cross-hair and letters.
    plane : SlicePlane, optional
        Plane with the pane's directions, however it is turned, in place of an orientation.
    """

    def __init__(
        self, stack: SliceStack, orientation: str, renderer: pv.Renderer, color: Any, plane: SlicePlane | None = None
    ) -> None:
        self.stack, self.name, self.renderer, self.plane = stack, orientation, renderer, plane
        self.mirrored = False
        self.thickness = 3.0
        self._scale: float | None = None
        self._pan = np.zeros(2)
        self._drawn: tuple[Any, ...] | None = None
        self._version = 0
        self._contours: dict[str, tuple[pv.PolyData, pv.Actor]] = {}
        self.slice = SliceActor()
        self._lines = pv.PolyData(np.zeros((8, 3)), lines=np.array([[2, 0, 1], [2, 2, 3], [2, 4, 5], [2, 6, 7]]))
        self._cross = _unlit(self._lines, color, 1.0, CrossHair)
        self._words = vtkCornerAnnotation()
        self._words.SetMaximumFontSize(15)
        self._words.SetNonlinearFontScaleFactor(0.6)
        rgb = pv.Color(color).float_rgb
        words = self._words.GetTextProperty()
        words.SetColor(*rgb)
        words.SetBackgroundColor(*((0.0,) * 3 if sum(rgb) > 1.5 else (1.0,) * 3))  # lines run behind
        words.SetBackgroundOpacity(BACKING)
        for actor in (self.slice, self._cross):
            renderer.add_actor(actor, reset_camera=False, render=False, pickable=False)
        renderer.AddViewProp(self._words)
        renderer.enable_parallel_projection()
        self._end: Callable[[], None] = before_render(renderer, self.prepare)

    # Directions and camera ----------------------------------------------------------------------

    @property
    def axes(self) -> tuple[Array, Array]:
        """Unit directions to the right of the window and up, ``(3,)`` each."""
        along, up = plane_axes(self.stack.frame, self.name) if self.plane is None else self.plane.axes
        return (-along if self.mirrored else along), up

    @property
    def toward(self) -> Array:
        """Unit direction to the viewer."""
        right, up = self.axes
        return np.cross(right, up)

    @property
    def pixels(self) -> tuple[int, int]:
        """Width and height in pixels."""
        width, height = self.renderer.GetSize()
        return max(width, 1), max(height, 1)

    @property
    def scale(self) -> float:
        """Width of a pixel, mm."""
        return self._half / (0.5 * self.pixels[1])

    @property
    def zoom(self) -> float:
        """Magnification of the slice, compared with a pane that it fills."""
        return self._fitting / self._half

    @zoom.setter
    def zoom(self, zoom: float) -> None:
        if not (isinstance(zoom, (int, float, np.number)) and np.isfinite(zoom) and zoom > 0):
            raise ValueError(f"zoom is {zoom!r}; give a number above 0")
        self._scale = self._fitting / float(zoom)

    @property
    def _fitting(self) -> float:
        """Half the height, mm, of a window that all images fill."""
        right, up = self.axes
        bounds = covered((one.image.corners for one in self.stack.layers), self._middle, right, up)
        if bounds is None:
            return 1.0
        width, height = self.pixels
        return 0.5 * FILLED * max(bounds[3] - bounds[2], (bounds[1] - bounds[0]) * height / width)

    @property
    def _half(self) -> float:
        return self._fitting if self._scale is None else self._scale

    @property
    def _middle(self) -> Array:
        layers = self.stack.layers
        return layers[0].image.center if layers else np.zeros(3)

    @property
    def center(self) -> Array:
        """``(3,)`` mm: the point of the slice in the middle of the window."""
        right, up = self.axes
        away = self.stack.position - self._middle
        in_depth = self.toward * float(away @ self.toward)
        return self._middle + in_depth + self._pan[0] * right + self._pan[1] * up

    def pan_by(self, right: float, up: float) -> None:
        """Move the slice by pixels."""
        self._pan -= np.array([right, up]) * self.scale

    def reset(self) -> None:
        """Show the whole slice."""
        self._scale, self._pan = None, np.zeros(2)

    def position_at(self, x: float, y: float) -> Array:
        """Return the position, mm, of a pixel of the window on the slice."""
        left, bottom = self.renderer.GetOrigin()
        width, height = self.pixels
        right, up = self.axes
        across, above = x - left + 0.5 - 0.5 * width, y - bottom + 0.5 - 0.5 * height
        return self.center + self.scale * (across * right + above * up)

    def pixel_of(self, position: Array) -> tuple[float, float]:
        """Return the pixel of the window in which a position is shown."""
        left, bottom = self.renderer.GetOrigin()
        width, height = self.pixels
        right, up = self.axes
        away = (np.asarray(position, np.float64) - self.center) / self.scale
        return left + 0.5 * width - 0.5 + float(away @ right), bottom + 0.5 * height - 0.5 + float(away @ up)

    @property
    def _depth(self) -> float:
        """Distance of the slice and the cross-hair from the plane, mm: beyond the slab, and beyond glyphs of voxels."""
        voxel = max((float(one.image.voxel_size.max()) for one in self.stack.layers), default=0.0)
        return max(0.5 * self.thickness, voxel) + BEFORE

    @property
    def before(self) -> float:
        """Distance of the cross-hair before the plane, mm: no other thing occludes its lines."""
        return self._depth

    @property
    def planes(self) -> Array:
        """``(2, 4)`` a, b, c, d: faces of the slab of streamlines that are shown."""
        n, half = self.toward, 0.5 * self.thickness
        d = -float(n @ self.stack.position)
        return np.array([[*n, d + half], [*-n, -d + half]])

    def place(self) -> tuple[Array, Array]:
        """Return a point of the slice's plane and its normal."""
        return self.stack.position, self.toward

    # Picture ------------------------------------------------------------------------------------

    def changed(self) -> None:
        """Render the slice again with the next frame."""
        self._version += 1

    def prepare(self) -> None:
        """Update camera, slice, cross-hair and letters before the renderer draws."""
        right, up = self.axes
        toward, center, position, half = self.toward, self.center, self.stack.position, self._half
        away = self._depth
        camera = self.renderer.GetActiveCamera()
        camera.SetFocalPoint(*center)
        camera.SetPosition(*(center + FARTHEST * toward))
        camera.SetViewUp(*up)
        camera.SetParallelScale(half)
        camera.SetClippingRange(FARTHEST - away - BEFORE, FARTHEST + away + BEFORE)
        state = (self._version, self.pixels, half, *center, *position, *right, *up, self.thickness)
        if state == self._drawn:
            return
        self._drawn = state
        grid = self._grid()
        self.slice.visibility = grid is not None
        if grid is not None:
            self.slice.show(self.stack.pixels(grid), self.stack.smooth)
            back = -away * toward
            self.slice.place(PlaneGrid(grid.corner + back, grid.along, grid.up, grid.shape))
        self._draw_cross(position + away * toward, right, up)
        self._draw_letters(right, up)

    def _grid(self) -> PlaneGrid | None:
        """Return the pixels of the window that show images; None if there are none."""
        right, up = self.axes
        center, scale = self.center, self.scale
        layers = [one for one in self.stack.layers if one.visible]
        bounds = covered((one.image.corners for one in layers), center, right, up)
        if bounds is None:
            return None
        half = 0.5 * np.array(self.pixels)
        ends = np.array([bounds[:2], bounds[2:]]).T / scale + half  # in pixels of the pane
        first = np.floor(np.maximum(ends[0], 0.0)).astype(int)
        last = np.ceil(np.minimum(ends[1], 2.0 * half)).astype(int)
        n = last - first
        if (n < 1).any() or (n > MOST_PIXELS).any():
            return None
        corner = center + scale * ((first[0] - half[0]) * right + (first[1] - half[1]) * up)
        return PlaneGrid(corner, scale * right, scale * up, (int(n[0]), int(n[1])))

    def _draw_cross(self, position: Array, right: Array, up: Array) -> None:
        gap, far = GAP * self.scale, 4.0 * max(self.pixels) * self.scale + float(abs(self._pan).sum())
        self._lines.points = np.array(
            [position + sign * length * one for one in (right, up) for sign in (-1.0, 1.0) for length in (gap, far)]
        )

    def _draw_letters(self, right: Array, up: Array) -> None:
        for place, direction in ((_LEFT, -right), (_RIGHT, right), (_TOP, up), (_BOTTOM, -up)):
            self._words.SetText(place, letters(direction))

    def say(self, text: str) -> None:
        """Write a text into the lower left corner."""
        self._words.SetText(_SAID, text)

    @property
    def sides(self) -> Mapping[str, str]:
        """Letters of the directions by side: ``"left"``, ``"right"``, ``"top"``, ``"bottom"``."""
        right, up = self.axes
        sides = {"left": -right, "right": right, "top": up, "bottom": -up}
        return {side: letters(direction) for side, direction in sides.items()}

    @property
    def cross_hair(self) -> bool:
        """Whether the cross-hair is shown."""
        return bool(self._cross.visibility)

    @cross_hair.setter
    def cross_hair(self, shown: bool) -> None:
        self._cross.visibility = bool(shown)

    def set_contour(self, name: str, contour: pv.PolyData | None, color: Any = None, width: float = 2.0) -> None:
        """Show lines in the slice's plane, or none."""
        if contour is None:
            old = self._contours.pop(name, None)
            if old is not None:
                self.renderer.remove_actor(old[1], reset_camera=False, render=False)
            return
        if name not in self._contours:
            mesh = pv.PolyData()
            actor = _unlit(mesh, color, width)
            self.renderer.add_actor(actor, reset_camera=False, render=False, pickable=False)
            self._contours[name] = mesh, actor
        mesh, _ = self._contours[name]
        mesh.copy_from(contour.translate(self.toward * (self._depth - 0.5 * BEFORE), inplace=False))

    def remove(self) -> None:
        """Remove the contents of the pane."""
        self._end()
        for name in tuple(self._contours):
            self.set_contour(name, None)
        for actor in (self.slice, self._cross):
            self.renderer.remove_actor(actor, reset_camera=False, render=False)
        self.renderer.RemoveViewProp(self._words)


class CrossHair(pv.Actor):
    """Lines along rows and columns of pixels."""

    along_pixels = True  # which needs no multisampling (`pvfiblets.mappers.picture.antialias_coverage`)


def _unlit(mesh: pv.PolyData, color: Any, width: float, kind: type[pv.Actor] = pv.Actor) -> pv.Actor:
    mapper = pv.DataSetMapper(mesh)
    mapper.SetScalarVisibility(False)
    actor = kind(mapper=mapper)
    actor.prop.lighting = False
    actor.prop.color = color
    actor.prop.line_width = width
    return actor
