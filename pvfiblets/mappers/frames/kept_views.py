"""`KeptViews`: in a window with several views, unchanged views keep their picture.

VTK clears and draws each view within its own viewport, into a framebuffer of the window's that stays from frame to
frame. So a view that is not drawn (``vtkRenderer::SetDraw``) still shows its last picture, at no cost: nothing is
copied, read or drawn again. Before each frame of the window, the state of each view is compared with its last one
(`pvfiblets.mappers.frames.scene_state`), and views in which both are the same are not drawn in that frame.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from typing import TYPE_CHECKING, Any

from pvfiblets.mappers.frames.idle_windows import shown_pictures
from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.mappers.frames.scene import in_motion, items_of, keep_views, weak
from pvfiblets.mappers.frames.scene_state import scene_state

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

_LETTERS = ("GetTextProperty", "GetTitleTextProperty", "GetLabelTextProperty", "GetAnnotationTextProperty")
_PARTS = (*_LETTERS, "GetLookupTable", "GetMapper", "GetInput", "GetProperty")


class KeptViews:
    """Has the views of a window drawn only in frames in which they have changed."""

    def __init__(self, window: vtkRenderWindow, renderers: Iterable[Any], prepare: Callable[[], None]) -> None:
        self._renderers = list(renderers)  # views that do not overlap. Others of the window are drawn in every frame.
        self._prepare = prepare  # called before each frame, to update views before their states are compared
        self._shown: dict[str, tuple[Hashable, bool]] = {}
        self._layout: Hashable = None
        self._left: list[Any] = []
        self._postponed: Any = None
        # how often each view was drawn, by the address of its renderer
        self.frames = {one.GetAddressAsString(""): 0 for one in self._renderers}
        self._window: Any = weak(window)
        keep_views.add(window.GetAddressAsString(""))
        self._ignore = observe(window, ("StartEvent", "EndEvent"), weakly(self._follow_frame, passing=True))

    def stop(self) -> None:
        """Draw all views in every frame again; twice is harmless."""
        window = self._window.Get()
        if window is not None:
            keep_views.discard(window.GetAddressAsString(""))
        self._ignore()
        self._put_back()
        self._shown.clear()

    def follow(self, renderer: vtkRenderer) -> None:
        """Add a view that is drawn only where it has changed."""
        self._renderers.append(renderer)
        self.frames[renderer.GetAddressAsString("")] = 0
        self._shown.clear()

    def forget(self) -> None:
        """Draw all views in the next frame."""
        self._shown.clear()

    def postpone(self, renderer: vtkRenderer) -> None:
        """Keep a view's picture in the next frame, though it has changed."""
        self._postponed = renderer

    def _follow_frame(self, _window: Any, event: str) -> None:
        if event == "StartEvent":
            self._start()
        else:
            self._end()

    def _start(self) -> None:
        window, postponed, self._postponed = self._window.Get(), self._postponed, None
        self._put_back()  # a frame that failed had no end
        if not self._comparable(window):
            self._shown.clear()
            return
        self._prepare()
        drawn = [one for one in self._renderers if one.GetDraw()]
        layout = (
            tuple((one.GetAddressAsString(""), one.GetViewport()) for one in drawn),
            (*window.GetSize(), window.GetMultiSamples(), window.GetContextCreationTime()),
        )
        if layout != self._layout:
            self._layout = layout
            self._shown.clear()
        due = {address for address, one in _pictures().items() if one.refinement is not None and one.refinement.due}
        for one in drawn:
            address = one.GetAddressAsString("")
            state, coarse = self._shown.get(address, (None, True))
            if one is postponed and address in self._shown:
                self._left.append(one)
                continue
            if address in due or state is None or (coarse and not in_motion(one)) or state != self._state(one):
                continue
            self._left.append(one)
        for one in self._left:
            one.SetDraw(False)

    def _end(self) -> None:
        window, left = self._window.Get(), {one.GetAddressAsString("") for one in self._left}
        self._put_back()
        if not self._comparable(window) or window.GetAbortRender():
            self._shown.clear()
            return
        for one in self._renderers:
            address = one.GetAddressAsString("")
            if one.GetDraw() and address not in left:
                self.frames[address] += 1
                # Drawing may have changed it, such as its camera's range of depths.
                self._shown[address] = self._state(one), in_motion(one)

    def _put_back(self) -> None:
        while self._left:
            self._left.pop().SetDraw(True)

    def _comparable(self, window: vtkRenderWindow) -> bool:
        """Return True for an ordinary frame of the window: no tile, no stereo, no selection."""
        whole = tuple(window.GetTileScale()) == (1, 1) and not window.GetStereoRender()
        return whole and all(one.GetSelector() is None for one in items_of(window.GetRenderers()))

    def _state(self, renderer: vtkRenderer) -> Hashable:
        """Return the state of a view with its overlays; None if it is unknown."""
        box = renderer.GetViewport()
        others = (one for one in items_of(self._window.Get().GetRenderers()) if one not in self._renderers)
        above = [one for one in others if one.GetDraw() and _overlap(box, one.GetViewport())]
        over = [(scene_state(one), _letters(one)) for one in above]
        picture = _pictures().get(renderer.GetAddressAsString(""))
        effects = () if picture is None else picture.settings
        found = _letters(renderer)
        if found is None or effects is None or any(letters is None for _, letters in over):
            return None
        return scene_state(renderer), effects, found, *over


def _pictures() -> dict[str, Any]:
    """Return what changes finished pictures, by the address of the renderer."""
    found = ((one.renderer, one) for one in shown_pictures)
    return {renderer.GetAddressAsString(""): one for renderer, one in found if renderer is not None}


def _overlap(a: tuple[float, ...], b: tuple[float, ...]) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def _letters(renderer: vtkRenderer) -> Hashable:
    """Return a renderer's overlays, texts and colour bars; None for charts, which count no changes."""
    found = []
    for prop in items_of(renderer.GetViewProps()):
        if prop.IsA("vtkContextActor"):
            return None
        if prop.IsA("vtkActor2D"):
            parts = (getattr(prop, name, None) for name in _PARTS)
            made = (part() for part in parts if part is not None)
            times = tuple(one.GetMTime() for one in made if hasattr(one, "GetMTime"))
            found.append((prop.GetAddressAsString(""), prop.GetVisibility(), prop.GetRedrawMTime(), times))
    return tuple(found)
