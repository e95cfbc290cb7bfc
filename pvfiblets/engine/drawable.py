"""`Drawable`: what the renderers of all drawables do in the same way.

A renderer copies its data to the GPU when it is made, draws a G-buffer when the view or the style has changed, says
what that was made of, and gives everything back. A new drawable derives from `Drawable` and has

- a style, derived from :class:`pvfiblets.engine.view.Style`, as ``STYLE``,
- a constructor that puts all it keeps on the GPU through :meth:`Drawable._keep`, inside :meth:`Drawable._making`,
- :meth:`Drawable._draw`, which draws,
- :meth:`Drawable._facts`, which returns the drawable's own facts.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Hashable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, ClassVar, Generic, Protocol, TypeVar, cast

import moderngl

from .errors import EngineError
from .gbuffer import GBuffer
from .gl.moderngl_extras import GLExtras
from .gl.passes import Passes
from .gl.shaders import Programs
from .view import Style, View


class _GpuResource(Protocol):
    """GPU memory of a renderer; ``sizes``, ``buffers`` or ``nbytes`` give its size."""

    def release(self) -> None:
        """Give it back; twice is harmless."""
        ...


class Target(_GpuResource, Protocol):
    """Textures that a renderer draws a picture into."""

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        ...


AnyStyle = TypeVar("AnyStyle", bound=Style)
AnyResource = TypeVar("AnyResource", bound=_GpuResource)
AnyTarget = TypeVar("AnyTarget", bound=Target)


class Drawable(ABC, Generic[AnyStyle]):
    """Draws one set of data on one OpenGL context.

    The context must be current in every call. The renderer leaves its bindings behind, except for the framebuffers; the
    caller keeps its own OpenGL state. A ``lender`` is another drawable on the same context that lives longer, and lends
    its programs and targets: pictures of both go into the same textures.
    """

    STYLE: ClassVar[type[Style]]  # class of its styles

    pipeline: str  # how it draws
    share = 1.0  # how much of the data is drawn: 1.0 for all

    def __init__(
        self, ctx: moderngl.Context, constants: Mapping[str, Any], lender: Drawable[Any] | None = None
    ) -> None:
        self._ctx = ctx
        self._gl = GLExtras(ctx)
        self._passes = Passes(ctx)
        self._borrows = lender is not None
        self._programs: Programs = Programs(ctx, constants) if lender is None else lender._programs  # noqa: SLF001
        self._kept_on_gpu: list[tuple[str, _GpuResource]] = []
        self._targets: dict[str, tuple[Hashable, Target]] = {} if lender is None else lender._targets  # noqa: SLF001
        self._buffer: GBuffer | None = None
        self._made: tuple[View, Style] | None = None
        self._features: frozenset[str] = frozenset()
        self._generation = 0
        self._attempt = 0
        self._released = False

    # What a drawable adds

    @abstractmethod
    def _draw(self, view: View, style: AnyStyle, outside: moderngl.Texture | None) -> GBuffer:
        """Draw, whatever was drawn last."""

    @abstractmethod
    def _facts(self, *, counts: bool) -> dict[str, Any]:
        """Return what :meth:`explain` says beside passes, features and buffers."""

    def needs_outside(self, view: View, style: Style) -> bool:  # noqa: ARG002
        """Return whether :meth:`render` would gain from the depth of other things in the scene."""
        return False

    # Drawing

    def render(self, view: View, style: AnyStyle | None = None, *, outside: moderngl.Texture | None = None) -> GBuffer:
        """Draw, unless the last picture was of the same view and style, and return the renderer's own G-buffer."""
        # `outside` is the depth of other things in the scene, r32ui keys as in the G-buffer, of the view's size. A
        # picture that read it serves this one call only: the next one draws anew.
        style = self._checked(style)
        self._check_alive()
        if self._buffer is not None and self._made == (view, style) and self._serves(outside):
            return self._buffer
        self._start_picture()
        # One of our framebuffers must not stay bound when it is released.
        with self._gl.framebuffers_kept(), self._programs.noting() as features:
            self._buffer = self._draw(view, style, outside)
        self._finish_picture(self._buffer, features)
        if outside is None:
            self._made = view, style
        return self._buffer

    def render_in_pieces(self, view: View, style: AnyStyle | None = None) -> Iterator[None]:
        """Draw what :meth:`render` would, which then finds it drawn, and yield after each piece of about 50 ms."""
        # Other things may be drawn in between, and this drawable too: then the rest of it is left. Nothing is drawn,
        # nor yielded, where that cannot be done in pieces.
        style = self._checked(style)
        self._check_alive()
        steps = None if self._buffer is not None and self._made == (view, style) else self._pieces(view, style)
        if steps is None:
            return
        self._start_picture()
        buffer, attempt = None, self._attempt
        all_features: set[str] = set()
        try:
            while buffer is None:
                with self._gl.framebuffers_kept(), self._programs.noting() as features:
                    self._ctx.scissor = None
                    try:
                        next(steps)
                    except StopIteration as end:
                        buffer = end.value
                all_features |= features
                attempt = self._attempt
                if buffer is None:
                    yield
                    if self._attempt != attempt or self._released:
                        return
            self._finish_picture(buffer, all_features)
            self._buffer, self._made = buffer, (view, style)
        finally:
            steps.close()
            if self._made != (view, style) and self._attempt == attempt and not self._released:
                self._buffer = None
                self._give_up()

    def _start_picture(self) -> None:
        self._outdate()
        self._passes.begin()
        self._ctx.scissor = None

    def _finish_picture(self, buffer: GBuffer, features: set[str]) -> None:
        self._features = frozenset(features)
        self._generation += 1
        buffer.generation = self._generation

    def _pieces(self, view: View, style: AnyStyle) -> Generator[None, None, GBuffer] | None:  # noqa: ARG002
        """Return what draws piece by piece; None where that cannot be done."""
        return None

    def _give_up(self) -> None:
        """Forget a picture that was left before its end."""

    def _outdate(self) -> None:
        """Redraw the next time, and abort a drawing in pieces."""
        self._made = None
        self._attempt += 1

    def forget_picture(self) -> None:
        """Draw anew the next time, as somebody else draws into what holds the picture."""
        self._buffer = None
        self._outdate()

    def _serves(self, outside: moderngl.Texture | None) -> bool:  # noqa: ARG002
        """Return whether a picture that was drawn without an outside serves where there is one."""
        return True

    def _checked(self, style: AnyStyle | None) -> AnyStyle:
        """Return a style of the right class."""
        if style is None:
            try:
                return cast("AnyStyle", self.STYLE())
            except TypeError:
                pass  # it has fields without a default
        if not isinstance(style, self.STYLE):
            raise TypeError(f"style is a {type(style).__name__}; {type(self).__name__} needs a {self.STYLE.__name__}")
        return style

    def _fitting(self, name: str, key: Hashable, make: Callable[[], AnyTarget]) -> AnyTarget:
        """Return the target of a name: the one there is, if it was made for that key, else another."""
        held = self._targets.get(name)
        if held is not None and held[0] == key:
            return cast("AnyTarget", held[1])
        self._drop_target(name)
        target = make()
        self._targets[name] = key, target
        return target

    def _drop_target(self, name: str) -> None:
        """Give a target back; nothing if there is none."""
        held = self._targets.pop(name, None)
        if held is not None:
            self.forget_picture()
            held[1].release()

    # Memory

    @contextmanager
    def _making(self) -> Iterator[None]:
        """Give everything back that has been kept so far if making the rest fails."""
        try:
            yield
        except BaseException:
            self.release()
            raise

    def _keep(self, kept: AnyResource, name: str = "") -> AnyResource:
        """Release something with the renderer, and tell its size, by name where it has none for its parts."""
        self._kept_on_gpu.append((name, kept))
        return kept

    def _drop(self, kept: _GpuResource) -> None:
        """Give one thing back before the others."""
        self._kept_on_gpu = [(name, other) for name, other in self._kept_on_gpu if other is not kept]
        kept.release()

    @property
    def released(self) -> bool:
        """Whether everything on the GPU has been given back."""
        return self._released

    def _check_alive(self) -> None:
        if self._released:
            raise EngineError("this renderer has been released; make a new one")

    def _sizes(self) -> dict[str, int]:
        """Return bytes of everything on the GPU by name."""
        sizes: dict[str, int] = {}
        parts: list[tuple[str, Any]] = list(self._kept_on_gpu)
        if not self._borrows:
            parts += [(name, target) for name, (_, target) in self._targets.items()]
        for name, kept in parts:
            for part, size in sizes_of(kept, name).items():
                sizes[part] = sizes.get(part, 0) + size
        return sizes

    def explain(self, *, counts: bool = True) -> dict[str, Any]:
        """Return ``passes`` (name, ms), ``features`` and ``buffers`` (name, bytes) of the finished last redraw."""
        return {
            "passes": self._passes.report(),
            "features": sorted(self._features),
            "buffers": [{"name": name, "bytes": size} for name, size in self._sizes().items()],
            **self._facts(counts=counts),
        }

    def release(self) -> None:
        """Give back everything on the GPU; twice is harmless."""
        self._released = True
        for _, kept in self._kept_on_gpu:
            kept.release()
        self._kept_on_gpu.clear()
        if not self._borrows:
            for name in list(self._targets):
                self._drop_target(name)
            self._programs.release()
        self._passes.release()
        self._buffer = self._made = None


def sizes_of(kept: Any, name: str) -> dict[str, int]:
    """Return bytes by name: of ``sizes`` or ``buffers`` if it has them, else of all of it by the name given."""
    if name:
        return {name: kept.nbytes}
    if hasattr(kept, "sizes"):
        return dict(kept.sizes)
    return {part: getattr(buffer, "size", buffer) for part, buffer in kept.buffers.items()}
