"""`HaloRenderer`: lines or points with halos on one OpenGL context, drawn into a G-buffer when something changed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np

from ...halos.geometry import HaloLines, HaloPoints
from ..gbuffer import EMPTY, GBuffer
from ..gl.bindings import HALOS
from ..gl.vertex_pulling import PulledShapes
from ..hit_drawable import HitDrawable
from ..hit_target import HitTarget
from ..lattice import TOP
from ..regions.region_cut import RegionCut
from ..view import Style, View
from .uniform_blocks import CONSTANTS, ITEM_SHIFT, HaloBlocks
from .vertices import Vertices

if TYPE_CHECKING:
    from ...halos.style import HaloStyle
    from ..culling.two_phase_items import Listing


@dataclass(frozen=True)
class HaloDrawStyle(Style):
    """How lines or points with halos become pixels."""

    look: HaloStyle = field(kw_only=True)

    @property
    def half_width(self) -> float:
        """Pixels that a line reaches to either side of its axis at least."""
        return self.drawn_width / 2.0

    @property
    def drawn_width(self) -> float:
        """Pixels that a line is drawn with at least: all of one, where edges say how much of it is line."""
        return max(self.look.min_width, 1.0) if self.edges and not self.exact else self.look.min_width

    @property
    def reach(self) -> float:
        """Millimetres from the axis to the edge of a strip."""
        return 0.5 * self.look.strip_width

    @property
    def relief(self) -> str:
        """How much of a pixel is line."""
        return "ink"


class HaloRenderer(HitDrawable[HaloDrawStyle]):
    """Draws one set of lines or points with halos.

    In its `GBuffer` ``owner`` holds segments, each by its first point, or points, and nothing where a halo shows;
    ``ids`` lines, or points, and tangents; ``position`` the point's index within its line plus the fraction along the
    segment, and the value; ``across`` the ink, 1 on a line, 0 on a halo. `explain` also says ``points_total``,
    ``lines_total`` (0 of points), ``primitives`` (triangles without culling) and ``culling`` (as the last picture was
    drawn).

    Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009), section 3.
    """

    STYLE = HaloDrawStyle
    SAMPLERS = HALOS
    RELIEF = "ink"
    EDGES = "hits"

    def __init__(
        self, ctx: moderngl.Context, drawn: HaloLines | HaloPoints, *, culling: str | None = "two-phase"
    ) -> None:
        self._check_culling(culling)
        super().__init__(ctx, CONSTANTS)
        self._drawn = drawn
        points = isinstance(drawn, HaloPoints)
        self.pipeline = "discs" if points else "strips"
        self._kind = ["HALO_POINTS"] if points else []
        with self._making():
            self._vertices = self._keep(Vertices(ctx, self._gl, drawn))
            place = self._vertices.origin, self._vertices.scale, TOP
            self._region = self._keep(RegionCut(ctx, self._gl, self._programs, place))
            self._blocks = self._keep(HaloBlocks(ctx, self._vertices.origin, self._vertices.scale, drawn.bounds))
            self._n = self._vertices.n_items
            # Lists have whole items; entries beyond the last quad draw nothing.
            self._shapes = self._keep(PulledShapes(ctx, self._n_lists << ITEM_SHIFT))
            listable = 0 if _flat(drawn.bounds) else self._n
            self._make_listing(culling, listable, self._n_lists, cull="halos/cull.comp", shift=ITEM_SHIFT)

    @property
    def _n_lists(self) -> int:
        """Items of a list, of several quads each."""
        return -(-self._n >> ITEM_SHIFT)

    def _draw(self, view: View, style: HaloDrawStyle, outside: moderngl.Texture | None) -> GBuffer:  # noqa: ARG002
        look, vertices = style.look, self._vertices
        if style.edges:  # what smooths all edges smooths these
            look = replace(look, smooth=False)
        reads = vertices.show_values(style.values)
        filtered = vertices.show_filter(look.filter_by)
        vertices.show_mask(look.n_tapered, look.t_tapered, self.filtering)
        target = self._hit_target(view.size, coloured=reads == "HALO_COLOURS", edges=style.edges)
        reference = self._drawn.value_reference(look.filter_by)
        region = self._region.update(view)
        planes, beside = self._blocks.write(view, look, self._n, style.drawn_width, reference)
        wanted = {
            "HALO_TAPER": look.n_tapered > 0 and not self._kind,
            "HALO_CUE": look.width_cue > 0.0,
            "HALO_FILTER": filtered,
            "HALO_BENT": look.displacement != "linear",
            "HALO_CUT": (beside or planes) and not self._kind,
            "HALO_SOME": bool(self._kind) and self.filtering is not None,
            "CLIP_PLANES": planes,
            "CLIP_REGION": bool(region),
            "EDGES": style.edges,
        }
        features = [*self._kind, *(name for name, on in wanted.items() if on)]
        vertices.bind()
        # Equal depths are drawn in the order of the data, which listing does not keep; halos that lie as deep as
        # their lines would then flicker.
        listing = self._listing if look.max_displacement > 0.0 else None
        if listing is not None:
            listing.features = [name for name in features if name in ("HALO_POINTS", "HALO_CUE")]
        stages = {"vertex": f"halos/{self.pipeline}.vert", "fragment": "halos/halo.frag"}
        self._draw_hits(
            target,
            lambda commands: self._render(
                self._programs.render(stages, [*features, *(["HALO_LISTED"] if listing is not None else [])]),
                target,
                listing,
                commands,
            ),
            name=self.pipeline,
            n_items=self._n,
            shown=target.hits,
            listing=listing,
            cleared=(EMPTY, 0),
        )
        self._find_attributes(
            target,
            "halos/attributes.frag",
            [*self._kind, *([reads] if reads else [])],
            self._shapes.whole,
            [("hits", target.hits, HALOS["hits"]), ("depths", target.depths, HALOS["depths"])],
            lines=self._n_lines,
        )
        return target.buffer

    def _render(
        self, program: moderngl.Program, target: HitTarget, listing: Listing | None, commands: moderngl.Buffer | None
    ) -> None:
        """Draw all quads, or the listed ones."""
        target.hits_buffer.use()
        self._prepare(program)
        self._ctx.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self._ctx.front_face, self._ctx.cull_face = "ccw", "back"  # see shaders/halos/strips.vert
        self._ctx.depth_func = ">"  # depth is the other way round: see shaders/halos/halo.frag
        self._ctx.wireframe = False
        self._ctx.provoking_vertex = moderngl.LAST_VERTEX_CONVENTION
        if listing is None or commands is None:
            self._shapes.draw(program)
        else:
            listing.bind(program)
            self._shapes.draw_listed(program, commands)
        self._ctx.depth_func = "<="

    def _prepare_listing(self, program: moderngl.ComputeShader) -> None:
        super()._prepare_listing(program)
        program["items"] = self._n_lists

    @property
    def _n_lines(self) -> int:
        return self._drawn.n_lines if isinstance(self._drawn, HaloLines) else 0

    def _facts(self, *, counts: bool) -> dict[str, Any]:  # noqa: ARG002
        return {
            "points_total": self._drawn.n_points,
            "lines_total": self._n_lines,
            "primitives": 2 * self._n,
            "culling": "two-phase" if self._listed else None,
        }


def _flat(bounds: tuple[float, ...]) -> bool:
    """Say whether all is in one plane across an axis, where equal depths are the rule, and nothing is behind others."""
    extents = np.ptp(np.reshape(bounds, (3, 2)), axis=1)
    return bool(extents.min() <= 1e-6 * extents.max())
