"""`FibletRenderer`: a fiblet set on one OpenGL context, drawn into a G-buffer when something changed."""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Generator, Hashable, Iterator
from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import moderngl

from ..culling import Occlusion, make_occlusion
from ..culling.choice import FEW_FIBLETS, CullingChoice
from ..drawable import Drawable
from ..errors import EngineError
from ..frame import local_frame
from ..gbuffer import GBuffer
from ..gl.capabilities import check_choices, choose
from ..gl.passes import is_software
from ..gl.picture_clock import CallClock, TimestampClock
from ..pieces import Pieces, finish
from ..view import Style, View
from .census import Census, count_fiblets, no_counts
from .data import chunks
from .data.chunks import Chunk
from .data.filter_textures import Filter
from .data.memory_fit import MemoryBudget
from .data.point_values import ValueSources
from .data.uniform_blocks import SharedBlocks, decoding_features
from .data.upload import release_chunks, upload_fitting
from .fiblet_drawable import has_layers
from .gather.lines_behind import LinesBehind
from .pipelines import CONSTANTS, ComputePipeline, DrawRequest, Limits, Pipeline, make_measurer, make_pipeline
from .pipelines.limits import MESH
from .style import FibletStyle
from .visibility import Visibility

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ...codec.fibletset import FibletSet
    from ...query.regions.region import Region
    from ...query.selection.point_flags import Sampling
    from .data.sampled_volume import VolumeSource
    from .region_query import RegionQuery
    from .sample_layers import Rectangle, SampledLines


class _Picture(NamedTuple):
    """The last picture of one of several views."""

    target: GBuffer
    buffer: GBuffer | None  # the target once it is finished
    made: tuple[View, Style] | None
    last: tuple[View, FibletStyle] | None


class FibletRenderer(LinesBehind):
    """Draws one fiblet set.

    What others in the scene hide may be missing from a picture for which their depth was given: two-phase culling
    looks at it.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        fiblets: FibletSet,  # copied to the GPU here; not kept in memory otherwise
        *,
        # `'auto'` takes the fastest that the context has; see `pvfiblets.engine.gl.capabilities.pipelines`
        pipeline: str = "auto",
        # how fiblets behind others are found out. `'two-phase'` changes no pixel of the picture; `'auto'` is two-phase
        # where pictures are measured to take less time by it, and none elsewhere (`pvfiblets.engine.culling.choice`);
        # `'coverage'` is that of the paper (Schertzer et al. 2022, section 3.4), which may lose some for one frame
        # after the camera jumped; `None` draws all that is in the view volume.
        culling: str | None = "two-phase",
        # what to do where memory does not suffice: refuse, or draw an even share of the streamlines, always the same
        # one (`pvfiblets.engine.fiblets.data.memory_fit`)
        fit: str | None = None,
        progress: bool = False,  # show a progress bar while copying
        # limits below the driver's own: bytes of one buffer of records, work groups along one axis, bytes of all
        # buffers
        max_buffer_bytes: int | None = None,
        max_groups: int | None = None,
        max_total_bytes: int | None = None,
        lender: Drawable[Any] | None = None,  # as of `pvfiblets.engine.drawable.Drawable`
        # what filters speak of, where `fiblets` are some of its streamlines (`pvfiblets.codec.editing.restrict`)
        whole: FibletSet | None = None,
        alike: int | None = None,  # fiblets of a set whose pictures those of this part of it shall equal in every bit
        most: float = 1.0,  # with `fit='sample'`: draw no larger share of the streamlines, whatever would fit
    ) -> None:
        pipeline = choose(ctx, pipeline)
        check_choices(fit=fit)
        if fit == "stream":
            raise ValueError("one renderer holds all that it draws; streamed_renderer() makes one that fetches parts")
        super().__init__(ctx, CONSTANTS, lender)
        self.pipeline = pipeline
        self._alike = alike
        self._fiblets = fiblets
        self._chunks: list[Chunk] = []
        self._last: tuple[View, FibletStyle] | None = None
        self._counted: tuple[GBuffer, View, FibletStyle] | None = None  # drawn last, in whatever place
        self._place: Hashable = None
        self._places: OrderedDict[Hashable, _Picture] = OrderedDict()  # of all others, the least lately drawn first
        self._room = 0
        self._known_times: dict[str, tuple[float, int]] = {}
        self._query: RegionQuery | None = None
        self._choice: CullingChoice | None = None
        limits = Limits.from_context(ctx, self._gl, pipeline, max_buffer_bytes, max_groups)
        two_phase = pipeline in ("compute", *MESH) and culling in ("two-phase", "auto")
        self._limits = limits = replace(limits, clustered=two_phase and fiblets.n_fiblets >= chunks.CLUSTERED)
        with self._making():
            whole = fiblets if whole is None else whole
            room = MemoryBudget.from_context(ctx, self._gl, limits, max_total_bytes)
            fitted = upload_fitting(ctx, fiblets, room, fit, self._chunks, progress, most)
            self._fiblets = fiblets = fitted.fitting_set()
            self.share = fitted.share
            self._shared = self._keep(SharedBlocks(ctx, fiblets))
            place = self._shared.place
            self._kept = self._keep(Visibility(ctx, self._gl, self._programs, whole, fiblets, self._chunks, place))
            if culling == "auto" and fiblets.n_fiblets < FEW_FIBLETS:
                culling = None
            self._culling = make_occlusion(culling, ctx, self._gl, self._programs, fiblets)
            self._occlusion = self._culling
            if self._culling is not None:
                self._keep(self._culling, "occlusion")
            if culling == "auto":
                self._choice = self._make_choice()
            self._pipeline = self._keep(self._make_pipeline())
            self._whole, self._max_groups = whole, limits.groups
            self._census = Census(ctx, self._gl, self._programs, limits.groups)
            measurer = make_measurer(pipeline, ctx, self._gl, self._programs, limits)
            forget = self._shared.forget_camera
            self._values = ValueSources(ctx, measurer, fiblets, self._chunks, forget, limits.buffer_bytes)
            self._keep(self._values)

    def switch_to(self, place: Hashable, room: int) -> None:
        """Draw for another view of the window. All keep their last pictures, of ``room`` pixels together at most."""
        # The least lately drawn are given back first, and all where there is no room; an unfinished one is left.
        if place != self._place:
            if "gbuffer" in self._targets:
                target: Any = self._targets.pop("gbuffer")[1]
                self._places[self._place] = _Picture(target, self._buffer, self._made, self._last)
            self._outdate()
            self._place, self._buffer, self._last = place, None, None
            held = self._places.pop(place, None)
            if held is not None:
                self._targets["gbuffer"] = held.target.size, held.target
                self._buffer, self._made, self._last = held.buffer, held.made, held.last
        self._room = max(room, self._room) if room else 0  # windows shrink while a camera moves
        if not room:
            self._forget_places()

    def _make_room(self, size: tuple[int, int]) -> None:
        while self._places:
            sizes = size, *(held.target.size for held in self._places.values())
            if sum(map(math.prod, sizes)) <= self._room:
                break
            self._forget_oldest()

    def _forget_places(self) -> None:
        while self._places:
            self._forget_oldest()

    def _forget_oldest(self) -> None:
        target = self._places.popitem(last=False)[1].target
        if self._counted is not None and self._counted[0] is target:
            self._counted = None
        target.release()

    def _draw(self, view: View, style: FibletStyle, outside: moderngl.Texture | None) -> GBuffer:
        return finish(self._steps(view, style, outside, in_pieces=False))

    def _steps(
        self, view: View, style: FibletStyle, outside: moderngl.Texture | None, *, in_pieces: bool
    ) -> Generator[None, None, GBuffer]:
        """Draw; yield after each piece, or not at all."""
        self._counted = None
        self._make_room(view.size)
        target = self._fitting("gbuffer", view.size, lambda: GBuffer(self._ctx, view.size))
        try:
            target.want_relief(self._ctx, style.relief)
            target.want_edges(self._ctx, style.edges)
        except EngineError:
            self._drop_target("gbuffer")  # its textures are given back
            raise
        if self._choice is not None:
            key = view.size, style, len(view.clip_planes), view.region is None, outside is None
            self._occlusion = self._culling if self._choice.next(key) else None
        with nullcontext() if self._choice is None else self._choice.drawing():
            request = self._request(view, style, target)
            if self._occlusion is not None:
                self._occlusion.outside = outside
                with self._passes.timed("last picture") if target.generation else nullcontext():
                    self._occlusion.before(target, view, style)
            if in_pieces and isinstance(self._pipeline, ComputePipeline):
                again = partial(self._request, view, style, target)
                yield from self._pipeline.steps(request, Pieces(self._passes, again, self._known_times))
            else:
                self._pipeline.draw(request)
            if self._occlusion is not None:
                self._occlusion.after(target, view, style)
        self._features_behind = frozenset()
        self._last, self._counted = (view, style), (target, view, style)
        return target

    def _pieces(self, view: View, style: FibletStyle) -> Generator[None, None, GBuffer] | None:
        # A coverage buffer hides by the picture before, which must have been finished.
        whole = self._occlusion is not None and not self._occlusion.halfway
        if not self._works_at_once or style.radius is not None or whole:
            return None
        return self._steps(view, style, None, in_pieces=True)

    def _give_up(self) -> None:
        self._last = None
        if self._choice is not None:
            self._choice.start_over()

    def _make_choice(self) -> CullingChoice:
        return CullingChoice(CallClock(self._passes.clock) if self._works_at_once else TimestampClock(self._gl))

    @property
    def _works_at_once(self) -> bool:
        """Whether work is done when a call returns, as compute work of software OpenGL is: timestamps do not tell."""
        return self.pipeline == "compute" and is_software(self._ctx)

    def _make_stage(self) -> tuple[Pipeline, Occlusion | None]:
        # The coverage buffer is made of the nearest lines alone, and loses some for a frame.
        culling = None if self._culling is None else "two-phase"
        occlusion = make_occlusion(culling, self._ctx, self._gl, self._programs, self._fiblets)
        return self._make_pipeline(), occlusion

    def _make_pipeline(self) -> Pipeline:
        return make_pipeline(
            self.pipeline,
            self._ctx,
            self._gl,
            self._programs,
            [chunk.n_fiblets for chunk in self._chunks],
            self._limits,
            self._alike,
        )

    def _request(self, view: View, style: FibletStyle, target: GBuffer) -> DrawRequest:
        """Bring everything up to date that a view and a style need, bind it, and say what is to be drawn."""
        values, kept, shared = self._values, self._kept, self._shared
        shared.bind()
        decoding = self._decoding_features()
        source = values.activate(style.values, decoding)
        clipping, planes = shared.write_camera(view, style)
        kept.update(view)
        values.locate(local_frame(view, *shared.place)[1])
        return DrawRequest(
            chunks=self._chunks,
            target=target,
            passes=self._passes,
            decoding=tuple(decoding),
            values=source,
            clipping=clipping or planes or bool(kept.cutting),
            planes=("CLIP_PLANES",) if planes else (),
            detail=("LEVEL_OF_DETAIL",) if style.tolerance > 0.0 else (),
            line_width=0.0 if style.radius is not None else 2.0 * style.half_width,
            segment=shared.segment,
            occlusion=self._occlusion,
            kept=kept,
            tubes=("TUBES",) if style.radius is not None else (),
            ends=_ends(style),
            across=("CROSS_LINE",) if style.relief is not None else (),
            edges=("EDGES",) if style.edges and not style.exact else (),  # nobody reads those of a sample
        )

    def needs_outside(self, view: View, style: Style) -> bool:
        """Say whether :meth:`render` would gain from the depth of other things in the scene."""
        # Only where the camera has just moved: the second picture of a view is drawn whole, to be used from then on.
        two_phase = self._occlusion is not None and self._occlusion.halfway
        return two_phase and self._last != (view, style)

    def layers_samples(self, view: View, style: FibletStyle) -> bool:
        """See :meth:`.FibletDrawable.layers_samples`."""
        return has_layers(view, style) and isinstance(self._pipeline, ComputePipeline)

    def sampled(self, view: View, style: FibletStyle, rectangle: Rectangle) -> list[SampledLines]:
        """See :meth:`.FibletDrawable.sampled`."""
        from .sample_layers import SampledLines

        self._check_alive()
        return [SampledLines(view, style, rectangle, self._draw_samples)]

    def _draw_samples(self, view: View, style: FibletStyle, target: GBuffer, adds: bool) -> Iterator[None]:
        from .sample_layers import draw_samples

        assert isinstance(self._pipeline, ComputePipeline)
        culled = self._occlusion is not None and self._occlusion.halfway
        pyramid = make_occlusion("two-phase" if culled else None, self._ctx, self._gl, self._programs, self._fiblets)
        try:
            if pyramid is not None:
                pyramid.before(target, view, style)
            request = replace(self._request(view, style, target), occlusion=pyramid, adds=adds)
            draw_samples(self._ctx, self._pipeline, request)
        finally:
            if pyramid is not None:
                pyramid.release()
        yield from ()

    def value_range(self, values: str | VolumeSource) -> tuple[float, float]:
        """Return the range of a per-point value: of an array that of its codes, of a volume that of finite voxels."""
        self._check_alive()
        self._shared.bind()
        return self._values.range(values, self._decoding_features())

    @property
    def filtering(self) -> Filter | None:
        """What is there to be drawn; None for everything. Setting it takes effect with the next picture."""
        self._check_alive()
        return self._kept.filtering

    @filtering.setter
    def filtering(self, wanted: Filter | None) -> None:
        self._check_alive()
        self._outdate()  # also by one that fails, as everything is there again
        self._forget_places()
        if self._occlusion is not None:
            self._occlusion.forget()
        self._kept.filtering = wanted

    def query(self, region: Region, sampling: Sampling = "lines") -> npt.NDArray[np.uint8]:
        """Return how each streamline of the set lies to a region, whatever is filtered or drawn."""
        # On the GPU where it can (`.RegionQuery.available`), and equal to `.region_flags` on the CPU.
        from .region_query import RegionQuery

        self._check_alive()
        if self._query is None:
            query = RegionQuery(self._ctx, self._gl, self._programs, self._whole, self._chunks, self._max_groups)
            self._query = self._keep(query, "query")
        self._shared.bind()
        found = self._query.flags(self._decoding_features(), region, sampling)
        self._shared.bind()
        return found

    def _decoding_features(self) -> list[str]:
        return decoding_features(self._fiblets, self._chunks)

    def _facts(self, *, counts: bool) -> dict[str, Any]:
        total = int(self._fiblets.n_fiblets)
        found = self._count(total) if counts else no_counts(total)
        return {"fiblets_total": total, "fiblets": found, "share": self.share}

    def _sizes(self) -> dict[str, int]:
        sizes = super()._sizes()
        if self._places:
            sizes["gbuffer"] = sizes.get("gbuffer", 0) + sum(held.target.nbytes for held in self._places.values())
        for chunk in self._chunks:
            for name, buffer in chunk.buffers.items():
                sizes[name] = sizes.get(name, 0) + buffer.size
        return sizes

    def _count(self, total: int) -> dict[str, int | None]:
        """Count fiblets of the last picture."""
        if self._counted is None:
            return no_counts(total)
        buffer, view, style = self._counted
        self._shared.bind()
        _, planes = self._shared.write_camera(view, style)
        features = [*self._decoding_features(), *(["CLIP_PLANES"] if planes else []), *_ends(style)]
        culled = self._occlusion is not None
        return count_fiblets(
            self._census, total, self._chunks, features, self._pipeline, buffer, self._kept, culled
        )

    def release(self) -> None:
        """Give back everything on the GPU; twice is harmless."""
        release_chunks(self._chunks)
        self._forget_places()
        if self._choice is not None:
            self._choice.release()
        super().release()
        self._query = None


def _ends(style: FibletStyle) -> tuple[str, ...]:
    return ("LINE_ENDS",) if style.ends else ()
