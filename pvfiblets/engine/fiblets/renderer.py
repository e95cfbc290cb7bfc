"""`FibletRenderer`: a fiblet set on one OpenGL context, drawn into a G-buffer when something changed."""

from __future__ import annotations

from contextlib import nullcontext
from typing import TYPE_CHECKING

import moderngl

from ..capabilities import check_choices, choose
from ..culling import Occlusion, make_occlusion
from ..errors import EngineError
from ..frame import local_frame
from ..gbuffer import GBuffer
from ..opengl import OpenGL
from ..passes import Passes
from ..reporting import buffer_sizes, count_fiblets, no_counts
from ..shaders import Programs
from ..view import View
from .census import Census
from .chunks import Chunk
from .depth_peeling import LayeredBuffer, Layers
from .filter_textures import Filter
from .memory_fit import Room
from .pipelines import CONSTANTS, DrawRequest, Limits, Pipeline, make_measurer, make_pipeline
from .point_values import ValueSources
from .style import FibletStyle
from .uniform_blocks import SharedBlocks, decoding_features
from .upload import release_chunks, upload_fitting
from .visibility import Visibility

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ...codec.fibletset import FibletSet
    from ...query.region import Region
    from .region_query import RegionQuery
    from .sampled_volume import VolumeSource

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
        (:mod:`pvfiblets.engine.fiblets.memory_fit`).
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
        self._shared: SharedBlocks | None = None
        self._gl = OpenGL(ctx)
        self._occlusion: Occlusion | None = None
        self._pipeline: Pipeline | None = None
        self._target: GBuffer | None = None
        self._drawn: tuple[View, FibletStyle] | None = None
        self._last: tuple[View, FibletStyle] | None = None
        self._passes = Passes(ctx)
        self._programs = Programs(ctx, CONSTANTS)
        self._generation = 0
        self._features: frozenset[str] = frozenset()
        self._features_of_layers: frozenset[str] = frozenset()
        self._values: ValueSources | None = None
        self._kept: Visibility | None = None
        self._layers: Layers | None = None
        self._query: RegionQuery | None = None
        self._limits = limits = Limits.of(ctx, self._gl, pipeline, max_buffer_bytes, max_groups)
        try:
            whole = fiblets
            room = Room.of(ctx, self._gl, limits, max_total_bytes)
            fitted = upload_fitting(ctx, fiblets, room, fit, self._chunks, progress)
            self._fiblets = fiblets = fitted.kept()
            self.share = fitted.share
            self._shared = SharedBlocks(ctx, fiblets)
            self._kept = Visibility(ctx, self._gl, self._programs, whole, fiblets, self._chunks)
            self._occlusion = make_occlusion(culling, ctx, self._gl, self._programs, fiblets)
            self._pipeline = self._make_pipeline()
            self._whole, self._max_groups = whole, limits.groups
            self._census = Census(ctx, self._gl, self._programs, limits.groups)
            measurer = make_measurer(pipeline, ctx, self._gl, self._programs, limits)
            self._values = ValueSources(ctx, measurer, fiblets, self._chunks, self._shared.forget_camera)
        except BaseException:
            self.release()
            raise

    def render(
        self, view: View, style: FibletStyle | None = None, *, outside: moderngl.Texture | None = None
    ) -> GBuffer:
        """Draw, unless the last picture was of the same view and style.

        Parameters
        ----------
        view : View
        style : FibletStyle, optional
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
        style = style or FibletStyle()
        pipeline = self._alive()[0]
        if self._target is not None and self._drawn == (view, style):
            return self._target
        self._drawn = None
        if self._target is None or self._target.size != view.size:
            if self._target is not None:
                self._target.release()
                self._target = None
            self._target = GBuffer(self._ctx, view.size)
        try:
            self._target.want_relief(self._ctx, style.relief)
        except EngineError:
            self._target = None  # its textures are given back
            raise
        with self._programs.noting() as features:
            request = self._job(view, style, self._target)
            self._passes.begin()
            if self._occlusion is not None:
                self._occlusion.outside = outside
                with self._passes.timed("last picture") if self._target.generation else nullcontext():
                    self._occlusion.before(self._target, view, style)
            pipeline.draw(request)
            if self._occlusion is not None:
                self._occlusion.after(self._target, view, style)
        self._features, self._features_of_layers = frozenset(features), frozenset()
        self._generation += 1
        self._target.generation = self._generation
        if outside is None:
            self._drawn = (view, style)
        self._last = (view, style)
        return self._target

    def render_layers(self, view: View, style: FibletStyle | None = None, count: int = 4) -> LayeredBuffer:
        """Draw what lies behind the nearest too; nothing is done that has been done for this view and style.

        Parameters
        ----------
        view : View
        style : FibletStyle, optional
        count : int
            Layers, the picture of :meth:`render` included.

        Returns
        -------
        LayeredBuffer
            The renderer's own (:mod:`pvfiblets.engine.fiblets.depth_peeling`); the same object until the size changes.

        Raises
        ------
        EngineError
            As :meth:`render`.
        ValueError
            If the number of layers is not from 2 to 64.
        """
        style = style or FibletStyle()
        nearest = self.render(view, style)
        if self._layers is None:
            self._layers = Layers(self._ctx, self._gl, self._programs, self._make_stage)
        with self._programs.noting() as features:
            layers = self._layers.of(nearest, count, view, style, lambda: self._job(view, style, nearest))
        self._features_of_layers |= features
        return layers

    def drop_layers(self) -> None:
        """Give back what :meth:`render_layers` keeps; twice is harmless."""
        if self._layers is not None:
            self._layers.release()
            self._layers = None
        self._features_of_layers = frozenset()

    def _make_stage(self) -> tuple[Pipeline, Occlusion | None]:
        # The coverage buffer is made of the nearest lines alone, and loses some for a frame.
        culling = None if self._occlusion is None else "two-phase"
        occlusion = make_occlusion(culling, self._ctx, self._gl, self._programs, self._fiblets)
        return self._make_pipeline(), occlusion

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

    def _job(self, view: View, style: FibletStyle, target: GBuffer) -> DrawRequest:
        """Bring everything up to date that a view and a style need, bind it, and say what is to be drawn."""
        _, values, kept, shared = self._alive()
        shared.bind()
        decoding = self._decoding_features()
        source = values.activate(style.values, decoding)
        clipping, planes = shared.write_camera(view, style)
        kept.update(view, *shared.place)
        values.locate(local_frame(view, *shared.place)[1])
        return DrawRequest(
            chunks=self._chunks,
            target=target,
            passes=self._passes,
            decoding=tuple(decoding),
            values=(source,) if source else (),
            clipping=clipping or planes or bool(kept.cutting),
            planes=("CLIP_PLANES",) if planes else (),
            detail=("LEVEL_OF_DETAIL",) if style.tolerance > 0.0 else (),
            line_width=style.line_width,
            segment=shared.segment,
            occlusion=self._occlusion,
            kept=kept,
            tubes=("TUBES",) if style.radius is not None else (),
            across=("CROSS_LINE",) if style.relief is not None else (),
        )

    def needs_outside(self, view: View, style: FibletStyle) -> bool:
        """Say whether :meth:`render` would gain from the depth of other things in the scene.

        Only where the camera has just moved: the second picture of a view is drawn whole, to be used from then on.
        """
        two_phase = self._occlusion is not None and self._occlusion.halfway
        return two_phase and self._last != (view, style)

    def value_range(self, values: str | VolumeSource) -> tuple[float, float]:
        """Return the least and the greatest of a per-point value, for a colour map's range.

        Parameters
        ----------
        values : str or VolumeSource
            As in :class:`FibletStyle`. Arc length and curvature are measured on the GPU, once.

        Returns
        -------
        tuple of float
            Of a stored array: the range that its codes span; of a volume: that of its finite voxels.

        Raises
        ------
        EngineError
            If there is no such array, or after :meth:`release`.
        """
        _, sources, _, shared = self._alive()
        shared.bind()
        return sources.range(values, self._decoding_features())

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
        kept = self._alive()[2]
        self._drawn = None  # also of one that fails, as everything is there again
        if self._occlusion is not None:
            self._occlusion.forget()
        kept.filtering = wanted

    def query(self, region: Region, sampling: float | None = None) -> npt.NDArray[np.uint8]:
        """Say how each streamline of the set lies to a region, whatever is filtered or drawn.

        On the GPU where it can (:attr:`.RegionQuery.available`), and equal to what the CPU says.

        Parameters
        ----------
        region, sampling
            As in :func:`pvfiblets.query.passing.region_flags`, which also says what is returned and raised.

        Raises
        ------
        EngineError
            After :meth:`release`, or if memory does not suffice.
        """
        from .region_query import RegionQuery

        shared = self._alive()[3]
        if self._query is None:
            self._query = RegionQuery(
                self._ctx, self._gl, self._programs, self._whole, self._chunks, self._max_groups
            )
        shared.bind()
        found = self._query.flags(self._decoding_features(), region, sampling)
        shared.bind()
        return found

    def _alive(self) -> tuple[Pipeline, ValueSources, Visibility, SharedBlocks]:
        if self._pipeline is None or self._values is None or self._kept is None or self._shared is None:
            raise EngineError("this renderer has been released; make a new one")
        return self._pipeline, self._values, self._kept, self._shared

    def _decoding_features(self) -> list[str]:
        return decoding_features(self._fiblets, self._chunks)

    def explain(self, *, counts: bool = True) -> dict[str, object]:
        """Say what the last redraw was made of, and wait for it to end.

        Parameters
        ----------
        counts : bool
            Whether to count fiblets, which takes a pass over all of them and reads the picture back.

        Returns
        -------
        dict
            ``passes`` (name, ms); ``features``, which are on in the programs that ran, layers' included; ``buffers``
            (name, bytes); ``fiblets_total``, ``share``; ``fiblets``: ``total``,
            ``in_frustum``, ``drawn`` and ``visible`` (:mod:`pvfiblets.engine.fiblets.census`), None where not known.
        """
        return {
            "passes": self._passes.report(),
            "features": sorted(self._features | self._features_of_layers),
            "buffers": buffer_sizes(
                {} if self._shared is None else self._shared.buffers,
                self._chunks,
                self._pipeline,
                self._occlusion,
                self._target,
                self._kept,
                self._values,
                self._layers,
                self._query,
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
        pipeline, _, kept, shared = self._alive()
        shared.bind()
        _, planes = shared.write_camera(*self._last)
        features = [*self._decoding_features(), *(["CLIP_PLANES"] if planes else [])]
        culled = self._occlusion is not None
        return count_fiblets(self._census, total, self._chunks, features, pipeline, self._target, kept, culled)

    def release(self) -> None:
        """Give back everything on the GPU; twice is harmless."""
        release_chunks(self._chunks)
        if self._shared is not None:
            self._shared.release()
            self._shared = None
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
