"""Boundaries of a region along each pixel's ray: `RegionIntervals`, for ``shaders/regions/boundaries.glsl``.

This work is based on: Schertzer et al. 2022, section 5.1 and figure 10: a mesh drawn into a depth buffer for its front
and one for its back decides by pixel which fragments lie inside, which is right for convex meshes. Here every pixel has
a sorted list of all window depths at which the region's expression turns, whatever its shapes.

==========  =========================================================================================================
step        task
==========  =========================================================================================================
rays        planes, slabs, boxes and spheres: their rows of ``shaders/regions/rays.glsl``, composed in float64
surfaces    closed surfaces are drawn, layer by layer (:mod:`.surface_layers`)
combine     merges all crossings of a pixel and keeps the ones where the expression changes, four to a pass and layer
==========  =========================================================================================================

Made once for a region, a size and a camera. A box, a sphere or a convex mesh takes one layer of 16 bytes a pixel.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import moderngl
import numpy as np
import numpy.typing as npt

from ...query.regions.shapes import SURFACE
from ..errors import EngineError
from ..frame import Array, local_frame
from ..gl.bindings import BLOCKS, REGIONS
from ..gl.delayed_read import DelayedRead
from ..gl.gl_version import version_of
from ..gl.moderngl_extras import GLExtras
from ..gl.shaders import NEWEST, Programs, assemble, switched_on
from ..view import View
from .clip_planes import check_region
from .convex_rays import RAYS_BLOCK, RegionSignature, rays_block, to_unit, window_matrix
from .layer_stack import LayerStack, Rectangle, Squares
from .surface_crossings import SurfaceLayers, rectangle_of

if TYPE_CHECKING:
    from ...query.regions.shapes import Region
    from ...query.regions.surfaces import Surface

_OVERFLOW = "regions/overflow.frag"
_SCISSOR_TEST = 0x0C11

_FORMS = 8  # programs kept

_LAYERS = 2  # layers of boundaries, until a pixel is known to have more


class RegionIntervals:
    """Keeps the boundaries of a region along the rays of a picture."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._made: tuple[object, ...] | None = None
        self._form: tuple[RegionSignature, tuple[int, ...]] | None = None
        self._stack: LayerStack | None = None
        self._squares = Squares(ctx, gl, programs)
        self._surfaces: SurfaceLayers | None = None
        self._forms: dict[
            tuple[RegionSignature, int], tuple[moderngl.Program, moderngl.VertexArray, frozenset[str]]
        ] = {}
        self._block: moderngl.Buffer | None = None
        self.layers = 0
        self._known = 0  # layers that sufficed for earlier pictures of the form, or nearly
        self._reads = DelayedRead(ctx, gl)

    def prepare(self, view: View, origin: Array, scale: Array, top: int) -> bool:
        """Update the boundaries; unchanged region, size and camera cost nothing."""
        # Changes the framebuffer's binding for a while, and leaves blending, culling and the depth test off.
        region = view.region
        if region is None:
            self.release()
            return False
        check_region(region)
        key = (region, view.size, view.model_view_projection.tobytes(), tuple(origin), tuple(scale), top, view.waits)
        if self._made == key:
            return True
        self._made = None
        _, to_data, to_clip = local_frame(view, origin, scale, top)
        with self._gl.framebuffers_kept():
            self._ctx.enable_only(moderngl.NOTHING)
            self._ctx.wireframe = False
            try:
                self._make(region, to_clip, to_data[:3, 3], view.size, view.waits)
            finally:
                self._ctx.disable_direct(_SCISSOR_TEST)
        self._made = key
        return True

    def _make(self, region: Region, to_clip: Array, offset: Array, size: tuple[int, int], waits: bool) -> None:
        window = window_matrix(to_clip, size)
        try:
            block = rays_block(region, window, offset, size)
        except np.linalg.LinAlgError:
            stack = self._stack_of(size, 1)
            stack.framebuffers[0].scissor = 0, 0, *size
            self._gl.fill(stack.framebuffers[0], 0, (-1.0, 2.0, 2.0, 2.0))
            self.layers = 1
            return
        crossings = self._draw_surfaces(region, block, to_clip, offset, size, waits)
        crossings += 2 * sum(leaf.kind != SURFACE for leaf in region.leaves)
        if self._block is None:
            self._block = self._ctx.buffer(reserve=RAYS_BLOCK.nbytes)
        self._block.write(block.tobytes())
        form = RegionSignature.from_region(region)
        meshes = tuple(id(cast("Surface", leaf).mesh) for leaf in region.leaves if leaf.kind == SURFACE)
        if (form, meshes) != self._form:  # a simpler one needs no more than it does
            self._form = form, meshes
            self._drop_stack()
            self._known = 0
            self._reads.forget()
        rectangle, most = (0, 0, *size), crossings + 1
        if form.bounded:
            rectangle = self._rectangle(region, block, to_clip, offset, size)
            # What is beyond all crossings is known, and with it whether boundaries are even or odd in number.
            most = crossings + (crossings + form.far) % 2
        enough = -(-most // 4)
        if (came := self._reads.arrived()) is not None and came[1].any():  # the known number was too small
            self._known = max(self._known, 2 * came[0])
        layers = min(enough, max(_LAYERS, self._known))
        while True:
            stack = self._stack_of(size, layers)
            self.layers = stack.layers
            self._combine(form, stack, rectangle)
            if stack.layers >= enough:
                break
            if self._known and not waits:
                if self._ask(stack, rectangle):
                    self._squares.ask_later(_OVERFLOW, rectangle, self._reads, stack.layers)
                return
            if not self._overflows(stack, rectangle):
                break
            layers = min(2 * stack.layers, enough)
        self._known = stack.layers

    def _rectangle(
        self, region: Region, block: npt.NDArray[Any], to_clip: Array, offset: Array, size: tuple[int, int]
    ) -> Rectangle:
        """Return the pixels that the leaves of a region may touch, all bounded."""
        found = []
        for k, leaf in enumerate(region.leaves):
            if leaf.kind == SURFACE:
                found.append(block["rays_rectangles"][k].tolist())
            else:
                placed = to_clip @ np.linalg.inv(to_unit(leaf, offset))
                found.append(rectangle_of(placed, np.full(3, -1.0), np.ones(3), size))
        lefts, lowers, rights, uppers = zip(*found, strict=True)
        return min(lefts), min(lowers), max(rights), max(uppers)

    def _overflows(self, stack: LayerStack, rectangle: Rectangle) -> bool:
        """Return whether any pixel has more boundaries than there are layers for."""
        return self._ask(stack, rectangle) and bool(self._squares.ask(_OVERFLOW, rectangle).any())

    def _ask(self, stack: LayerStack, rectangle: Rectangle) -> bool:
        """Get ready to ask that; False if no pixel has any boundaries."""
        if rectangle[0] == rectangle[2] or rectangle[1] == rectangle[3]:
            return False
        program = self._squares.program(_OVERFLOW, rectangle)
        stack.textures[0].use(REGIONS["region_boundaries"])
        program["region_boundaries"], program["last"] = REGIONS["region_boundaries"], stack.layers - 1
        return True

    def _draw_surfaces(
        self,
        region: Region,
        block: npt.NDArray[Any],
        to_clip: Array,
        offset: Array,
        size: tuple[int, int],
        waits: bool,
    ) -> int:
        """Draw the surfaces' layers and pack where they are; return how many crossings a pixel can have of them."""
        leaves = [k for k, leaf in enumerate(region.leaves) if leaf.kind == SURFACE]
        if not leaves:
            if self._surfaces is not None:
                self._surfaces.release()
                self._surfaces = None
            return 0
        if self._surfaces is None:
            self._surfaces = SurfaceLayers(self._ctx, self._gl, self._programs)
        surfaces = [cast("Surface", region.leaves[k]) for k in leaves]
        peeled = self._surfaces.draw(surfaces, to_clip, offset, size, waits=waits)
        for k, place in zip(leaves, peeled, strict=True):
            block["rays_rectangles"][k] = place.rectangle
            block["rays_first_layers"][k] = place.first
            block["rays_layer_counts"][k] = place.layers
            block["rays_first_tallies"][k] = place.tallies
        return sum(place.crossings for place in peeled)

    def _combine(self, form: RegionSignature, stack: LayerStack, rectangle: Rectangle) -> None:
        """Draw all layers of the boundaries."""
        assert self._block is not None
        program, array = self._program(form, stack.together)
        if self._surfaces is not None:
            self._surfaces.bind(program)
        self._block.bind_to_uniform_block(BLOCKS["Rays"])
        program["room"] = 4 * stack.layers
        left, lower, right, upper = rectangle
        whole = right - left == stack.size[0] and upper - lower == stack.size[1]
        for number, framebuffer in enumerate(stack.framebuffers):
            if not whole:
                framebuffer.scissor = 0, 0, *stack.size
                for k in range(stack.together):
                    start = -1.0 if form.far and number == k == 0 else 2.0
                    self._gl.fill(framebuffer, k, (start, 2.0, 2.0, 2.0))
            if left == right or lower == upper:
                continue
            program["first"] = 4 * stack.together * number
            framebuffer.scissor = left, lower, right - left, upper - lower
            framebuffer.use()
            array.render(moderngl.TRIANGLES, vertices=3)

    def _program(self, form: RegionSignature, outputs: int) -> tuple[moderngl.Program, moderngl.VertexArray]:
        """Return the program for a form of region and layers at once, and what to render three vertices of."""
        key = form, outputs
        if key not in self._forms:
            while len(self._forms) >= _FORMS:
                for thing in self._forms.pop(next(iter(self._forms)))[1::-1]:
                    thing.release()
            version = min(version_of(self._ctx), NEWEST)
            features = ["PEEL"] if SURFACE in form.kinds else []
            constants = {**form.constants, "outputs": outputs}
            fragment = assemble("regions/combine.frag", features, constants, version=version)
            try:
                program = self._ctx.program(
                    vertex_shader=assemble("screen/triangle.vert", version=version), fragment_shader=fragment
                )
            except moderngl.Error as error:
                raise EngineError(f"regions/combine.frag does not compile: {error}\n{fragment}") from error
            block = program["Rays"]
            assert isinstance(block, moderngl.UniformBlock)
            block.binding = BLOCKS["Rays"]
            self._forms[key] = program, self._ctx.vertex_array(program, []), switched_on(fragment)
        program, array, on = self._forms[key]
        self._programs.note(on)
        return program, array

    def _stack_of(self, size: tuple[int, int], layers: int) -> LayerStack:
        """Make room for layers of a size; growth loses the contents."""
        held = self._stack
        if held is None or held.size != size or held.layers < layers:
            self._drop_stack()
            together = min(1 << (layers - 1).bit_length(), 8)
            layers = -(-layers // together) * together
            self._stack = held = LayerStack(self._ctx, self._gl, size, layers, (4,), together)
        return held

    def _drop_stack(self) -> None:
        if self._stack is not None:
            self._stack.release()
            self._stack = None

    def bind(self, program: Any) -> None:
        """Bind the boundaries and tell a program where they are, if it asks."""
        if self._stack is None:
            return
        self._stack.textures[0].use(REGIONS["region_boundaries"])
        for name, value in {"region_boundaries": REGIONS["region_boundaries"], "region_layers": self.layers}.items():
            if name in program:
                program[name] = value

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        block = 0 if self._block is None else self._block.size
        parts = self._stack, self._surfaces, self._squares, self._reads
        return block + sum(part.nbytes for part in parts if part is not None)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._drop_stack()
        if self._surfaces is not None:
            self._surfaces.release()
            self._surfaces = None
        self._squares.release()
        self._reads.release()
        self._known = 0
        for program, array, _ in self._forms.values():
            array.release()
            program.release()
        self._forms.clear()
        if self._block is not None:
            self._block.release()
            self._block = None
        self._made = None
        self.layers = 0
