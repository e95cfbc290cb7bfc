"""Effects on the whole picture of a renderer: depth of field and tones, behind scalar bars and texts.

VTK draws what is opaque, translucent, volumetric, and at last what lies over all of these: scalar bars, texts. Each of
them a prop may draw, in the order of the renderer's props. `Picture` puts a prop of its own before the first, a
``vtkContextActor``, which draws in the last of these turns only, and calls Python there: that is when the picture is
complete, its depths are those of VTK's framebuffer, and nothing lies over it yet. Colours and depths are read from the
textures of whichever framebuffer VTK draws into, and the changed colours are drawn there; depths stay as they are.

While nothing is changed, none of this exists.
"""

from __future__ import annotations

import ctypes
import weakref
from collections.abc import Callable
from typing import Any

from vtkmodules.vtkPythonContext2D import vtkPythonItem
from vtkmodules.vtkRenderingContext2D import vtkContextActor
from vtkmodules.vtkRenderingContextOpenGL2 import vtkOpenGLContextActor  # noqa: F401  what VTK makes of the former
from vtkmodules.vtkRenderingCore import vtkRenderer

from pvfiblets.engine.effects.picture import Attachment, PictureEffects
from pvfiblets.engine.effects.tone import Tone
from pvfiblets.engine.moderngl_extras import GLExtras
from pvfiblets.mappers.lens_focus import FOLLOWED, DepthOfField, Focusing, lens_of
from pvfiblets.mappers.overlays import Overlay
from pvfiblets.mappers.tiles import Margin, margin_of, shifted
from pvfiblets.mappers.windows import Slot, WindowContext, context_of, contexts_with, gl_viewport, weak

__all__ = ["DepthOfField", "Picture"]

ANTIALIAS = ("off", "coverage")
"""How edges of lines may be smoothed."""

_COVERAGE = "coverage"
_COLOUR, _DEPTH = 0x8CE0, 0x8D00
_DRAW_FRAMEBUFFER, _TYPE, _NAME, _COMPONENTS = 0x8CA9, 0x8CD0, 0x8CD1, 0x8211
_TEXTURE, _FLOAT = 0x1702, 0x1406


class Picture:
    """What is done to everything that a renderer draws.

    Parameters
    ----------
    renderer : vtkRenderer

    Notes
    -----
    An exception while drawing cannot pass through VTK: it is stored, the picture stays as it was drawn, and
    `raise_pending` raises it.
    """

    def __init__(self, renderer: vtkRenderer) -> None:
        self._renderer = weak(renderer)
        self._tone = Tone()
        self._depth_of_field: DepthOfField | None = None
        self._prop: _PictureProp | None = None
        self._observers: list[int] = []
        self._overlay = Overlay()
        self._smoothing: Any = None
        self._margin: Margin | None = None
        self._shift = 0, 0
        self._error: BaseException | None = None
        self.focusing = Focusing()

    @property
    def renderer(self) -> Any:
        """The renderer, or None once it is gone."""
        return self._renderer.Get()

    @property
    def tone(self) -> Tone:
        """What is done to colours."""
        return self._tone

    @tone.setter
    def tone(self, tone: Tone) -> None:
        self._tone = tone
        self._hang()

    @property
    def depth_of_field(self) -> DepthOfField | None:
        """What is in focus; None for all."""
        return self._depth_of_field

    @depth_of_field.setter
    def depth_of_field(self, wanted: DepthOfField | None) -> None:
        self._depth_of_field = wanted
        if wanted is None or wanted.focal_distance not in FOLLOWED:
            self.focusing.forget()
        self._hang()

    @property
    def antialias(self) -> str:
        """How edges of lines are smoothed: ``'off'``, or ``'coverage'`` (`pvfiblets.mappers.coverage`)."""
        return "off" if self._smoothing is None else "coverage"

    @antialias.setter
    def antialias(self, wanted: str) -> None:
        if wanted not in ANTIALIAS:
            raise ValueError(f"antialias is {wanted!r}; use one of {list(ANTIALIAS)}")
        if wanted == self.antialias or self.renderer is None:
            return
        if wanted == "off":
            self._smoothing.release()
            self._smoothing = None
        else:
            from pvfiblets.mappers.coverage import EdgeSmoothing

            self._smoothing = EdgeSmoothing(self.renderer)
        self._hang()

    @property
    def focal_distance(self) -> float | None:
        """Distance (mm) that was in focus in the last picture; None before the first, and without depth of field."""
        return self.focusing.distance if self._depth_of_field is not None else None

    @property
    def on(self) -> bool:
        """Whether anything is changed."""
        return self._tone.changes or self._depth_of_field is not None or self._smoothing is not None

    # In the renderer

    def _hang(self) -> None:
        """Put the prop into the renderer, or take it out, as need be."""
        renderer = self.renderer
        if renderer is None:
            return
        if self.on and self._prop is None:
            self._prop = _PictureProp()
            self._prop.hang(self)
            reference = weakref.ref(self)

            def call(_caller: Any, event: str) -> None:
                picture = reference()
                if picture is not None:
                    picture.stored(picture.start if event == "StartEvent" else picture.end)

            self._observers = [renderer.AddObserver(event, call) for event in ("StartEvent", "EndEvent")]
            self._first()
        elif not self.on:
            self.release()
        renderer.Modified()

    def _first(self) -> None:
        """Have the prop be the first of the renderer's, though others were added or all removed."""
        props = self.renderer.GetViewProps()
        if props.GetNumberOfItems() and props.GetItemAsObject(0) is self._prop:
            return
        if not self.renderer.HasViewProp(self._prop):
            self.renderer.AddViewProp(self._prop)
        if props.GetNumberOfItems() > 1:  # or there would be none to insert it before
            props.RemoveItem(self._prop)
            props.InsertItem(-1, self._prop)

    def release(self) -> None:
        """Leave the renderer and give everything on the GPU back; twice is harmless."""
        if self._smoothing is not None:
            self._smoothing.release()
        prop, self._prop = self._prop, None
        if prop is None:
            return
        renderer = self.renderer
        if renderer is not None:
            for observer in self._observers:
                renderer.RemoveObserver(observer)
            renderer.RemoveViewProp(prop)
        for context in contexts_with(prop):
            context.release(prop)

    def raise_pending(self) -> None:
        """Raise the exception of the last draw, if there was one, once."""
        error, self._error = self._error, None
        if error is not None:
            raise error

    def explain(self) -> dict[str, Any]:
        """Return what the effects cost: ``buffers``, name and bytes of what they keep on the GPU."""
        slots = [] if self._prop is None else [context.slot(self._prop) for context in contexts_with(self._prop)]
        kept = [("picture", slot.renderer) for slot in slots]
        kept += [(_COVERAGE, slot.effects[_COVERAGE][1]) for slot in slots if _COVERAGE in slot.effects]
        return {"buffers": [{"name": name, "bytes": held.nbytes} for name, held in kept if held is not None]}

    # Drawing

    def start(self) -> None:
        """Get ready; called when the renderer is about to draw."""
        renderer = self.renderer
        if renderer is None or self._prop is None:
            return
        self._first()
        if self._smoothing is not None:
            self._smoothing.begin()
        self._overlay.hold(renderer)
        if self._shift != (0, 0):
            return
        self._margin = None
        if self._depth_of_field is not None and renderer.GetSelector() is None:
            reach = int(self._depth_of_field.max_blur * renderer.GetRenderWindow().GetTileScale()[1]) + 1
            self._margin = margin_of(renderer, reach)
        if self._margin is not None:
            self._draw_around(renderer, self._margin)

    def _draw_around(self, renderer: Any, margin: Margin) -> None:
        """Copy what lies around a tile; the tile itself is drawn after that."""
        try:
            for shift in margin.shifts():
                self._shift = shift
                with shifted(renderer.GetActiveCamera(), margin.size, shift):
                    renderer.Render()
        finally:
            self._shift = 0, 0

    def end(self) -> None:
        """Draw what has been put off; called when the renderer has drawn."""
        renderer = self.renderer
        if renderer is not None:
            self._overlay.let_go(renderer)

    def stored(self, step: Callable[[], None]) -> None:
        """Take a step of a frame; what it raises, VTK would swallow: see `raise_pending`."""
        try:
            step()
        except Exception as error:  # noqa: BLE001
            self._error = error

    def paint(self) -> None:
        """Change the picture; called when all but what lies over it is drawn."""
        renderer, prop = self.renderer, self._prop
        if renderer is None or prop is None or renderer.GetSelector() is not None:
            return
        context = context_of(renderer.GetRenderWindow())
        viewport = gl_viewport(context.window)
        if min(viewport[2:]) < 1:  # a tile of an enlarged picture in which the renderer has no part
            return
        wanted, smoothing = self._depth_of_field, self._smoothing
        smooth = smoothing is not None and smoothing.pending
        changed = wanted is not None or self._tone.changes
        if not smooth and not changed:
            return
        slot = context.slot(prop)
        with context.foreign():
            if smoothing is None and _COVERAGE in slot.effects:
                slot.drop_effect(_COVERAGE)
            colour = _attachment(context, _COLOUR)
            if smooth:
                smoothing.smooth(_smoother(context, slot), colour, _attachment(context, _DEPTH), viewport)
            if not changed:
                return
            if slot.renderer is None:
                slot.renderer = PictureEffects(context.ctx)
            effects = slot.renderer
            if wanted is None:
                effects.copy(colour, None, viewport)
                effects.draw(colour, viewport, tone=self._tone)
                return
            depth, margin = _attachment(context, _DEPTH), self._margin
            if margin is None or margin.size != viewport[2:]:
                effects.copy(colour, depth, viewport)
            else:
                effects.copy(colour, depth, viewport, size=margin.padded, corner=margin.corner(self._shift))
            if self._shift != (0, 0):
                return
            lens = lens_of(renderer, viewport[2:])
            focus = self.focusing.focus(wanted, renderer, effects, lens)
            effects.draw(colour, viewport, tone=self._tone, focus=focus, lens=lens)


class _PictureProp(vtkContextActor):
    """The prop that calls Python when VTK comes to what lies over the picture."""

    def hang(self, picture: Picture) -> None:
        """Call a picture, which is not kept alive."""
        self.SetPickable(False)
        self.SetUseBounds(False)
        self._item = vtkPythonItem()
        self._item.SetPythonObject(_Painter(picture))
        self.GetScene().AddItem(self._item)

    @property
    def actor(self) -> vtkContextActor:
        """What a `WindowContext` asks for, to see whether it is still shown."""
        return self

    def HasOpaqueGeometry(self) -> int:  # noqa: N802  VTK's name
        """Return 0: it leaves no depth that could hide anything."""
        return 0


class _Painter:
    """What VTK calls."""

    def __init__(self, picture: Picture) -> None:
        self._picture = weakref.ref(picture)

    def Initialize(self, _item: Any) -> bool:  # noqa: N802  VTK's name
        """Be told of its item."""
        return True

    def Paint(self, _item: Any, _context: Any) -> bool:  # noqa: N802  VTK's name
        """Be called when it is time to draw."""
        picture = self._picture()
        if picture is not None:
            picture.stored(picture.paint)
        return True


def _smoother(context: WindowContext, slot: Slot) -> Any:
    """Return what smooths edges in a window, made when it is first needed."""
    if _COVERAGE not in slot.effects:
        from pvfiblets.engine.effects.coverage import Coverage

        slot.effects[_COVERAGE] = Coverage, Coverage(context.ctx)
    return slot.effects[_COVERAGE][1]


def _attachment(context: WindowContext, point: int) -> Attachment:
    """Return colour or depth of the framebuffer that VTK draws into.

    Raises
    ------
    RuntimeError
        It is no texture.
    """
    gl = GLExtras(context.ctx)
    values = []
    if gl.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") != 0:
        for what in (_TYPE, _NAME, _COMPONENTS):
            value = ctypes.c_int(0)
            gl.function("glGetFramebufferAttachmentParameteriv")(_DRAW_FRAMEBUFFER, point, what, ctypes.byref(value))
            values.append(value.value)
    if not values or values[0] != _TEXTURE:
        raise RuntimeError(
            "effects on the picture need VTK to draw into textures, which it does not here; "
            "remove the render passes that were added to the renderer"
        )
    return Attachment(values[1], gl.get_integer("GL_SAMPLES"), values[2] == _FLOAT)
