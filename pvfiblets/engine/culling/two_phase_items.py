"""Two-phase culling of items that are drawn as pulled quads: what others hide is not drawn, and no pixel changes.

An item is a segment of a spline tube, or some neighbours of lines with halos. Those that own a pixel of the last
picture are drawn first. A pyramid of that depth, which belongs to this very camera, then tells of all others which
cannot show; the rest is drawn after. Both lists are made on the GPU, and drawn by calls whose numbers it writes itself:
the CPU issues the same calls whatever shows, and nothing is read back. In what order items are listed is not
determined, and so neither is which of two owns a pixel in which both are as deep.

It needs compute stages (OpenGL 4.3), and pays from some ten thousand segments on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import moderngl

from ..gl.bindings import ITEM_STORAGE, ITEMS, ITEMS_SHOWN
from ..gl.gl_version import version_of
from ..gl.moderngl_extras import BufferTexture, GLExtras
from ..gl.passes import dispatch, work_groups
from ..gl.shaders import Programs
from ..gl.vertex_pulling import BATCH
from .pyramid import DepthPyramid

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..gl.passes import Passes
    from ..hit_target import HitTarget

LEAST_SEGMENTS = 16000
"""With fewer, two rounds and a pyramid cost more than they save: for 3,500 segments twice the time."""
_QUAD = 4  # vertices
_GROUP = 64


class Listing:
    """Lists and draws the items of one set that may show."""

    def __init__(
        self,
        ctx: moderngl.Context,
        gl: GLExtras,
        programs: Programs,
        n_items: int,
        *,
        cull: str,  # The compute shader that lists them, an invocation each
        features: Sequence[str] = (),  # Of that shader; they may be others for each picture
        shift: int = 0,  # Items are ``1 << shift`` quads each: a quad's number shifted right by this is its item's
    ) -> None:
        self._ctx, self._gl, self._programs, self._n = ctx, gl, programs, n_items
        self._cull, self.features, self._shift = cull, list(features), shift
        self._pyramid = DepthPyramid(ctx, gl, programs)
        self._per_call = BATCH // _QUAD >> shift
        self._calls = -(-n_items // self._per_call)
        self._max_groups = work_groups(ctx)
        self.buffers: dict[str, moderngl.Buffer] = {}
        self._texture: BufferTexture | None = None
        try:
            for name, size in (
                ("seen", 4 * -(-n_items // 32)),
                ("listed", 4 * n_items),
                ("counts", 16),
                ("commands", 20 * self._calls),
            ):
                self.buffers[name] = ctx.buffer(reserve=size)
            self._texture = gl.texture_buffer(self.buffers["listed"], "r32ui")
        except BaseException:
            self.release()
            raise

    @property
    def sizes(self) -> dict[str, int]:
        """Bytes of GPU memory that go with the items, and with the picture."""
        return {"culling": sum(buffer.size for buffer in self.buffers.values()), "occlusion": self._pyramid.nbytes}

    def before(self, target: HitTarget, shown: moderngl.Texture) -> None:
        """Note what the last picture shows; nothing, if there is none of this size. Call it before that is cleared."""
        seen = self.buffers["seen"]
        self._gl.clear_words(seen)
        if not target.buffer.generation:
            return
        program = self._programs.compute("culling/visible_items.comp")
        seen.bind_to_storage_buffer(ITEM_STORAGE["seen"])
        shown.use(ITEMS_SHOWN["shown"])
        program["shown"], program["count"], program["shift"] = ITEMS_SHOWN["shown"], self._n, self._shift
        width, height = target.size
        program.run(-(-width // 8), -(-height // 8))
        self._ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)

    def draw(
        self,
        target: HitTarget,
        passes: Passes,
        prepare: Callable[[moderngl.ComputeShader], None],
        render: Callable[[moderngl.Buffer], None],
    ) -> None:
        """Draw what may show, in two rounds."""
        with passes.timed("seen before"):
            self._list(prepare, second=False)
            render(self.buffers["commands"])
        with passes.timed("pyramid"):
            self._make_pyramid(target)
        with passes.timed("others"):
            self._list(prepare, second=True)
            render(self.buffers["commands"])

    def _list(self, prepare: Callable[[moderngl.ComputeShader], None], *, second: bool) -> None:
        ctx = self._ctx
        self._gl.clear_words(self.buffers["counts"])
        for name, binding in ITEM_STORAGE.items():
            self.buffers[name].bind_to_storage_buffer(binding)
        cull = self._programs.compute(self._cull, self.features)
        prepare(cull)
        cull["second_round"] = int(second)
        if second:
            self._pyramid.bind(cull)
        dispatch(cull, -(-self._n // _GROUP), self._max_groups)
        ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)
        write = self._programs.compute("culling/item_commands.comp")
        write["calls"], write["batch"], write["quads"] = self._calls, self._per_call, 1 << self._shift
        write.run(-(-self._calls // _GROUP))
        ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)

    def _make_pyramid(self, target: HitTarget) -> None:
        target.write_keys(self._programs)
        self._pyramid.build(target.buffer)

    def bind(self, program: moderngl.Program) -> None:
        """Set the list's texture unit in a drawing program."""
        assert self._texture is not None
        self._texture.bind(ITEMS["listed"])
        self._gl.set_sampler(program, "listed_texels", ITEMS["listed"])

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        if self._texture is not None:
            self._texture.release()
            self._texture = None
        for buffer in self.buffers.values():
            buffer.release()
        self.buffers.clear()
        self._pyramid.release()


def supports_listing(ctx: moderngl.Context) -> bool:
    """Return whether a context has the required features."""
    return version_of(ctx) >= 430
