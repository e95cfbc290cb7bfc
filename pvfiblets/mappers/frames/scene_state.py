"""The state of a renderer's picture, as one value: as long as it stays the same, so does the picture.

VTK counts changes (``GetMTime``), and draws data anew by that count alone; so uncounted changes are
not in the next picture either. The overlay, scalar bars and texts, is no part of it.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkProp, vtkRenderer, vtkRenderWindow

_multisamples: dict[str, int] = {}  # settings of windows that render a frame without multisampling, by address

_SETTINGS = (
    "GetAmbient", "GetAutomaticLightCreation", "GetBackground", "GetBackground2", "GetBackgroundAlpha", "GetDraw",
    "GetErase", "GetGradientBackground", "GetLayer", "GetLightFollowCamera", "GetMaximumNumberOfPeels",
    "GetOcclusionRatio", "GetPreserveColorBuffer", "GetPreserveDepthBuffer", "GetTexturedBackground",
    "GetTwoSidedLighting", "GetUseDepthPeeling", "GetUseDepthPeelingForVolumes", "GetUseFXAA",
    "GetUseHiddenLineRemoval", "GetUseImageBasedLighting", "GetUseOIT", "GetUseShadows", "GetUseSSAO", "GetViewport",
)  # fmt: skip
_PARTS = ("GetBackgroundTexture", "GetEnvironmentTexture", "GetPass", "GetRightBackgroundTexture", "GetSSAOKernelSize")
_OVER = ("vtkActor2D", "vtkContextActor")  # classes of overlays


def scene_state(renderer: vtkRenderer) -> Hashable:
    """Return what a renderer would draw now; equal values mean equal pictures."""
    window = renderer.GetRenderWindow()
    return (
        tuple(window.GetSize()),
        (_multisamples.get(window.GetAddressAsString(""), window.GetMultiSamples()), window.GetDPI()),
        _camera_state(renderer),
        tuple(_of(renderer, name) for name in _SETTINGS),
        tuple(_counted(_of(renderer, name)) for name in _PARTS),
        tuple(_counted(light) for light in _items(renderer.GetLights())),
        tuple(state for prop in _items(renderer.GetViewProps()) for state in _prop_states(prop)),
    )


@contextmanager
def without_multisamples(window: vtkRenderWindow) -> Iterator[None]:
    """Render without multisampling; states of pictures stay equal."""
    address, samples = window.GetAddressAsString(""), window.GetMultiSamples()
    _multisamples[address] = samples
    window.SetMultiSamples(0)
    try:
        yield
    finally:
        window.SetMultiSamples(samples)
        del _multisamples[address]


def _camera_state(renderer: vtkRenderer) -> Hashable:
    """Return matrices: a camera's own count goes up when it is shifted and put back."""
    camera = renderer.GetActiveCamera()
    view = camera.GetModelViewTransformMatrix()
    projection = camera.GetProjectionTransformMatrix(renderer.GetTiledAspectRatio(), -1.0, 1.0)
    return tuple(matrix.GetElement(row, k) for matrix in (view, projection) for row in range(4) for k in range(4))


def _prop_states(prop: vtkProp) -> Iterator[Hashable]:
    if any(prop.IsA(kind) for kind in _OVER):
        return
    yield prop.GetAddressAsString(""), prop.GetRedrawMTime()
    parts = prop.GetParts() if hasattr(prop, "GetParts") else None
    for part in () if parts is None else _items(parts):
        yield from _prop_states(part)


def _of(renderer: vtkRenderer, name: str) -> Any:
    """Return what a method says; None where this VTK has no such."""
    method = getattr(renderer, name, None)
    return None if method is None else method()


def _counted(part: Any) -> Hashable:
    return (part.GetAddressAsString(""), part.GetMTime()) if hasattr(part, "GetMTime") else part


def _items(collection: Any) -> Iterator[Any]:
    for index in range(collection.GetNumberOfItems()):
        yield collection.GetItemAsObject(index)
