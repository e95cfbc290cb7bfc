"""`TubeRenderer`: a set of spline tubes on one OpenGL context, drawn into a G-buffer when something changed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import moderngl

from ...tubes.curves import MIDDLE
from ..culling.listing import LEAST_SEGMENTS, Listing, supports_listing
from ..errors import EngineError
from ..gbuffer import GBuffer
from ..hit_target import HitTarget
from ..lattice import TOP
from ..opengl import OpenGL
from ..passes import Passes
from ..shaders import Programs
from ..view import View
from .eye_inside import Inside
from .nodes import UNITS, Nodes
from .options import AUTO, SOLVERS, TubeStyle, check_choices
from .proxy_geometry import Silhouettes
from .uniform_blocks import CONSTANTS, TubeBlocks

if TYPE_CHECKING:
    from ...tubes.spline_tubes import NodeValues, SplineTubes

__all__ = ["TubeRenderer"]

HITS_UNIT = 10


class TubeRenderer:
    """Draws one set of spline tubes.

    The context must be current in every call. The renderer binds what it needs and leaves it bound; the caller keeps
    its own OpenGL state.

    Parameters
    ----------
    ctx : moderngl.Context
        OpenGL 3.3 or later.
    tubes : SplineTubes
        Copied to the GPU here.
    silhouettes : str
        How segments cover pixels, of :data:`.SILHOUETTES`; ``'auto'`` takes the fastest.
    solver : str
        How roots are found, of :data:`.SOLVERS`; ``'auto'`` takes the fastest that is exact.
    iterations : int, optional
        Steps of one search for a root; the solver's own number by default.
    culling : {'two-phase', None}
        How segments behind others are found out, where rectangles, OpenGL 4.3 and many segments are there for
        it (:mod:`pvfiblets.engine.culling.listing`). It changes no pixel.
    middle : float
        Share c of a derivative between control points (``shaders/tubes/segment.glsl``); the paper has 1/3.
    discard : bool
        Throw every fragment away at once: what is left is the cost of the silhouettes, the hatched bars of the paper's
        figure 5.

    Attributes
    ----------
    pipeline : str
        The silhouettes in use.
    solver : str
        The one in use.
    iterations : int
    share : float
        1.0: all is drawn.

    Raises
    ------
    EngineError
        If memory does not suffice or numbers are too large; nothing stays behind on the GPU.
    ValueError
        If a choice is none.
    """

    share = 1.0

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
        self._ctx, self._tubes = ctx, tubes
        self._middle, self._discard = float(middle), discard
        self._gl = OpenGL(ctx)
        self._passes = Passes(ctx)
        self._programs = Programs(ctx, CONSTANTS)
        self._nodes: Nodes | None = None
        self._blocks: TubeBlocks | None = None
        self._silhouettes: Silhouettes | None = None
        self._visibility: Listing | None = None
        self._target: HitTarget | None = None
        self._drawn: tuple[View, TubeStyle] | None = None
        self._features: list[str] = []
        self._generation = 0
        try:
            self._nodes = Nodes(ctx, self._gl, tubes)
            self._blocks = TubeBlocks(ctx, (self._nodes.origin, self._nodes.scale, TOP), tubes.scaled)
            self._silhouettes = Silhouettes(ctx, self._programs, self.pipeline, tubes.n_segments)
            many = self.pipeline == "rectangles" and tubes.n_segments >= LEAST_SEGMENTS
            if culling is not None and many and supports_listing(ctx):
                self._visibility = Listing(
                    ctx, self._gl, self._programs, tubes.n_segments, cull="tubes/cull.comp", features=["TUBES"]
                )
        except BaseException:
            self.release()
            raise
        self._inside = Inside(tubes, self._middle)

    def render(
        self,
        view: View,
        style: TubeStyle | None = None,
        *,
        outside: moderngl.Texture | None = None,  # noqa: ARG002  as other renderers have it
    ) -> GBuffer:
        """Draw, unless the last picture was of the same view and style.

        Parameters
        ----------
        view : View
            Its region is not looked at.
        style : TubeStyle, optional
        outside : moderngl.Texture, optional
            Not looked at.

        Returns
        -------
        GBuffer
            The renderer's own; the same object until the size changes. ``owner`` holds segments, ``ids`` tubes and
            tangents, ``position`` the parameter in 0..1 of the segment and the value, ``across`` normals.

        Raises
        ------
        EngineError
            After :meth:`release`, if the picture is too large, or if ``style.values`` names no attribute.
        """
        style = style or TubeStyle()
        nodes, blocks, silhouettes = self._alive()
        if self._target is not None and self._drawn == (view, style):
            return self._target.buffer
        self._drawn = None
        shown = self._attribute(style)
        reads = nodes.show(shown)
        # One of our framebuffers must not stay bound when it is released.
        with self._gl.framebuffers_kept(), self._programs.noting() as features:
            target = self._draw(view, style, reads, nodes, blocks, silhouettes)
        self._features = sorted(features)
        self._generation += 1
        target.buffer.generation = self._generation
        self._drawn = (view, style)
        return target.buffer

    def _draw(
        self,
        view: View,
        style: TubeStyle,
        reads: str | None,
        nodes: Nodes,
        blocks: TubeBlocks,
        silhouettes: Silhouettes,
    ) -> HitTarget:
        """Draw all, whatever was drawn last."""
        coloured = reads == "TUBE_COLOURS"
        if self._target is None or self._target.size != view.size or self._target.coloured != coloured:
            if self._target is not None:
                self._target.release()
                self._target = None
            self._target = HitTarget(self._ctx, self._gl, view.size, coloured)
        target = self._target
        cut = blocks.write(
            view,
            reach=self._inside.reach,
            middle=self._middle,
            min_width=style.min_width,
            iterations=self.iterations,
            n_segments=self._tubes.n_segments,
        )
        hollow = self._inside.touched(view, style.min_width)
        common = ["TUBES", *(["CLIP_PLANES"] if cut else [])]
        rounds = self._rounds(common, cut=cut, hollow=hollow)
        self._passes.begin()
        self._ctx.scissor = None
        nodes.bind()
        if self._visibility is not None:
            with self._passes.timed("last picture"):
                self._visibility.before(target, target.buffer.owner)
        with self._passes.timed("clear"):
            target.clear()
        if self._visibility is not None:

            def render(commands: moderngl.Buffer) -> None:
                self._render(rounds, silhouettes, target, commands)

            self._visibility.draw(target, self._passes, self._prepare, render)
        elif self._tubes.n_segments:
            with self._passes.timed("tubes"):
                self._render(rounds, silhouettes, target)
        with self._passes.timed("attributes"):
            stages = {"vertex": "screen/near.vert", "fragment": "tubes/attributes.frag"}
            program = self._programs.render(stages, [*common, *([reads] if reads else [])])
            self._prepare(program)
            target.hits.use(HITS_UNIT)
            program["hits"] = HITS_UNIT
            target.attributes.use()
            self._ctx.enable_only(moderngl.DEPTH_TEST)
            self._ctx.depth_func = "<"
            silhouettes.whole(program).render(moderngl.TRIANGLES, vertices=3)
            self._ctx.depth_func = "<="
        return target

    def _render(
        self,
        rounds: list[tuple[list[str], int]],
        silhouettes: Silhouettes,
        target: HitTarget,
        commands: moderngl.Buffer | None = None,
    ) -> None:
        """Draw all segments, or those that are listed."""
        target.hits_buffer.use()
        for chosen, sides in rounds:
            program = silhouettes.program(chosen)
            self._prepare(program)
            if "drawn_sides" in program:
                program["drawn_sides"] = sides
            if commands is None or self._visibility is None:
                silhouettes.draw(program)
            else:
                self._visibility.bind(program)
                silhouettes.draw_listed(program, commands)

    def _rounds(self, common: list[str], *, cut: bool, hollow: bool) -> list[tuple[list[str], int]]:
        """Return features of each round, and which side of the planes it draws.

        What nothing cuts, seen from outside, is met in one loop. The rest needs where rays leave as well, and so the
        chain.
        """
        solving = SOLVERS[self.solver].feature
        wanted = {"TUBE_DISCARD": self._discard, "TUBE_LISTED": self._visibility is not None}
        common = [*common, *([solving] if solving else []), *(name for name, on in wanted.items() if on)]
        chained = [*common, "TUBE_CHAIN"]
        if hollow:
            return [([*chained, "TUBE_HOLLOW"], 3)]
        if solving is None:
            return [(chained, 3)]
        return [(common, 1), (chained, 2)] if cut else [(common, 3)]

    def _prepare(self, program: moderngl.Program | moderngl.ComputeShader) -> None:
        for sampler, unit in UNITS.items():
            self._gl.set_sampler(program, sampler, unit)

    def _attribute(self, style: TubeStyle) -> NodeValues | None:
        if style.values is None:
            return None
        known = self._tubes.values
        if isinstance(style.values, str) and style.values in known:
            return known[style.values]
        raise EngineError(f"no values {style.values!r} at the nodes of these spline tubes; there are {sorted(known)}")

    def needs_outside(self, view: View, style: TubeStyle) -> bool:  # noqa: ARG002
        """Say that depths of other things would gain nothing."""
        return False

    def _alive(self) -> tuple[Nodes, TubeBlocks, Silhouettes]:
        if self._nodes is None or self._blocks is None or self._silhouettes is None:
            raise EngineError("this renderer has been released; make a new one")
        return self._nodes, self._blocks, self._silhouettes

    def explain(self, *, counts: bool = True) -> dict[str, object]:  # noqa: ARG002
        """Say what the last redraw was made of, and wait for it to end.

        Returns
        -------
        dict
            ``passes`` (name, ms), ``features``, which are on in the programs that ran, ``buffers`` (name, bytes),
            ``tubes_total``, ``segments_total``, ``primitives`` (triangles without culling), ``culling``, ``solver``,
            ``iterations``.
        """
        sizes: dict[str, int] = {}
        for holder in (self._nodes, self._blocks, self._silhouettes):
            if holder is not None:
                sizes |= {name: buffer.size for name, buffer in holder.buffers.items()}
        if self._visibility is not None:
            sizes["culling"] = self._visibility.nbytes
            sizes["occlusion"] = self._visibility.pyramid_nbytes
        if self._target is not None:
            sizes["gbuffer"] = self._target.nbytes
        return {
            "passes": self._passes.report(),
            "features": list(self._features),
            "buffers": [{"name": name, "bytes": size} for name, size in sizes.items()],
            "tubes_total": int(self._tubes.n_tubes),
            "segments_total": int(self._tubes.n_segments),
            "primitives": 0 if self._silhouettes is None else self._silhouettes.primitives,
            "culling": None if self._visibility is None else "two-phase",
            "solver": self.solver,
            "iterations": self.iterations,
        }

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for holder in (self._nodes, self._blocks, self._silhouettes, self._visibility, self._target):
            if holder is not None:
                holder.release()
        self._nodes = self._blocks = self._silhouettes = self._visibility = self._target = None
        self._programs.release()
        self._passes.release()
        self._drawn = None
