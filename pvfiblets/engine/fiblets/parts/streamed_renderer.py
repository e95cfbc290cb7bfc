"""`StreamedRenderer`: a set larger than GPU memory, drawn part by part.

Each part (:mod:`.parts`) has a renderer of its own while it is on the GPU, and each picture is put together of the
parts' (:mod:`.part_pictures`). Parts outside the view are left out. Those that are there are drawn first, then the
others come, each in the place of that which was not drawn for longest.

=============  =======================================================================================================
picture        content
=============  =======================================================================================================
complete       every part in the view: bit by bit what a renderer of the whole set draws
so far         after `patience` seconds: the parts that were drawn by then, and the even share while others are being
               fetched; the next picture of the view goes on
hurried        an even share of all streamlines, always the same one, and the parts that are there: nothing is fetched
=============  =======================================================================================================

A software OpenGL has no memory of its own, and a part's records stand in memory twice: it gains nothing here.
"""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import moderngl

from ....codec.shards.unread_set import UnreadSet
from ....support.memory import free_host_memory
from ...errors import GPUMemoryError
from ...gbuffer import GBuffer
from ...gl.capabilities import choose
from ...gl.moderngl_extras import GLExtras
from ...view import View
from ..census import no_counts
from ..data.memory_fit import MemoryBudget
from ..fiblet_drawable import has_layers
from ..pipelines import CONSTANTS, Limits
from ..renderer import FibletRenderer
from ..style import FibletStyle
from .nearest_only import NearestOnly
from .part_pictures import PartPictures
from .parts import Box, Parts, in_view, reach_of
from .shard_parts import gpu_bytes_of_shards, in_memory, parts_of

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet
    from ..data.filter_textures import Filter
    from ..data.sampled_volume import VolumeSource
    from ..gather.gatherer import Gatherer
    from ..gather.gathering import Gathered
    from ..gather.paint import Paint
    from ..sample_layers import Rectangle, SampledLines

PARTS = 12
"""How many parts that are not the even share fit into the memory: few are drawn in fewer calls, many fit it better."""

THINNED_SHARE = 0.25  # share of the memory for the streamlines that hurried pictures show

LEAST_ROOM = 60_000  # bytes of memory below which a part's overhead exceeds its records

THINNED = -1  # number of the even share among the parts


class StreamedRenderer(NearestOnly):
    """Draws a set with one part at a time on the GPU."""

    def __init__(
        self,
        ctx: moderngl.Context,
        parts: Parts,
        room: int,  # bytes of GPU memory for all parts that are there at a time
        needed: Callable[[FibletSet], int],  # returns the GPU bytes of a part
        *,
        pipeline: str = "auto",  # as of `.FibletRenderer`
        alike: int | None = None,  # as of `.FibletRenderer`; the whole set's fiblets by default
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(ctx, CONSTANTS)
        self.pipeline = choose(ctx, pipeline)
        self._parts = parts
        self._room = room
        self._needed = needed
        self._clock = clock
        self._alike = parts.whole.n_fiblets if alike is None else alike
        self._there: OrderedDict[int, FibletRenderer] = OrderedDict()  # the least lately drawn first
        self._bytes: dict[int, int] = {}
        self._boxes: dict[int, Box | None] = {}
        self._begun: tuple[View, FibletStyle] | None = None
        self._left: list[int] = []
        self._in_view: list[int] = []
        self._fetched = 0
        self._filtered: dict[int, bool] = {}
        self._thinned = False
        self._waiting = False
        self._gatherer: Gatherer | None = None
        self._pictures = self._keep(PartPictures(ctx, self._gl, self._programs), "parts' pictures")

    @property
    def unfinished(self) -> bool:
        """Whether the last picture lacks parts that another one of the same view would show."""
        return not self.released and bool(self._left) and (self._begun is not None or self._waiting)

    @property
    def resident(self) -> bool:
        """Whether all parts of the last picture are there."""
        return not self.unfinished and self.share == 1.0 and all(number in self._there for number in self._in_view)

    def _draw(self, view: View, style: FibletStyle, outside: moderngl.Texture | None) -> GBuffer:
        if self.hurried or self._begun != (view, style):
            self._begin(view, style)
        until = None if self.patience is None else self._clock() + self.patience
        waiting = False
        while self._left:
            number = self._next(until)
            if number is None:
                waiting = True
                break
            self._add(number, number, view, style, outside)
            self._left.remove(number)
            if until is not None and self._clock() >= until:
                break
        if waiting:
            # Where its streamlines come again with their parts, these are taken: they have the lower order.
            if not self._thinned:
                self._add(THINNED, len(self._parts), view, style, outside)
            self._thinned = True
        self.share = 1.0 - len(self._left) / max(len(self._in_view), 1)
        self._waiting = waiting and not self.hurried
        return self._pictures.picture

    def _next(self, until: float | None) -> int | None:
        """Return the next part to draw; None if none is there in time."""
        if self.hurried:
            return self._left[0] if self._left[0] in self._there else None
        if until is None:
            return self._left[0]
        while True:
            for number in self._left:
                if number in self._there or self._parts.is_here(number):
                    return number
            left = until - self._clock()
            if left <= 0.0:
                return None
            self._parts.wait(left)

    def _begin(self, view: View, style: FibletStyle) -> None:
        self._in_view = self._visible(view, style)
        self._left = sorted(self._in_view, key=lambda number: number not in self._there)
        self._pictures.begin(view.size, style.relief, style.edges)
        self._begun, self._thinned = (view, style), False

    def _visible(self, view: View, style: FibletStyle) -> list[int]:
        numbers = range(len(self._parts))
        return [n for n in numbers if in_view(view, style, self._box(n)) and not self._is_filtered(n)]

    def _is_filtered(self, number: int) -> bool:
        """Whether the filter keeps no streamline of a part, which then need not come."""
        mask = None if self._filter is None else self._filter.streamlines
        if mask is None:
            return False
        if number not in self._filtered:
            self._filtered[number] = not mask[self._parts.ids(number)].any()
        return self._filtered[number]

    def _box(self, number: int) -> Box | None:
        return self._boxes[number] if number in self._boxes else self._parts.box(number)

    def _add(
        self, number: int, order: int, view: View, style: FibletStyle, outside: moderngl.Texture | None
    ) -> None:
        renderer = self._fetch(number)
        drawn = renderer.render(view, style, outside=outside)
        self._pictures.add(drawn, order, by_streamline=self._parts.by_streamline)
        renderer.forget_picture()  # the next part draws into the same textures

    def _fetch(self, number: int) -> FibletRenderer:
        """Return the renderer of a part, brought to the GPU if need be."""
        if number in self._there:
            self._there.move_to_end(number)
            return self._there[number]
        thinned = number == THINNED
        part = self._parts.thinned(int(THINNED_SHARE * self._room)) if thinned else self._parts.part(number)
        if not thinned:
            self._boxes[number] = reach_of(part)
        size = self._needed(part)
        while self._there and sum(self._bytes[n] for n in self._there) + size > self._room:
            self._drop_oldest()
        while True:
            try:
                made = FibletRenderer(
                    self._ctx, part, pipeline=self.pipeline, culling=None, lender=self,
                    whole=self._parts.whole, alike=self._alike,
                )  # fmt: skip
                break
            except GPUMemoryError as error:
                if not self._there:
                    raise GPUMemoryError(f"not even one part of the set fits into GPU memory: {error}") from error
                self._drop_oldest()
        self._there[number], self._bytes[number] = made, size
        self._fetched += 1
        made.filtering = self._filter
        return made

    def _drop_oldest(self) -> None:
        # The even share stays as long as there is another: every movement of the camera asks for it.
        number = next((one for one in self._there if one != THINNED), THINNED)
        self._there.pop(number).release()
        del self._bytes[number]

    def _take_filter(self, wanted: Filter | None) -> None:
        if wanted is not None:
            wanted.check(self._parts.whole)
        self._begun = None
        self._filtered.clear()
        for renderer in self._there.values():
            renderer.filtering = wanted

    def layers_samples(self, view: View, style: FibletStyle) -> bool:
        """See :meth:`.FibletDrawable.layers_samples`."""
        return self.pipeline == "compute" and self.resident and has_layers(view, style)

    def sampled(self, view: View, style: FibletStyle, rectangle: Rectangle) -> Iterator[SampledLines]:
        """See :meth:`.FibletDrawable.sampled`; parts that are not there are fetched one after the other."""
        self._check_alive()
        for number in reversed(self._visible(view, style)):
            yield from self._fetch(number).sampled(view, style, rectangle)

    def gather(
        self,
        view: View,
        style: FibletStyle | None = None,
        paint: Paint | None = None,
        *,
        sliced: bool = False,
        outside: Callable[[], moderngl.Texture | None] | None = None,
        state: Any = None,
    ) -> Gathered:
        """Add up what all lines show, part by part; see :meth:`.LinesBehind.gather`."""
        # While the picture is not complete, the sums are of the parts that are there, or of the even share.
        from ..gather.gatherer import Gatherer
        from ..gather.gathering import SLICES
        from ..gather.paint import Paint

        style = style or FibletStyle()
        nearest = self.render(view, style)
        if self._gatherer is None:
            self._gatherer = self._keep(Gatherer(self._ctx, self._gl, self._programs), "gathered")
        whole = self.share == 1.0
        drawn = [number for number in self._in_view if number not in self._left]
        there = [number for number in drawn if number in self._there]
        numbers = [*there, *(number for number in drawn if number not in there)] if whole else there or [THINNED]
        first = self._fetch(numbers[0] if numbers else THINNED)
        asked = paint or Paint()

        def add(held: Gathered) -> None:
            hides = None if outside is None else outside()
            for number in numbers:
                part = self._fetch(number)
                part.gather_into(held, view, style, asked, nearest, hides)
                part.forget_picture()  # the next part draws into the same textures

        return self._gatherer.render_parts(
            nearest, asked, SLICES if sliced else 1, first.slice_distances(view),
            lambda: first.gathers_words(view, style, nearest), add, (state,) if whole else None,
        )  # fmt: skip

    def most_lines(self, *, wait: bool = True) -> float:
        """Return the greatest weight of a pixel in what :meth:`gather` made last."""
        return 0.0 if self._gatherer is None else self._gatherer.greatest(wait=wait)

    def drop_gathered(self) -> None:
        """Give back what :meth:`gather` keeps; twice is harmless."""
        if self._gatherer is not None:
            self._drop(self._gatherer)
            self._gatherer = None
        for renderer in self._there.values():
            renderer.drop_gathered()

    def value_range(self, values: str | VolumeSource) -> tuple[float, float]:
        """Return the least and the greatest of a per-point value; see :meth:`.FibletRenderer.value_range`."""
        # Computed measures need every part, so this takes as long as fetching them all.
        self._check_alive()
        ranges = []
        for number in range(len(self._parts)):
            ranges.append(self._fetch(number).value_range(values))
            if not (isinstance(values, str) and values in ("arc_length", "curvature")):
                break
        return min(low for low, _ in ranges), max(high for _, high in ranges)

    def _facts(self, *, counts: bool) -> dict[str, Any]:  # noqa: ARG002
        total = int(self._parts.whole.n_fiblets)
        parts = {
            "total": len(self._parts),
            "in_view": len(self._in_view),
            "left": len(self._left),
            "there": sum(number != THINNED for number in self._there),
            "fetched": self._fetched,
        }
        return {"fiblets_total": total, "fiblets": no_counts(total), "share": self.share, "parts": parts}

    def _sizes(self) -> dict[str, int]:
        sizes = super()._sizes()
        for renderer in self._there.values():
            for name, size in renderer._sizes().items():  # noqa: SLF001
                sizes[name] = sizes.get(name, 0) + size
        return sizes

    def release(self) -> None:
        """Give back everything on the GPU; twice is harmless."""
        self._gatherer = None
        for renderer in self._there.values():
            renderer.release()
        self._there.clear()
        self._bytes.clear()
        super().release()


def streamed_renderer(
    ctx: moderngl.Context,
    fiblets: FibletSet,
    *,
    pipeline: str = "auto",
    max_total_bytes: int | None = None,
    alike: int | None = None,
    **options: Any,
) -> FibletRenderer | StreamedRenderer:
    """Return a renderer of all of a set if it fits, else one that draws it part by part."""
    gl, pipeline = GLExtras(ctx), choose(ctx, pipeline)
    limits = Limits.from_context(ctx, gl, pipeline, options.get("max_buffer_bytes"), options.get("max_groups"))
    budget = MemoryBudget.from_context(ctx, gl, limits, max_total_bytes)
    room = budget.room
    if isinstance(fiblets, UnreadSet):
        # Shards that lie elsewhere are fetched as they are looked at, also where all would fit.
        needed = gpu_bytes_of_shards(fiblets)
        free = free_host_memory()
        fits = (room is None or needed <= room) and (free is None or needed <= free) and fiblets.is_here
    else:
        needed = budget.needed(fiblets)
        fits = room is None or budget.fits(fiblets)
    if fits:
        try:
            return FibletRenderer(
                ctx, in_memory(fiblets), pipeline=pipeline, max_total_bytes=max_total_bytes, alike=alike, **options
            )
        except GPUMemoryError:
            if room is not None:
                raise
    if room is None:
        # A driver that does not say how much memory is free has refused all; half of it may do.
        room = needed // 2
    if room < LEAST_ROOM:
        raise GPUMemoryError(
            f"{max(room, 0) / 1e6:.1f} MB of GPU memory beside a picture are too little to draw anything part by part: "
            f"{LEAST_ROOM / 1e6:.1f} are needed; close what takes the memory"
        )
    parts = parts_of(fiblets, needed, int((1.0 - THINNED_SHARE) * room / PARTS))
    return StreamedRenderer(ctx, parts, room, budget.needed, pipeline=pipeline, alike=alike)
