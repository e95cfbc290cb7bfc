"""The renderer that is drawing, its camera (VTK's matrices in float64), and the size of its pixels."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any
from weakref import WeakSet

import numpy as np
import numpy.typing as npt
from vtkmodules.vtkCommonCore import vtkWeakReference
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkRenderingCore import vtkActor, vtkAssembly, vtkProp, vtkPropAssembly, vtkRenderer

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkCamera, vtkRenderWindow

Matrix = npt.NDArray[np.float64]

smoothers: dict[str, Any] = {}
"""What smooths the edges of lines (`pvfiblets.mappers.picture.antialias_coverage`), by its vtkRenderer's address."""

lenses: dict[str, dict[str, Any]] = {}
"""What hides nothing in a picture with depth of field (`pvfiblets.engine.effects.picture.SeenThrough`), by the address
of its vtkRenderer, then by that of the mapper."""

streamed: dict[str, WeakSet[Any]] = {}
"""Engines that have parts of their sets at a time (`pvfiblets.mappers.frames.streaming`), by the address of their
vtkRenderer."""

partly_shown: set[str] = set()
"""Addresses of vtkRenderers that draw some of their props alone, and have no others meanwhile: whatever follows what a
renderer shows waits until all are there again."""

keep_views: set[str] = set()
"""Addresses of windows that draw changed views alone (`pvfiblets.mappers.frames.kept_views`)."""

USUAL_DPI = 72  # default dots per inch of a vtkRenderWindow

# 1 - window depth = w stands in the third place: NDC depth is 2 * depth - 1 = 1 - 2 * w.
_FROM_COMPLEMENT = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -2.0, 1.0], [0.0, 0.0, 0.0, 1.0]])


@dataclass(frozen=True, eq=False)
class Frame:
    """One draw of one actor: viewport and matrices, all float64, column vectors."""

    viewport: tuple[int, int, int, int]  # x, y, width, height in pixels of the bound framebuffer
    model: Matrix  # (4, 4), data mm to world coordinates: the actor
    view: Matrix  # (4, 4), world to view coordinates: the camera
    projection: Matrix  # (4, 4), view to clip coordinates

    @cached_property
    def model_view(self) -> Matrix:
        """(4, 4), data mm to view coordinates."""
        product: Matrix = self.view @ self.model
        return product

    @cached_property
    def model_view_projection(self) -> Matrix:
        """(4, 4), data mm to clip coordinates."""
        product: Matrix = self.projection @ self.model_view
        return product

    @property
    def pixel_to_view(self) -> Matrix:
        """(4, 4), (x, y in [-1, 1], 1 - window depth, 1) to view coordinates, homogeneous."""
        # Scaled so that its largest entry is 1, which changes no position and keeps float32 in range.
        inverse = np.linalg.inv(self.projection) @ _FROM_COMPLEMENT
        scaled: Matrix = inverse / np.abs(inverse).max()
        return scaled

    @property
    def directions_to_view(self) -> Matrix:
        """(3, 3), tangents in data coordinates to view coordinates, scaled to keep float32 in range."""
        # A camera whose position is its focal point, as far from the origin as both round to the same number, turns
        # nothing: all is zero. Nothing is seen by it, and the unit matrix is as good as another.
        linear = self.model_view[:3, :3]
        largest = np.abs(linear).max()
        scaled: Matrix = linear / largest if largest > 0.0 else np.eye(3)
        return scaled

    def least_scale(self, bounds: Sequence[float]) -> float:
        """Return the fewest pixels that a mm across the view takes anywhere within bounds; 0 if that is not known."""
        corners = np.array([[x, y, z, 1.0] for x in bounds[:2] for y in bounds[2:4] for z in bounds[4:]])
        matrix = self.model_view_projection
        farthest = float((corners @ matrix[3]).max())
        axes = np.linalg.norm(matrix[:2, :3], axis=1) * np.array(self.viewport[2:]) / 2.0
        return float(axes.min()) / farthest if farthest > 0.0 else 0.0

    def rectangle(self, bounds: Sequence[float], slack: float, margin: float) -> tuple[float, float, float, float]:
        """Return the part of the viewport in which anything within bounds can be seen."""
        ends = [(bounds[i] - slack, bounds[i + 1] + slack) for i in (0, 2, 4)]
        corners = np.array([[x, y, z, 1.0] for x in ends[0] for y in ends[1] for z in ends[2]])
        clip = corners @ self.model_view_projection.T
        w = clip[:, 3]
        if not np.isfinite(clip).all() or w.min() <= 1e-6 * w.max():
            return -1.0, -1.0, 1.0, 1.0
        place = clip[:, :2] / w[:, None]
        pad = 2.0 * margin / np.array(self.viewport[2:], dtype=np.float64)
        left, lower = (place.min(axis=0) - pad).tolist()
        right, upper = (place.max(axis=0) + pad).tolist()
        within = [min(max(edge, -1.0), 1.0) for edge in (left, lower, right, upper)]
        return within[0], within[1], within[2], within[3]

    def pixel_rectangle(self, bounds: Sequence[float], slack: float, margin: float) -> tuple[int, int, int, int]:
        """Return the same as x, y, width, height in whole pixels of the viewport."""
        left, lower, right, upper = self.rectangle(bounds, slack, margin)
        width, height = self.viewport[2:]
        x, y = int((left + 1.0) / 2.0 * width), int((lower + 1.0) / 2.0 * height)
        x_end, y_end = (min(int((end + 1.0) / 2.0 * side) + 1, side) for end, side in ((right, width), (upper, height)))
        return x, y, max(x_end - x, 0), max(y_end - y, 0)

    def region_in_data(self, region: Any) -> Any:
        """Return a `pvfiblets.regions.Region` of world coordinates in data coordinates; None stays None."""
        return None if region is None else region.moved(np.linalg.inv(self.model))

    def planes_in_data(self, planes: Matrix) -> Matrix:
        """Return (k, 4) world planes in data coordinates."""
        moved: Matrix = planes @ self.model
        return moved


def frame_of(
    renderer: vtkRenderer,
    actor: vtkActor,
    viewport: tuple[int, int, int, int],
    camera: vtkCamera | None = None,
) -> Frame:
    """Return viewport and matrices of an actor as a renderer draws it now, stereo eye included."""
    # Or as it would by another camera.
    camera = renderer.GetActiveCamera() if camera is None else camera
    model = vtkMatrix4x4()
    actor.GetModelToWorldMatrix(model)
    view = to_array(camera.GetModelViewTransformMatrix())
    aspect = renderer.GetTiledAspectRatio()
    projection = to_array(camera.GetProjectionTransformMatrix(aspect, -1.0, 1.0))
    return Frame(viewport, to_array(model), view, projection)


def to_array(matrix: vtkMatrix4x4) -> Matrix:
    """Return a VTK matrix as (4, 4) float64."""
    numbers = [0.0] * 16
    matrix.DeepCopy(numbers, matrix)  # type: ignore[call-overload]
    return np.array(numbers).reshape(4, 4)


def pixel_scale(renderer: vtkRenderer, viewport: tuple[int, int, int, int]) -> float:
    """Return the pixels to draw for each pixel in which users give a width."""
    # A width is what the viewer sees in the finished picture. Users count pixels of the window, so a line takes the
    # same share of the picture whether it is drawn as it is, in an enlarged picture (`screenshot(scale=3)`), from many
    # samples, or with fewer dots per inch than usual, as its letters are. More dots per inch alone widen no line.
    window = renderer.GetRenderWindow()
    fewer_dots = min(1.0, window.GetDPI() / USUAL_DPI)
    return float(samples_per_pixel(renderer, viewport) * window.GetTileScale()[0] * fewer_dots)


def samples_per_pixel(renderer: vtkRenderer, viewport: tuple[int, int, int, int]) -> float:
    """Return pixels of the framebuffer for a pixel of the picture along one side; supersampling has more than one."""
    width, height = [0], [0]
    renderer.GetTiledSize(width, height)
    drawn, shown = max(zip(viewport[2:], (width[0], height[0]), strict=True))
    # A pixel more or less is rounding, and must not make thin lines wide.
    return drawn / shown if shown > 0 and drawn > shown + 1 else 1.0


PICTURES_PER_WINDOW = 1.5
"""Pixels of all pictures that an engine keeps, as a share of the window's: those at rest, and coarse ones."""

def weak(target: Any) -> vtkWeakReference:
    """Return VTK's weak reference: Python's dies with the wrapper, which VTK makes anew at will."""
    reference = vtkWeakReference()
    reference.Set(target)
    return reference


_reduced: dict[str, tuple[vtkWeakReference, tuple[float, float]]] = {}  # by address, which a later window may have


def reduce_detail(window: vtkRenderWindow, pixels: float, share: float = 1.0) -> None:
    """Draw a window with an error in pixels and a share of the streamlines, for speed; 0 and 1 end it."""
    address = window.GetAddressAsString("")
    _reduced.pop(address, None)
    if pixels > 0.0 or share < 1.0:
        _reduced[address] = weak(window), (pixels, share)


def slack(renderer: vtkRenderer) -> float:
    """Return the error in drawn pixels that :func:`reduce_detail` allows in a renderer's window; 0 by default."""
    return _reduction(renderer.GetRenderWindow())[0] if _reduced else 0.0


def wanted_share(window: vtkRenderWindow) -> float:
    """Return the share of the streamlines that :func:`reduce_detail` requests in a window; 1 by default."""
    return _reduction(window)[1] if _reduced else 1.0


def _reduction(window: vtkRenderWindow) -> tuple[float, float]:
    alive, found = _reduced.get(window.GetAddressAsString(""), (None, (0.0, 1.0)))
    return found if alive is not None and alive.Get() is not None else (0.0, 1.0)


def in_motion(renderer: vtkRenderer) -> bool:
    """Whether the window wants pictures at the rate of interaction."""
    # VTK's interactor styles and widgets raise that rate as they begin, and when they end they set it back and render
    # once more; so nothing has to be observed, and whatever drives an interactor is followed, on a server too.
    window = renderer.GetRenderWindow()
    interactor = window.GetInteractor()
    still = window.GetDesiredUpdateRate() if interactor is None else interactor.GetStillUpdateRate()
    return bool(window.GetDesiredUpdateRate() > still)


def renderers_of(prop: vtkProp) -> Iterator[vtkRenderer]:
    """Yield every renderer that holds a prop, directly or inside an assembly."""
    for index in range(prop.GetNumberOfConsumers()):
        consumer = prop.GetConsumer(index)
        if isinstance(consumer, vtkRenderer):
            yield consumer
        elif isinstance(consumer, vtkProp):
            yield from renderers_of(consumer)


def switch_view(engine: Any, renderer: vtkRenderer, actor: vtkProp | None, view: Any, style: Any) -> None:
    """Have an engine that can keep its picture of each view of a window, where several views show its actor."""
    if not hasattr(engine, "switch_to"):
        return
    window = renderer.GetRenderWindow()
    if actor is None or sum(one.GetRenderWindow() is window for one in renderers_of(actor)) < 2:
        engine.switch_to(None, 0)
        return
    left, bottom, right, top = renderer.GetViewport()
    pixels = math.prod(view.size) / ((right - left) * (top - bottom))  # of the window
    # Samples are not drawn again: those of all views take turns. While the camera moves, windows have fewer pixels.
    place = ("sample" if style.exact else renderer.GetAddressAsString(""), view.size)
    engine.switch_to(place, round(PICTURES_PER_WINDOW * pixels))


def items_of(collection: Any) -> list[Any]:
    """Return the items of a ``vtkCollection``."""
    return [collection.GetItemAsObject(index) for index in range(collection.GetNumberOfItems())]


def actors_in(prop: vtkProp) -> Iterator[vtkActor]:
    """Yield a prop that is an actor, and the actors of an assembly."""
    if isinstance(prop, vtkActor):
        yield prop
    elif isinstance(prop, (vtkAssembly, vtkPropAssembly)):
        for part in items_of(prop.GetParts()):
            yield from actors_in(part)


def others_before(renderer: vtkRenderer, actor: vtkProp) -> bool:
    """Return whether VTK has drawn something opaque before an actor, whose depth may be looked at."""
    # False while VTK selects, which draws an invisible frame.
    if renderer.GetSelector() is not None:
        return False
    for prop in items_of(renderer.GetViewProps()):
        if prop is actor:
            return False
        if prop.GetVisibility() and prop.HasOpaqueGeometry():
            return True
    return False


def others_opaque(renderer: vtkRenderer, actor: vtkProp) -> bool:
    """Return whether anything else that a renderer shows is opaque, and so drawn before an actor that is translucent.

    Props in the plane of the screen and volumes of VTK leave no depth, though they call themselves opaque.
    """
    for prop in items_of(renderer.GetViewProps()):
        flat = prop is actor or prop.IsA("vtkActor2D") or prop.IsA("vtkVolume")
        if not flat and prop.GetVisibility() and prop.HasOpaqueGeometry():
            return True
    return False


def world_planes(mapper: Any) -> Matrix:
    """Return the clipping planes of a mapper."""
    planes = []
    for index in range(mapper.GetNumberOfClippingPlanes()):
        plane = mapper.GetClippingPlanes().GetItem(index)
        normal, origin = np.array(plane.GetNormal()), np.array(plane.GetOrigin())
        planes.append([*normal, -float(normal @ origin)])
    return np.array(planes, dtype=np.float64).reshape(-1, 4)
