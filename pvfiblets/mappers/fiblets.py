"""`FibletMapper`: fiblets as geometry of an ordinary VTK actor."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules.vtkRenderingCore import vtkRenderer

from pvfiblets.engine.fiblets.style import LARGEST_DISC, FibletStyle
from pvfiblets.engine.view import Style, View
from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.effects.shader_effects import ShaderEffect
from pvfiblets.mappers.engine_mapper import FilteredMapper
from pvfiblets.mappers.engine_options import EngineOptions, engine_renderer
from pvfiblets.mappers.frames.scene import Frame, frame_of, slack, smoothers, switch_view, wanted_share
from pvfiblets.mappers.frames.windows import Slot, WindowContext, contexts_with
from pvfiblets.mappers.line_data import SIDES
from pvfiblets.mappers.picking import nearest_pixel
from pvfiblets.query.selection.point_flags import Sampling

if TYPE_CHECKING:
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.engine.fiblets.sample_layers import OtherSamples, SampledLines

_OVER = object()


class FibletMapper(FilteredMapper[EngineOptions]):
    """Mapper that draws a `FibletSet`, or lines that it compresses, through VTK's own lights, passes and selection.

    ``actor.SetMapper(mapper)`` gives it to an actor, or `attach`. One mapper serves one actor, in any number of
    renderers and windows; each window has GPU memory of its own.

    Parameters
    ----------
    fiblets : FibletSet, optional
        What to draw. Without it, each line cell of the PolyData that ``SetInputConnection`` or ``SetInputData``
        connects is a streamline.
    colouring : Colouring, optional
        By default fiblets are coloured by orientation, and connected data as by any ``vtkMapper``: by its
        active scalars, or in the colour of the actor's property.
    line_width : float, optional
        Pixels of the window, above 0; that of the actor's property when left out. Lines thinner than a pixel are drawn
        a pixel wide, and fainter where edges are smoothed (`pvfiblets.mappers.picture.antialias_coverage`).
    compression : mapping, optional
        Arguments of `pvfiblets.compress` for connected data.
    options : EngineOptions, optional
        Pipeline and culling; the defaults suit every machine.
    renderer_factory : callable, optional
        Takes a moderngl context, the fiblets, and as keywords those options that are not the defaults; returns a
        renderer as of `pvfiblets.engine`.
    progress : bool, default False
        Show a progress bar while copying to the GPU.

    Notes
    -----
    Exceptions while drawing wait for `raise_pending`; GL objects are given back as `EngineMapper` says.
    """

    _NAME = "FibletMapper"
    _HAS_EDGES = True

    COPIED = (*FilteredMapper.COPIED, "_line_width", "_ends", "_compression", "_compressed")

    def __init__(
        self,
        fiblets: FibletSet | None = None,
        *,
        colouring: Colouring | None = None,
        line_width: float | None = None,
        compression: Mapping[str, Any] | None = None,
        options: EngineOptions | None = None,
        renderer_factory: Callable[..., Any] = engine_renderer,
        progress: bool = False,
    ) -> None:
        self._compression = dict(compression or {})
        self._compressed: tuple[Any, Any] = (None, None)
        self._detail = 0.0
        self._ends = False
        super().__init__(
            fiblets,
            colouring=Colouring() if colouring is None and fiblets is not None else colouring,
            options=EngineOptions() if options is None else options,
            renderer_factory=renderer_factory,
            **({"progress": True} if progress else {}),
        )
        self._line_width: float | None = None
        if line_width is not None:
            self.line_width = line_width

    @property
    def fiblets(self) -> Any:
        """The drawn `FibletSet`; None without a connection, or before its first use."""
        return self._drawn

    def set_fiblets(self, fiblets: FibletSet) -> None:
        """Draw other fiblets from the next frame on, unless the colouring is for another number of them."""
        self._put(fiblets)

    @property
    def line_width(self) -> float:
        """Width of the lines in pixels of the window."""
        if self._line_width is not None:
            return self._line_width
        return 1.0 if self.actor is None else float(self.actor.GetProperty().GetLineWidth())

    @line_width.setter
    def line_width(self, pixels: float) -> None:
        if not (math.isfinite(pixels) and pixels > 0.0):
            raise ValueError(f"line_width is {pixels}; give a finite number of pixels above 0")
        self._line_width = float(pixels)
        self._link.modified()

    @property
    def ends(self) -> bool:
        """Whether only the ends of streamlines are drawn, as discs as wide as the property's point size."""
        return self._ends

    @ends.setter
    def ends(self, wanted: bool) -> None:
        self._ends = bool(wanted)
        self._link.modified()

    @property
    def drawn_width(self) -> float:
        """Pixels of the window that lines, or discs at their ends, are wide."""
        if not self._ends:
            return self.line_width
        size = 1.0 if self.actor is None else float(self.actor.GetProperty().GetPointSize())
        return min(max(size, 1.0), LARGEST_DISC)

    @property
    def detail(self) -> float:
        """Error of lines in pixels of the window (`FibletStyle.tolerance`); 0 draws every point."""
        return self._detail

    @detail.setter
    def detail(self, pixels: float) -> None:
        if not (math.isfinite(pixels) and pixels >= 0.0):
            raise ValueError(f"detail is {pixels}; give a finite number of pixels, 0 or more")
        self._detail = float(pixels)
        self._link.modified()

    def _style(self, renderer: vtkRenderer, pixel_scale: float) -> FibletStyle:
        return FibletStyle(
            line_width=self.drawn_width * pixel_scale,
            ends=self._ends,
            min_width=max(1.0, pixel_scale),
            tolerance=max(self._detail * pixel_scale, slack(renderer)),
        )

    def _narrower(self, pixel_scale: float) -> float:
        return 0.0 if self._thickness > 0.0 or self._ends else max(1.0 - self.line_width * pixel_scale, 0.0)

    def _widened(self, style: FibletStyle, frame: Frame) -> bool:
        if style.radius is None:
            return style.line_width <= 1.0 and not style.ends
        return 2.0 * style.radius * frame.least_scale(self._drawn.bounds) < style.min_width

    def _made_of(self, data: Any) -> tuple[Any, Colouring]:
        from pvfiblets.mappers.vtk_pipeline.vtk_lines import fiblets_of, geometry_of, painted_fiblets

        shape = geometry_of(data)
        if self._compressed[0] != shape:
            self._compressed = shape, fiblets_of(data, self._compression)
        if not self._follows:
            return self._compressed[1], self._colouring
        return painted_fiblets(self._compressed[1], data, self)

    def _readable_points(self) -> int | None:
        from pvfiblets.mappers.drawn_lines import shown_points, shown_streamlines

        if self._ends:
            return 2 * len(shown_streamlines(self._drawn, self._filtering))
        return shown_points(self._drawn, self._filtering) * (SIDES if self._thickness > 0.0 else 1)

    def _selects_lines(self) -> bool:
        return self._thickness <= 0.0

    def _readable_data(self, budget: int, *, colours: bool, segments: bool) -> Any:
        from pvfiblets.mappers.drawn_lines import shown_streamlines, thinned

        ids = shown_streamlines(self._drawn, self._filtering)
        if budget < (self._readable_points() or 0):
            counts = np.full(len(ids), 2) if self._ends else np.diff(self._drawn.offsets())[ids]
            ids = ids[thinned(counts * (SIDES if self._thickness > 0.0 else 1), budget)]
        return self._readable_ids(ids, colours=colours, segments=segments)

    def _readable_ids(self, ids: Any, *, colours: bool, segments: bool) -> vtkPolyData:
        from pvfiblets.mappers.drawn_lines import fiblet_lines
        from pvfiblets.mappers.line_data import RADIUS, tube_surface

        lines = fiblet_lines(self._drawn, self._colouring if colours else None, self._filtering, ids, ends=self._ends)
        lines = self._within_cuts(lines)
        if self._ends:
            return lines.to_polydata(vertices=True)
        if self._thickness <= 0.0 or segments:
            return lines.to_polydata(segments=segments)
        return tube_surface(lines.with_columns(**{RADIUS: np.full(len(lines.points), self._thickness)}))

    def _readable_near(self, ray: Any, budget: int) -> Any:
        if (self._readable_points() or 0) <= budget:
            return None
        from pvfiblets.mappers.drawn_lines import near_ray

        ids = near_ray(self._drawn, self._filtering, ray, budget // (SIDES if self._thickness > 0.0 else 1))
        return self._readable_ids(ids, colours=False, segments=False)

    def _engine(self, context: WindowContext, slot: Slot) -> Any:
        engine = super()._engine(context, slot)
        if wanted_share(context.window) < 1.0 and not self._sums_up:
            from pvfiblets.mappers.thinned import thinned_engine

            return thinned_engine(context, slot, self._drawn, self._filtering, self._make)
        return engine

    def draw_in_pieces(self, renderer: vtkRenderer, sample_camera: Any = None) -> Iterator[None]:
        """Draw, piece by piece, what the next frame of a renderer needs; the frame then finds it drawn."""
        # Yields after each piece (`pvfiblets.engine.drawable.Drawable.render_in_pieces`). Others may draw in between,
        # and anything may change: the picture is then useless. Nothing is drawn for a window that has not shown the
        # actor yet, while `vtkHardwareSelector` selects, or where VTK draws real lines. `sample_camera` is that of the
        # next frame, if that is a sample (`antialias_refinement.py`).
        window, actor, context = renderer.GetRenderWindow(), self.actor, self._context_in(renderer)
        if context is None or actor is None or self.is_readable or self._empty or renderer.GetSelector() is not None:
            return
        slot = context.slot(self)
        origin, size = renderer.GetOrigin(), renderer.GetSize()
        if slot.renderer is None or min(size) < 1:
            return
        steps = None
        while True:
            window.MakeCurrent()
            with context.foreign():
                if steps is None:
                    smoothed = self._has_edges and renderer.GetAddressAsString("") in smoothers
                    frame = frame_of(renderer, actor, (*origin, *size), sample_camera)
                    wanted = self._wanted(renderer, frame, sample_camera is not None if smoothed else None)
                    engine = self._engine(context, slot)
                    switch_view(engine, renderer, actor, *wanted)
                    steps = engine.render_in_pieces(*wanted)
                if next(steps, _OVER) is _OVER:
                    return
            yield
            if not context.alive or slot.renderer is None:
                return

    def layers_samples(self, renderer: vtkRenderer) -> bool:
        """Return whether a renderer's samples can be drawn at once: for opaque lines, each pixel by itself."""
        actor, context = self.actor, self._context_in(renderer)
        if actor is None or context is None or self.is_readable or self._empty or not self._has_edges or self._sums_up:
            return False
        if actor.HasTranslucentPolygonalGeometry() or wanted_share(context.window) < 1.0:
            return False
        alone = all(isinstance(effect, ShaderEffect) and effect.looks_at_pixel for effect in self._effects.values())
        layers = getattr(context.slot(self).renderer, "layers_samples", None)
        return alone and layers is not None and layers(*self._sampled(renderer)[1:])

    def _sampled(self, renderer: vtkRenderer) -> tuple[Frame, View, Style]:
        """Return what the engine is to draw for samples of a renderer's picture."""
        assert self.actor is not None  # a renderer draws it
        frame = frame_of(renderer, self.actor, (*renderer.GetOrigin(), *renderer.GetSize()))
        return frame, *self._wanted(renderer, frame, True)

    def sample_layers(
        self, renderer: vtkRenderer, lines: Sequence[FibletMapper], others: OtherSamples | None
    ) -> Generator[Any, None, None]:
        """Yield what the engine does (`pvfiblets.engine.fiblets.sample_layers`) for samples of what a renderer shows.

        Others may draw in between. ``lines`` are all that it shows beside ``others``, this first.
        """
        context = self._context_in(renderer)
        assert context is not None
        engine = self._engine(context, context.slot(self))
        samples = engine.sample_layers()
        steps = samples.draw([list(one.sampled_lines(renderer, context)) for one in lines], others)
        try:
            while context.alive:
                with context.foreign():
                    step = next(steps, None)
                if step is None:
                    break
                yield step
        finally:
            if context.alive:
                context.window.MakeCurrent()
                with context.foreign():
                    engine.drop_samples(samples)

    def sampled_lines(self, renderer: vtkRenderer, context: WindowContext) -> Iterable[SampledLines]:
        """Return what the engine takes of this set, part by part."""
        frame, view, style = self._sampled(renderer)
        rectangle = frame.pixel_rectangle(self._drawn.bounds, self._drawn.promise, style.half_width + 1.0)
        return self._engine(context, context.slot(self)).sampled(view, style, rectangle)

    def _context_in(self, renderer: vtkRenderer) -> WindowContext | None:
        """Return the context in which a renderer's window shows it; None before the first frame."""
        address = renderer.GetRenderWindow().GetAddressAsString("")
        return next((c for c in contexts_with(self) if c.alive and c.address == address), None)

    def pick_at(
        self, x: float, y: float, *, renderer: vtkRenderer | None = None, tolerance: int = 2
    ) -> tuple[int, float] | None:
        """Return the streamline nearest to a pixel of the last frame, and the position along it; None for no fiblet."""
        # x and y count from the window's lower left corner. The position is the index of the point before plus the
        # fraction of the segment. Other actors in front are not looked at.
        found = nearest_pixel(self, (x, y), ("ids", "position"), renderer=renderer, tolerance=tolerance)
        return None if found is None else (int(found.texels["ids"][0]), float(found.texels["position"][0]))

    def region_flags(self, region: Any, sampling: Sampling = "lines") -> Any:
        """Return how each streamline lies to a region, by the GPU of a window that draws it, else by the CPU."""
        for context in contexts_with(self):
            slot = context.slots[self._address]
            current = slot.versions.get("drawn") is self._drawn
            if slot.renderer is not None and current and context.alive and hasattr(slot.renderer, "query"):
                context.window.MakeCurrent()
                with context.foreign():
                    return slot.renderer.query(region, sampling)
        from pvfiblets.query.selection.passing import region_flags

        return region_flags(self._drawn, region, sampling)
