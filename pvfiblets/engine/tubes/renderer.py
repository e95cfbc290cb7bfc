"""`TubeRenderer`: a set of spline tubes on one OpenGL context, drawn into a G-buffer when something changed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import moderngl

from ...tubes.curves import MIDDLE
from ..errors import EngineError
from ..gbuffer import GBuffer
from ..gl.bindings import TUBES
from ..hit_drawable import HitDrawable
from ..hit_target import HitTarget
from ..lattice import TOP
from ..regions.region_cut import RegionCut
from ..view import View
from .eye_inside import EyeInsideTest
from .nodes import Nodes
from .options import AUTO, SOLVERS, TubeStyle, check_choices
from .proxy_geometry import ProxyGeometry
from .uniform_blocks import TubeBlocks

if TYPE_CHECKING:
    from ...tubes.spline_tubes import NodeValues, SplineTubes


class TubeRenderer(HitDrawable[TubeStyle]):
    """Draws one set of spline tubes.

    In its `GBuffer` ``owner`` holds segments, ``ids`` tubes and tangents, ``position`` the parameter in 0..1 of the
    segment and the value, ``across`` normals. `explain` also says ``tubes_total``, ``segments_total``, ``primitives``
    (triangles without culling), ``culling``, ``solver`` and ``iterations``.

    `middle` is the share c of a derivative between control points (``shaders/tubes/segment.glsl``); the paper has 1/3.
    With `discard` every fragment goes at once: what is left is the cost of the silhouettes, the hatched bars of the
    paper's figure 5.
    """

    STYLE = TubeStyle
    SAMPLERS = TUBES

    def __init__(
        self,
        ctx: moderngl.Context,
        tubes: SplineTubes,
        *,
        silhouettes: str = AUTO,
        solver: str = AUTO,
        iterations: int | None = None,
        culling: str | None = "two-phase",
        middle: float = MIDDLE,
        discard: bool = False,
    ) -> None:
        check_choices(silhouettes, solver, iterations, culling=culling)
        self.pipeline = "rectangles" if silhouettes == AUTO else silhouettes
        self.solver = "illinois" if solver == AUTO else solver
        self.iterations = SOLVERS[self.solver].iterations if iterations is None else int(iterations)
        super().__init__(ctx, {})
        self._tubes, self._middle, self._discard = tubes, float(middle), discard
        with self._making():
            self._nodes = self._keep(Nodes(ctx, self._gl, tubes))
            place = self._nodes.origin, self._nodes.scale, TOP
            self._region = self._keep(RegionCut(ctx, self._gl, self._programs, place))
            self._blocks = self._keep(TubeBlocks(ctx, place, tubes.scaled))
            self._silhouettes = self._keep(ProxyGeometry(ctx, self._programs, self.pipeline, tubes.n_segments))
            listable = tubes.n_segments if self.pipeline == "rectangles" else 0
            self._make_listing(culling, listable, tubes.n_segments, cull="tubes/cull.comp", features=["TUBES"])
        self._inside = EyeInsideTest(tubes, self._middle)

    def _draw(self, view: View, style: TubeStyle, outside: moderngl.Texture | None) -> GBuffer:  # noqa: ARG002
        self._nodes.filter(self.filtering)
        reads = self._nodes.show(self._attribute(style))
        target = self._hit_target(view.size, coloured=reads == "TUBE_COLOURS", edges=style.edges)
        cut = self._blocks.write(
            view,
            reach=self._inside.reach,
            middle=self._middle,
            min_width=style.min_width,
            drawn_width=style.drawn_width,
            iterations=self.iterations,
            n_segments=self._tubes.n_segments,
        )
        hollow = self._inside.touched(view, style.drawn_width)
        region = self._region.update(view)
        common = ["TUBES", *(["CLIP_PLANES"] if cut else []), *region]
        rounds = self._rounds(common, cut=cut, whole=not (hollow or region), hollow=hollow)
        self._nodes.bind()
        self._draw_hits(
            target,
            lambda commands: self._render(rounds, target, commands),
            name="tubes",
            n_items=self._tubes.n_segments,
            shown=target.buffer.owner,
            listing=self._listing,
        )
        features = [*common, *([reads] if reads else []), *(["EDGES"] if style.edges else [])]
        hits = [("hits", target.hits, TUBES["hits"])]
        if region:
            hits.append(("depths", target.depths, TUBES["depths"]))
        self._find_attributes(target, "tubes/attributes.frag", features, self._silhouettes.whole, hits)
        return target.buffer

    def _render(self, rounds: list[tuple[list[str], int]], target: HitTarget, commands: moderngl.Buffer | None) -> None:
        """Draw all segments, or the listed ones."""
        target.hits_buffer.use()
        for chosen, sides in rounds:
            program = self._silhouettes.program(chosen)
            self._prepare(program)
            if "drawn_sides" in program:
                program["drawn_sides"] = sides
            if commands is None or self._listing is None:
                self._silhouettes.draw(program)
            else:
                self._listing.bind(program)
                self._silhouettes.draw_listed(program, commands)

    def _rounds(self, common: list[str], *, cut: bool, whole: bool, hollow: bool) -> list[tuple[list[str], int]]:
        """Return features of each round, and which side of the planes it draws."""
        # What nothing cuts, seen from outside, is met in one loop. The rest needs where rays leave as well, and so the
        # chain.
        solving = SOLVERS[self.solver].feature
        wanted = {"TUBE_DISCARD": self._discard, "TUBE_LISTED": self._listing is not None}
        common = [*common, *([solving] if solving else []), *(name for name, on in wanted.items() if on)]
        chained = [*common, "TUBE_CHAIN"]
        if hollow:
            return [([*chained, "TUBE_HOLLOW"], 3)]
        if solving is None or not whole:
            return [(chained, 3)]
        return [(common, 1), (chained, 2)] if cut else [(common, 3)]

    def _attribute(self, style: TubeStyle) -> NodeValues | None:
        if style.values is None:
            return None
        known = self._tubes.values
        if isinstance(style.values, str) and style.values in known:
            return known[style.values]
        raise EngineError(f"no values {style.values!r} at the nodes of these spline tubes; there are {sorted(known)}")

    def _facts(self, *, counts: bool) -> dict[str, Any]:  # noqa: ARG002
        return {
            "tubes_total": int(self._tubes.n_tubes),
            "segments_total": int(self._tubes.n_segments),
            "primitives": self._silhouettes.primitives,
            "culling": None if self._listing is None else "two-phase",
            "solver": self.solver,
            "iterations": self.iterations,
        }
