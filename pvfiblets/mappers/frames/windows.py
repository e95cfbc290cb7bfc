"""The GL side of a render window: its moderngl context, and what each mapper keeps in it.

VTK gives every render window a GL context of its own. `WindowContext` is the one object per window that
holds the moderngl context and a `Slot` per mapper: the mapper's engine renderer and its textures.

Nobody tells a Python mapper that it should let go of its GL objects: VTK calls C++ methods for that.
So a window's context looks after every frame (``EndEvent``) whether each mapper is still alive and its
actor still in the window, and releases the slot if not. A texture object of VTK's own stands by as a
witness: VTK empties it when the window's context is finalised. What was created in a dead context is
forgotten and never deleted, because its names may belong to others in the next context.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import moderngl
from vtkmodules.util.vtkConstants import VTK_UNSIGNED_CHAR
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkRenderingOpenGL2 import vtkTextureObject

from pvfiblets.mappers.frames.scene import renderers_of, weak
from pvfiblets.mappers.frames.scene_depth import OutsideDepth

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

GL_VIEWPORT = 0x0BA2
MAX_ROW = 4096  # greatest width of a texture that holds a list: below every driver's limit

_contexts: dict[str, WindowContext] = {}


def gl_viewport(window: Any) -> tuple[int, int, int, int]:
    """Return x, y, width, height of the viewport that VTK draws into now, in pixels."""
    values = [0, 0, 0, 0]
    window.GetState().vtkglGetIntegerv(GL_VIEWPORT, values)
    x, y, width, height = values
    return x, y, width, height


def _attach() -> moderngl.Context:
    """Return a moderngl context of its own on the current GL context."""
    # `moderngl.create_context` may return one that was made for another window.
    moderngl.init_context()
    ctx = moderngl.get_context()
    # It asks for properties of the default framebuffer, which a headless context lacks: an error of no
    # consequence, but the next one to look would take it for his own.
    ctx.clear_errors()
    return ctx


class Slot:
    """A mapper's state in one window."""

    def __init__(self, mapper: Any) -> None:
        self.mapper = weak(mapper)
        self.renderer: Any = None  # the engine's renderer, None until first needed
        self.textures: dict[str, Any] = {}  # name to moderngl texture
        self.versions: dict[str, Any] = {}  # name to the object the texture was made from
        self.drawn: dict[str, Any] = {}  # address of a vtkRenderer to its last frame (see `FibletMapper.pick_at`)
        # name of an effect to its class and its GPU resources (`pvfiblets.mappers.effects.shader_effects`)
        self.effects: dict[str, tuple[type, Any]] = {}
        # share of the streamlines to a renderer of these, for frames of reduced detail (`pvfiblets.mappers.thinned`)
        self.thinned: dict[float, Any] = {}
        self._outside: OutsideDepth | None = None

    def drop_effect(self, name: str) -> None:
        """Delete what an effect keeps. The window's context must be current."""
        kept = self.effects.pop(name)[1]
        if kept is not None:
            kept.release()

    def outside_depth(self, ctx: moderngl.Context) -> OutsideDepth:
        """Return what copies the depth of other actors."""
        if self._outside is None:
            self._outside = OutsideDepth(ctx)
        return self._outside

    def release(self) -> None:
        """Delete the GL objects. The window's context must be current."""
        self.drop_renderer()
        if self._outside is not None:
            self._outside.release()
            self._outside = None
        for name in list(self.effects):
            self.drop_effect(name)
        for texture in self.textures.values():
            texture.release()
        self.textures.clear()
        self.versions.clear()

    def drop_renderer(self) -> None:
        """Delete the engine's renderers only. The window's context must be current."""
        for renderer in (self.renderer, *self.thinned.values()):
            if renderer is not None:
                renderer.release()
        self.renderer = None
        self.thinned.clear()
        self.drawn.clear()

    def list_texture(self, name: str, source: Any, pixels: Any, ctx: moderngl.Context) -> Any:
        """Return an RGBA texture that holds a list of colours row by row."""
        if name in self.textures and self.versions.get(name) is source:
            return self.textures[name]
        colours = pixels()
        width = max(1, min(len(colours), MAX_ROW))
        height = max(1, -(-len(colours) // width))
        data = bytearray(colours.tobytes())
        data.extend(bytes(width * height * 4 - len(data)))
        old = self.textures.get(name)
        if old is not None and old.size == (width, height):
            old.write(data)
        else:
            if old is not None:
                old.release()
            self.textures[name] = ctx.texture((width, height), 4, data, alignment=1)
            self.textures[name].filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.versions[name] = source
        return self.textures[name]


class WindowContext:
    """GL context of a render window; make it with `context_of`."""

    def __init__(self, window: Any) -> None:
        self._window = weak(window)  # its context must be current
        self.slots: dict[str, Slot] = {}
        self.ctx: Any = None
        self._told_lost = False
        with self.foreign():
            self.ctx = _attach()
            self._witness = vtkTextureObject()
            self._witness.SetContext(window)
            self._witness.Allocate2D(1, 1, 4, VTK_UNSIGNED_CHAR)
            self._witness.Deactivate()  # or it would keep a texture unit
        # Held here and thus by the module: were they the window's alone, the garbage collector could
        # empty them before the window's last event calls them.
        self._callbacks = (lambda *_: self._sweep(), lambda *_: self._unregister())
        self._observers = [
            window.AddObserver(event, callback)
            for event, callback in zip((vtkCommand.EndEvent, vtkCommand.DeleteEvent), self._callbacks, strict=True)
        ]
        self.address = window.GetAddressAsString("")

    @property
    def window(self) -> Any:
        """The window, or None once it is gone."""
        return self._window.Get()

    @property
    def alive(self) -> bool:
        """Whether the GL context that the objects were made in still exists."""
        return self.window is not None and self._witness.GetHandle() != 0

    def tell_lost(self, renderer: vtkRenderer) -> None:
        """Warn once that VTK shows nothing translucent: where its depth peeling failed, with an error left behind."""
        # Some drivers refuse the copy of a multi-sampled depth that peeling begins with; meshes vanish as well.
        if self._told_lost or not renderer.GetUseDepthPeeling() or self.window.GetMultiSamples() < 2:
            return
        if self.ctx.error != "GL_NO_ERROR":
            self._told_lost = True
            warnings.warn(
                "VTK's depth peeling fails on this driver where the window is multi-sampled, so nothing translucent "
                "shows; call plotter.disable_anti_aliasing(), or choose 'ssaa' or 'fxaa'",
                RuntimeWarning,
                stacklevel=2,
            )

    def slot(self, mapper: Any) -> Slot:
        """Return the slot of a mapper, made when there is none."""
        return self.slots.setdefault(mapper.GetAddressAsString(""), Slot(mapper))

    @contextmanager
    def foreign(self) -> Iterator[None]:
        """Keep VTK's record of the GL state true around GL calls that are not VTK's."""
        # And moderngl's: whenever it has made a framebuffer, it binds the one that it remembers, and the one bound when
        # it was attached may be gone. Framebuffer 0 never is; VTK binds its own again at the end.
        #
        # An error of OpenGL that VTK has left behind (peeling of depth in a multi-sampled window does) is dropped: the
        # next caller, such as after making a buffer, would take it for its own.
        state = self.window.GetState()
        state.Reset()
        state.Push()
        if self.ctx is not None:
            self.ctx.clear_errors()
            self.ctx.fbo = self.ctx.screen
            self.ctx.mglo.fbo = self.ctx.screen.mglo
        try:
            yield
        finally:
            state.Pop()

    def texture_units(self, count: int) -> list[int]:
        """Return units that VTK does not use at this moment, the highest first."""
        # VTK hands out the lowest free ones. moderngl makes textures on the very last.
        manager = self.window.GetState().GetTextureUnitManager()
        last = min(manager.GetNumberOfTextureUnits(), self.ctx.max_texture_units) - 1
        units = [unit for unit in range(last - 1, -1, -1) if not manager.IsAllocated(unit)]
        if len(units) < count:
            raise RuntimeError(
                f"{len(units)} of {last + 1} texture units are free, but fiblets need {count}; "
                "remove textures from other actors of the scene"
            )
        return units[:count]

    def release(self, mapper: Any) -> None:
        """Delete what a mapper keeps in this window; twice is harmless."""
        slot = self.slots.pop(mapper.GetAddressAsString(""), None)
        if slot is not None:
            self._release_slots([slot])
        if not self.slots:
            self._close()

    def _release_slots(self, slots: list[Slot]) -> None:
        if not self.alive:
            return
        self.window.MakeCurrent()
        with self.foreign():
            for slot in slots:
                slot.release()

    def _sweep(self) -> None:
        """Release the slots of mappers that are gone or no longer in the window."""
        if not self.alive:
            self._forget()
            return
        gone = {address: slot for address, slot in self.slots.items() if not self.shows(slot.mapper.Get())}
        for address in gone:
            del self.slots[address]
        if gone:
            self._release_slots(list(gone.values()))
        if not self.slots:
            self._close()

    def shows(self, mapper: Any) -> bool:
        """Whether this window lives and the actor of a mapper is in it."""
        if not self.alive:
            return False
        return mapper is not None and self.address in _windows_of(mapper)

    def _close(self) -> None:
        """Give back what the context itself holds in a living window."""
        if self.alive:
            self.window.MakeCurrent()
            self._witness.ReleaseGraphicsResources(self.window)
        self._forget()

    def _forget(self) -> None:
        """Leave the window alone without touching GL."""
        self.slots.clear()
        window = self.window
        if window is not None:
            for observer in self._observers:
                window.RemoveObserver(observer)
        self._observers = []
        self._unregister()

    def _unregister(self) -> None:
        """Leave the list of contexts; the window may be half destroyed and is not touched."""
        self.slots.clear()
        if _contexts.get(self.address) is self:
            del _contexts[self.address]


def _windows_of(mapper: Any) -> dict[str, Any]:
    """Return the windows that the actor of a mapper is in, by their addresses."""
    renderers = [] if mapper.actor is None else renderers_of(mapper.actor)
    windows = [renderer.GetRenderWindow() for renderer in renderers]
    return {window.GetAddressAsString(""): window for window in windows if window is not None}


def make_current_again(mapper: Any) -> None:
    """Make the window current that draws a mapper whose actor is in several."""
    # VTK has just deleted objects of another of them, and on EGL leaves that one current.
    windows = _windows_of(mapper)
    for window in windows.values() if len(windows) > 1 else ():
        if window.CheckInRenderStatus():
            window.MakeCurrent()


def context_of(window: vtkRenderWindow) -> WindowContext:
    """Return the context of a window whose GL context is current, a new one after re-creation."""
    address = window.GetAddressAsString("")
    context = _contexts.get(address)
    if context is not None and not context.alive:
        context._forget()  # noqa: SLF001  this module's own
        context = None
    if context is None:
        context = _contexts[address] = WindowContext(window)
    return context


def contexts_with(mapper: Any) -> list[WindowContext]:
    """Return the contexts in which a mapper keeps something."""
    address = mapper.GetAddressAsString("")
    return [context for context in _contexts.values() if address in context.slots]


@contextmanager
def borrowed_context(window: vtkRenderWindow) -> Iterator[Any]:
    """Yield the moderngl context of a window that need not show any fiblets, current and free to be used."""
    window.Initialize()
    window.MakeCurrent()
    context = context_of(window)
    try:
        with context.foreign():
            yield context.ctx
    finally:
        if not context.slots:
            context._close()  # noqa: SLF001  this module's own
