"""`FibletRenderer`: a fiblet set on one OpenGL context, drawn into a G-buffer when something changed."""

from __future__ import annotations

from contextlib import nullcontext
from typing import TYPE_CHECKING

import moderngl
import numpy as np
import numpy.typing as npt
from tqdm import tqdm

from ..codec import layout, tables
from .capabilities import check_choices, choose
from .census import Census
from .chunks import Chunk
from .clipping import BLOCK_BYTES, clip_planes_block
from .culling import Occlusion, make_occlusion
from .errors import EngineError, GPUMemoryError
from .filtering import Filter
from .fit import Fitted, Room
from .frame import FRAME_BYTES, frame_block, local_frame, segment_pixels
from .gbuffer import GBuffer
from .kept import Kept
from .layers import LayeredBuffer, Layers
from .opengl import OpenGL
from .passes import Passes
from .pipelines import CONSTANTS, Job, Limits, Pipeline, make_measurer, make_pipeline
from .reporting import buffer_sizes, count_fiblets, no_counts
from .shaders import BLOCKS, Programs
from .tubes import TUBES_BYTES, tubes_block
from .upload import upload_chunk
from .values import ValueSources
from .view import Style, View

if TYPE_CHECKING:
    from ..codec.fibletset import FibletSet
    from ..codec.query.region import Region
    from .querying import RegionQuery
    from .volumes import VolumeSource

__all__ = ["FibletRenderer"]


class FibletRenderer:
    """Draws one fiblet set.

    The context must be current in every call. The renderer binds what it needs and leaves it bound; the caller keeps
    its own OpenGL state.

    Parameters
    ----------
    ctx : moderngl.Context
        OpenGL 3.3 or later.
    fiblets : FibletSet
        Copied to the GPU here; not kept in memory otherwise.
    pipeline : str
        ``'auto'`` takes the fastest that the context has; see :func:`pvfiblets.engine.capabilities.pipelines`.
    culling : {'two-phase', 'coverage', None}
        How fiblets behind others are found out. ``'two-phase'`` (also ``'auto'``) changes no pixel of the picture;
        ``'coverage'`` is that of the paper (Schertzer et al. 2022, section 3.4), which may lose some for one frame
        after the camera jumped; ``None`` draws all that is in the view volume.
    fit : {None, 'sample'}
        What to do where memory does not suffice: refuse, or draw an even share of the streamlines, always the same one
        (:mod:`pvfiblets.engine.fit`).
    progress : bool
        Show a progress bar while copying.
    max_buffer_bytes, max_groups, max_total_bytes : int, optional
        Limits below the driver's own: bytes of one buffer of records, work groups along one axis, bytes of all buffers.

    Attributes
    ----------
    pipeline : str
        The one in use.
    share : float
        How many of the streamlines that have points are drawn: 1.0 but for ``fit='sample'``.

    Raises
    ------
    EngineError
        If OpenGL is older than the pipeline, or memory does not suffice, as far as can be known before anything is
        allocated; nothing stays behind on the GPU.
    ValueError
        If there is no pipeline or fit of that name.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        fiblets: FibletSet,
        *,
        pipeline: str = "auto",
        culling: str | None = "two-phase",
        fit: str | None = None,
        progress: bool = False,
        max_buffer_bytes: int | None = None,
        max_groups: int | None = None,
        max_total_bytes: int | None = None,
    ) -> None:
        pipeline = choose(ctx, pipeline)
        check_choices(fit=fit)
        self.pipeline = pipeline
        self._ctx = ctx
        self._fiblets = fiblets
        self._chunks: list[Chunk] = []
        self._buffers: dict[str, moderngl.Buffer] = {}
        self._gl = OpenGL(ctx)
        self._occlusion: Occlusion | None = None
        self._pipeline: Pipeline | None = None
        self._target: GBuffer | None = None
        self._drawn: tuple[View, Style] | None = None
        self._last: tuple[View, Style] | None = None
        self._passes = Passes(ctx)
        self._programs = Programs(ctx, CONSTANTS)
        self._generation = 0
        self._segment = 0.0
        self._features: list[str] = []
        self._values: ValueSources | None = None
        self._kept: Kept | None = None
        self._layers: Layers | None = None
        self._query: RegionQuery | None = None
        self._top = 2**32 - 1 if fiblets.anchors_low is not None else 2**16 - 1
        self._limits = limits = Limits.of(ctx, self._gl, pipeline, max_buffer_bytes, max_groups)
        try:
            whole = fiblets
            fitted = self._upload(Room.of(ctx, self._gl, limits, max_total_bytes), fit, progress)
            self._fiblets = fiblets = fitted.kept()
            self.share = fitted.share
            self._make_shared()
            self._kept = Kept(ctx, self._gl, self._programs, whole, fiblets, self._chunks)
            self._occlusion = make_occlusion(culling, ctx, self._gl, self._programs, fiblets)
            self._pipeline = self._make_pipeline()
            self._whole, self._max_groups = whole, limits.groups
            self._census = Census(ctx, self._gl, self._programs, limits.groups)
            measurer = make_measurer(pipeline, ctx, self._gl, self._programs, limits)
            self._values = ValueSources(ctx, measurer, fiblets, self._chunks, self._forget_camera)
        except BaseException:
            self.release()
            raise

    def _upload(self, room: Room, fit: str | None, progress: bool) -> Fitted:
        """Copy what fits."""
        fitted = room.fitted(self._fiblets, fit)
        while True:
            needed = sum(plan.nbytes for plan in fitted.plans)
            try:
                with tqdm(total=needed, unit="B", unit_scale=True, desc="to the GPU", disable=not progress) as bar:
                    for plan in fitted.plans:
                        self._chunks.append(upload_chunk(self._ctx, fitted.fiblets, plan, bar.update))
            except GPUMemoryError:
                if fit != "sample":
                    raise
            else:
                return fitted
            # A driver that did not say how much memory is free says now that it was less.
            self._release_chunks()
            fitted = room.fitted(self._fiblets, fit, fitted.share / 2.0)

    def _make_shared(self) -> None:
        """Make the uniform blocks that all chunks share."""
        fiblets = self._fiblets
        self._buffers["rotations"] = self._ctx.buffer(np.ascontiguousarray(tables.packed(), "<u4").tobytes())
        coding = np.zeros((6, 4), "<f4")
        coding[0] = *fiblets.anchor_scale, fiblets.reach_scale
        coding[1] = fiblets.step_lo, fiblets.step_hi - fiblets.step_lo, fiblets.lattice, fiblets.parameters.end_scale
        coding[2:] = tables.packed_scales().reshape(4, 4)
        self._buffers["coding"] = self._ctx.buffer(coding.tobytes())
        self._buffers["frame"] = self._ctx.buffer(bytes(FRAME_BYTES))

    def render(
        self, view: View, style: Style | None = None, *, outside: moderngl.Texture | None = None
    ) -> GBuffer:
        """Draw, unless the last picture was of the same view and style.

        Parameters
        ----------
        view : View
        style : Style, optional
        outside : moderngl.Texture, optional
            Depth of other things in the scene, r32ui keys as in the G-buffer, of the view's size. What they hide may be
            missing from the picture, which therefore serves this one call only: the next one draws anew. Two-phase
            culling alone looks at it.

        Returns
        -------
        GBuffer
            The renderer's own; the same object until the size changes.

        Raises
        ------
        EngineError
            After :meth:`release`, if the picture is too large, or if ``style.values`` names no array.
        """
        style = style or Style()
        pipeline = self._alive()[0]
        if self._target is not None and self._drawn == (view, style):
            return self._target
        self._drawn = None
        if self._target is None or self._target.size != view.size:
            if self._target is not None:
                self._target.release()
                self._target = None
            self._target = GBuffer(self._ctx, view.size)
        self._target.want_relief(self._ctx, style.relief)
        job = self._job(view, style, self._target)
        self._features = job.features
        self._passes.begin()
        if self._occlusion is not None:
            self._occlusion.outside = outside
            with self._passes.timed("last picture") if self._target.generation else nullcontext():
                self._occlusion.before(self._target, view, style)
        pipeline.draw(job)
        if self._occlusion is not None:
            self._occlusion.after(self._target, view, style)
        self._generation += 1
        self._target.generation = self._generation
        if outside is None:
            self._drawn = (view, style)
        self._last = (view, style)
        return self._target

    def render_layers(self, view: View, style: Style | None = None, count: int = 4) -> LayeredBuffer:
        """Draw what lies behind the nearest too; nothing is done that has been done for this view and style.

        Parameters
        ----------
        view : View
        style : Style, optional
        count : int
            Layers, the picture of :meth:`render` included.

        Returns
        -------
        LayeredBuffer
            The renderer's own (:mod:`pvfiblets.engine.layers`); the same object until the size changes.

        Raises
        ------
        EngineError
            As :meth:`render`.
        ValueError
            If the number of layers is not from 2 to 64.
        """
        style = style or Style()
        nearest = self.render(view, style)
        if self._layers is None:
            self._layers = Layers(self._ctx, self._gl, self._programs, self._make_pipeline)
        return self._layers.of(nearest, count, lambda: self._job(view, style, nearest))

    def drop_layers(self) -> None:
        """Give back what :meth:`render_layers` keeps; twice is harmless."""
        if self._layers is not None:
            self._layers.release()
            self._layers = None

    def _make_pipeline(self) -> Pipeline:
        return make_pipeline(
            self.pipeline,
            self._ctx,
            self._gl,
            self._programs,
            self._fiblets.n_fiblets,
            len(self._chunks),
            self._limits,
        )

    def _job(self, view: View, style: Style, target: GBuffer) -> Job:
        """Bring everything up to date that a view and a style need, bind it, and say what is to be drawn."""
        _, values, kept = self._alive()
        self._bind_shared()
        decoding = self._decoding_features()
        source = values.activate(style.values, decoding)
        clipping, planes = self._write_frame(view, style)
        kept.update(view, *self._place(), self._top)
        values.locate(local_frame(view, *self._place(), self._top)[1])
        return Job(
            chunks=self._chunks,
            target=target,
            passes=self._passes,
            decoding=tuple(decoding),
            values=(source,) if source else (),
            clipping=clipping or planes or bool(kept.cutting),
            planes=("CLIP_PLANES",) if planes else (),
            detail=("LEVEL_OF_DETAIL",) if style.tolerance > 0.0 else (),
            line_width=style.line_width,
            segment=self._segment,
            occlusion=self._occlusion,
            kept=kept,
            tubes=("TUBES",) if style.radius is not None else (),
            across=("ACROSS",) if style.relief is not None else (),
        )

    def needs_outside(self, view: View, style: Style) -> bool:
        """Say whether :meth:`render` would gain from the depth of other things in the scene.

        Only where the camera has just moved: the second picture of a view is drawn whole, to be used from then on.
        """
        two_phase = self._occlusion is not None and self._occlusion.halfway
        return two_phase and self._last != (view, style)

    def _place(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Where anchors count from, and mm per anchor integer."""
        return np.asarray(self._fiblets.origin, np.float64), np.asarray(self._fiblets.anchor_scale, np.float64)

    def _write_frame(self, view: View, style: Style) -> tuple[bool, bool]:
        """Bring the uniform blocks of the camera up to date; say whether anything may cross the edges, or planes."""
        origin, scale = self._place()
        # Where steps vary, four times their mean stands for the longest.
        self._segment = segment_pixels(view, origin, scale, self._top, 4.0 * self._fiblets.step)
        block, margin = frame_block(view, style, origin, scale, self._top)
        radius = self._fiblets.parameters.largest_radius
        self._buffers["frame"].write(block)
        if style.radius is None:
            if "tubes" in self._buffers:
                self._buffers.pop("tubes").release()
        else:
            if "tubes" not in self._buffers:
                self._buffers["tubes"] = self._ctx.buffer(reserve=TUBES_BYTES)
            self._buffers["tubes"].write(tubes_block(view, style.radius, origin, scale, self._top))
            self._buffers["tubes"].bind_to_uniform_block(BLOCKS["Tubes"])
            radius += style.radius
        planes = clip_planes_block(view, 2.0 * style.half_width or 1.0, origin, scale, self._top, radius)
        if planes is None:
            if "clip_planes" in self._buffers:
                self._buffers.pop("clip_planes").release()
            return margin < radius, False
        if "clip_planes" not in self._buffers:
            self._buffers["clip_planes"] = self._ctx.buffer(reserve=BLOCK_BYTES)
        self._buffers["clip_planes"].write(planes)
        self._buffers["clip_planes"].bind_to_uniform_block(3)
        return margin < radius, True

    def value_range(self, values: str | VolumeSource) -> tuple[float, float]:
        """Return the least and the greatest of a per-point value, for a colour map's range.

        Parameters
        ----------
        values : str or VolumeSource
            As in :class:`Style`. Arc length and curvature are measured on the GPU, once.

        Returns
        -------
        tuple of float
            Of a stored array: the range that its codes span; of a volume: that of its finite voxels.

        Raises
        ------
        EngineError
            If there is no such array, or after :meth:`release`.
        """
        sources = self._alive()[1]
        self._bind_shared()
        return sources.range(values, self._decoding_features())

    def _forget_camera(self) -> None:
        """Have positions count from the first anchor's, so that what is measured does not depend on the camera."""
        self._buffers["frame"].write(bytes(FRAME_BYTES))

    @property
    def filtering(self) -> Filter | None:
        """What is there to be drawn; None for everything. Setting it takes effect with the next picture.

        Raises
        ------
        ValueError
            On setting one that is for another set.
        EngineError
            After :meth:`release`, or if memory does not suffice.
        """
        return self._alive()[2].filtering

    @filtering.setter
    def filtering(self, wanted: Filter | None) -> None:
        self._alive()[2].filtering = wanted
        self._drawn = None
        if self._occlusion is not None:
            self._occlusion.forget()

    def query(self, region: Region, sampling: float | None = None) -> npt.NDArray[np.uint8]:
        """Say how each streamline of the set lies to a region, whatever is filtered or drawn.

        On the GPU where it can (:attr:`.RegionQuery.available`), and equal to what the CPU says.

        Parameters
        ----------
        region, sampling
            As in :func:`pvfiblets.codec.query.passing.region_flags`, which also says what is returned and raised.

        Raises
        ------
        EngineError
            After :meth:`release`, or if memory does not suffice.
        """
        from .querying import RegionQuery

        self._alive()
        if self._query is None:
            self._query = RegionQuery(
                self._ctx, self._gl, self._programs, self._whole, self._chunks, self._max_groups
            )
        self._bind_shared()
        found = self._query.flags(self._decoding_features(), region, sampling)
        self._bind_shared()
        return found

    def _alive(self) -> tuple[Pipeline, ValueSources, Kept]:
        if self._pipeline is None or self._values is None or self._kept is None:
            raise EngineError("this renderer has been released; make a new one")
        return self._pipeline, self._values, self._kept

    def _bind_shared(self) -> None:
        self._buffers["frame"].bind_to_uniform_block(0)
        self._buffers["coding"].bind_to_uniform_block(1)
        self._buffers["rotations"].bind_to_uniform_block(4)

    def _decoding_features(self) -> list[str]:
        kinds = frozenset().union(*(chunk.kinds for chunk in self._chunks))
        wanted = {
            "ANCHORS_LOW": self._fiblets.anchors_low is not None,
            "DIRECTION": layout.Kind.DIRECTION in kinds,
            "LATTICE": bool(kinds - {layout.Kind.DIRECTION}),
            "WIDE_LATTICE": layout.Kind.WIDE in kinds,
            "RANK_TO_ID": self._fiblets.rank_to_id is not None,
        }
        return [name for name, on in wanted.items() if on]

    def explain(self, *, counts: bool = True) -> dict[str, object]:
        """Say what the last redraw was made of, and wait for it to end.

        Parameters
        ----------
        counts : bool
            Whether to count fiblets, which takes a pass over all of them and reads the picture back.

        Returns
        -------
        dict
            ``passes`` (name, ms), ``features``, ``buffers`` (name, bytes), ``fiblets_total``, ``share``; ``fiblets``:
            ``total``, ``in_frustum``, ``drawn`` and ``visible`` (:mod:`pvfiblets.engine.census`), None where not known.
        """
        return {
            "passes": self._passes.report(),
            "features": list(self._features),
            "buffers": buffer_sizes(
                self._buffers,
                self._chunks,
                self._pipeline,
                self._occlusion,
                self._target,
                self._kept,
                self._values,
                self._layers,
            ),
            "fiblets_total": int(self._fiblets.n_fiblets),
            "fiblets": self._count() if counts else no_counts(int(self._fiblets.n_fiblets)),
            "share": self.share,
        }

    def _count(self) -> dict[str, int | None]:
        """Count fiblets of the last picture."""
        total = int(self._fiblets.n_fiblets)
        if self._target is None or self._last is None:
            return no_counts(total)
        pipeline, _, kept = self._alive()
        self._bind_shared()
        _, planes = self._write_frame(*self._last)
        features = [*self._decoding_features(), *(["CLIP_PLANES"] if planes else [])]
        culled = self._occlusion is not None
        return count_fiblets(self._census, total, self._chunks, features, pipeline, self._target, kept, culled)

    def _release_chunks(self) -> None:
        for chunk in self._chunks:
            chunk.release()
        self._chunks.clear()

    def release(self) -> None:
        """Give back everything on the GPU; twice is harmless."""
        self._release_chunks()
        for buffer in self._buffers.values():
            buffer.release()
        self._buffers.clear()
        if self._pipeline is not None:
            self._pipeline.release()
            self._pipeline = None
        if self._values is not None:
            self._values.release()
            self._values = None
        self.drop_layers()
        if self._kept is not None:
            self._kept.release()
            self._kept = None
        if self._query is not None:
            self._query.release()
            self._query = None
        if self._occlusion is not None:
            self._occlusion.release()
            self._occlusion = None
        if self._target is not None:
            self._target.release()
            self._target = None
        self._programs.release()
        self._passes.release()
        self._drawn = None
