"""`HaloRenderer`: lines or points with halos on one OpenGL context, drawn into a G-buffer when something changed."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np

from ...halos.geometry import HaloLines, HaloPoints
from ..culling.listing import LEAST_SEGMENTS, Listing, supports_listing
from ..errors import EngineError
from ..gbuffer import EMPTY, GBuffer
from ..hit_target import HitTarget
from ..opengl import OpenGL
from ..passes import Passes
from ..shaders import Programs
from ..vertex_pulling import PulledShapes
from ..view import Style, View
from .uniform_blocks import CONSTANTS, ITEM_SHIFT, HaloBlocks
from .vertices import UNITS, Vertices

if TYPE_CHECKING:
    from ...halos.style import Look

__all__ = ["CULLING", "HaloRenderer", "HaloStyle"]

CULLING = ("two-phase", None)
"""How what others hide may be found out."""

HITS_UNIT, DEPTHS_UNIT = 10, 11


@dataclass(frozen=True)
class HaloStyle(Style):
    """How lines or points with halos become pixels.

    Parameters
    ----------
    values : str, optional
        Name of numbers or colours of the points, to write beside each pixel.
    look : Look
    """

    look: Look = field(kw_only=True)

    @property
    def half_width(self) -> float:
        """Pixels that a line reaches to either side of its axis at least."""
        return self.look.min_width / 2.0

    @property
    def reach(self) -> float:
        """Millimetres from the axis to the edge of a strip."""
        return 0.5 * self.look.strip_width

    @property
    def relief(self) -> str:
        """How much of a pixel is line."""
        return "ink"


class HaloRenderer:
    """Draws one set of lines or points with halos.

    The context must be current in every call. The renderer binds what it needs and leaves it bound; the caller keeps
    its own OpenGL state.

    Parameters
    ----------
    ctx : moderngl.Context
        OpenGL 3.3 or later.
    drawn : HaloLines or HaloPoints
        Copied to the GPU here.
    culling : {'two-phase', None}
        How items behind others are found out, where OpenGL 4.3 and many of them are there for it
        (:mod:`pvfiblets.engine.culling.listing`). It changes no pixel.

    Attributes
    ----------
    pipeline : str
        ``'strips'`` of lines, ``'discs'`` of points.
    share : float
        1.0: all is drawn.

    Raises
    ------
    EngineError
        If memory does not suffice or numbers are too large; nothing stays behind on the GPU.
    ValueError
        If a choice is none.

    Notes
    -----
    Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009), section 3.
    """

    share = 1.0

    def __init__(
        self, ctx: moderngl.Context, drawn: HaloLines | HaloPoints, *, culling: str | None = "two-phase"
    ) -> None:
        if culling not in CULLING:
            raise ValueError(f"culling is {culling!r}; choose one of {CULLING}")
        self._ctx, self._drawn = ctx, drawn
        points = isinstance(drawn, HaloPoints)
        self.pipeline = "discs" if points else "strips"
        self._kind = ["HALO_POINTS"] if points else []
        self._gl = OpenGL(ctx)
        self._passes = Passes(ctx)
        self._programs = Programs(ctx, CONSTANTS)
        self._vertices: Vertices | None = None
        self._blocks: HaloBlocks | None = None
        self._shapes: PulledShapes | None = None
        self._listing: Listing | None = None
        self._target: HitTarget | None = None
        self._made: tuple[View, Style] | None = None
        self._features: list[str] = []
        self._listed = False
        self._generation = 0
        try:
            self._vertices = Vertices(ctx, self._gl, drawn)
            self._blocks = HaloBlocks(ctx, self._vertices.origin, self._vertices.scale, drawn.bounds)
            self._n = self._vertices.n_items
            # Lists are of whole items; what is beyond the last quad draws nothing.
            self._shapes = PulledShapes(ctx, -(-self._n >> ITEM_SHIFT) << ITEM_SHIFT)
            many = self._n >= LEAST_SEGMENTS and not _flat(drawn.bounds)
            if culling is not None and many and supports_listing(ctx):
                self._listing = Listing(
                    ctx,
                    self._gl,
                    self._programs,
                    -(-self._n >> ITEM_SHIFT),
                    cull="halos/cull.comp",
                    shift=ITEM_SHIFT,
                )
        except BaseException:
            self.release()
            raise

    def render(
        self,
        view: View,
        style: Style,
        *,
        outside: moderngl.Texture | None = None,  # noqa: ARG002  as other renderers have it
    ) -> GBuffer:
        """Draw, unless the last picture was of the same view and style.

        Parameters
        ----------
        view : View
            Its region is not looked at.
        style : HaloStyle
        outside : moderngl.Texture, optional
            Not looked at.

        Returns
        -------
        GBuffer
            The renderer's own; the same object until the size changes. ``owner`` holds segments, each by its first
            point, or points, and nothing where a halo shows; ``ids`` lines and tangents; ``position`` the point's
            index within its line plus the fraction along the segment, and the value; ``across`` the ink, 1 on a line,
            0 on a halo.

        Raises
        ------
        EngineError
            After :meth:`release`, if the picture is too large, or if the style names no values of the points.
        TypeError
            If the style has no look.
        """
        if not isinstance(style, HaloStyle):
            raise TypeError(f"style is a {type(style).__name__}; lines and points with halos need a HaloStyle")
        vertices, blocks, shapes = self._alive()
        if self._target is not None and self._made == (view, style):
            return self._target.buffer
        self._made = None
        look = style.look
        reads = vertices.show_values(style.values)
        filtered = vertices.show_filter(look.filter_by)
        vertices.show_mask(look.n_tapered, look.t_tapered)
        with self._gl.framebuffers_kept():  # one of ours must not stay bound when it is released
            target = self._target_of(view.size, coloured=reads == "HALO_COLOURS")
            planes, beside = blocks.write(view, look, self._n)
            wanted = {
                "HALO_TAPER": look.n_tapered > 0 and not self._kind,
                "HALO_CUE": look.width_cue > 0.0,
                "HALO_FILTER": filtered,
                "HALO_BENT": look.displacement != "linear",
                "HALO_CUT": (beside or planes) and not self._kind,
                "CLIP_PLANES": planes,
            }
            features = [*self._kind, *(name for name, on in wanted.items() if on)]
            self._passes.begin()
            self._ctx.scissor = None
            vertices.bind()
            # Equal depths are drawn in the order of the data, which listing does not keep; halos that lie as deep as
            # their lines would then flicker.
            listing = self._listing if look.max_displacement > 0.0 else None
            self._listed = listing is not None
            with self._programs.noting() as noted:
                self._draw(target, shapes, listing, features)
                self._attributes(target, shapes, [*self._kind, *([reads] if reads else [])])
            self._features = sorted(noted)
        self._generation += 1
        target.buffer.generation = self._generation
        self._made = (view, style)
        return target.buffer

    def _target_of(self, size: tuple[int, int], *, coloured: bool) -> HitTarget:
        if self._target is None or (self._target.size, self._target.coloured) != (size, coloured):
            if self._target is not None:
                self._target.release()
                self._target = None
            self._target = HitTarget(self._ctx, self._gl, size, coloured, "ink")
        return self._target

    def _draw(self, target: HitTarget, shapes: PulledShapes, listing: Listing | None, features: list[str]) -> None:
        """Draw what the depth buffer keeps."""
        if listing is not None:
            listing.features = [name for name in features if name in ("HALO_POINTS", "HALO_CUE")]
            with self._passes.timed("last picture"):
                listing.before(target, target.hits)
        with self._passes.timed("clear"):
            target.clear()
            self._gl.clear_integers(target.hits_buffer, (EMPTY, 0), 0)
        if not self._n:
            return
        stages = {"vertex": f"halos/{self.pipeline}.vert", "fragment": "halos/halo.frag"}
        program = self._programs.render(stages, [*features, *(["HALO_LISTED"] if listing is not None else [])])

        def render(commands: moderngl.Buffer | None = None) -> None:
            target.hits_buffer.use()
            self._prepare(program)
            self._ctx.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
            self._ctx.front_face, self._ctx.cull_face = "ccw", "back"  # see shaders/halos/strips.vert
            self._ctx.depth_func = ">"  # depth is the other way round: see shaders/halos/halo.frag
            self._ctx.wireframe = False
            self._ctx.provoking_vertex = moderngl.LAST_VERTEX_CONVENTION
            if listing is None or commands is None:
                shapes.draw(program)
            else:
                listing.bind(program)
                shapes.draw_listed(program, commands)
            self._ctx.depth_func = "<="

        if listing is not None:
            listing.draw(target, self._passes, self._prepare_listing, render)
            return
        with self._passes.timed(self.pipeline):
            render()

    def _attributes(self, target: HitTarget, shapes: PulledShapes, features: list[str]) -> None:
        """Find all else of the pixels that show something."""
        with self._passes.timed("attributes"):
            stages = {"vertex": "screen/near.vert", "fragment": "halos/attributes.frag"}
            program = self._programs.render(stages, features)
            self._prepare(program)
            for name, texture, unit in (("hits", target.hits, HITS_UNIT), ("depths", target.depths, DEPTHS_UNIT)):
                texture.use(unit)
                program[name] = unit
            if "lines" in program and isinstance(self._drawn, HaloLines):
                program["lines"] = self._drawn.n_lines
            target.attributes.use()
            self._ctx.enable_only(moderngl.DEPTH_TEST)
            self._ctx.depth_func = "<"
            shapes.whole(program).render(moderngl.TRIANGLES, vertices=3)
            self._ctx.depth_func = "<="

    def _prepare(self, program: moderngl.Program | moderngl.ComputeShader) -> None:
        for sampler, unit in UNITS.items():
            self._gl.set_sampler(program, sampler, unit)

    def _prepare_listing(self, program: moderngl.ComputeShader) -> None:
        self._prepare(program)
        program["items"] = -(-self._n >> ITEM_SHIFT)

    def needs_outside(self, view: View, style: Style) -> bool:  # noqa: ARG002
        """Say that depths of other things would gain nothing."""
        return False

    def _alive(self) -> tuple[Vertices, HaloBlocks, PulledShapes]:
        if self._vertices is None or self._blocks is None or self._shapes is None:
            raise EngineError("this renderer has been released; make a new one")
        return self._vertices, self._blocks, self._shapes

    def explain(self, *, counts: bool = True) -> dict[str, Any]:  # noqa: ARG002
        """Say what the last redraw was made of, and wait for it to end.

        Returns
        -------
        dict
            ``passes`` (name, ms), ``features``, which are on in the programs that ran, ``buffers`` (name, bytes),
            ``points_total``, ``lines_total`` (0 of points), ``primitives`` (triangles without culling), ``culling``
            (as the last picture was drawn).
        """
        sizes: dict[str, int] = {}
        for holder in (self._vertices, self._blocks, self._shapes):
            if holder is not None:
                sizes |= {name: buffer.size for name, buffer in holder.buffers.items()}
        if self._listing is not None:
            sizes["culling"] = self._listing.nbytes
            sizes["occlusion"] = self._listing.pyramid_nbytes
        if self._target is not None:
            sizes["gbuffer"] = self._target.nbytes
        return {
            "passes": self._passes.report(),
            "features": list(self._features),
            "buffers": [{"name": name, "bytes": size} for name, size in sizes.items()],
            "points_total": self._drawn.n_points,
            "lines_total": self._drawn.n_lines if isinstance(self._drawn, HaloLines) else 0,
            "primitives": 0 if self._shapes is None else 2 * self._n,
            "culling": "two-phase" if self._listed else None,
        }

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for holder in (self._vertices, self._blocks, self._shapes, self._listing, self._target):
            if holder is not None:
                holder.release()
        self._vertices = self._blocks = self._shapes = self._listing = self._target = None
        self._programs.release()
        self._passes.release()
        self._made = None


def _flat(bounds: tuple[float, ...]) -> bool:
    """Say whether all is in one plane across an axis, where equal depths are the rule, and nothing is behind others."""
    extents = np.ptp(np.reshape(bounds, (3, 2)), axis=1)
    return bool(extents.min() <= 1e-6 * extents.max())
