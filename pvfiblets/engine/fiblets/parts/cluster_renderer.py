"""`ClusterRenderer`: a set whose parts are drawn by the workers of a dask cluster, and put together here.

Each worker holds one part, a stretch of the streamlines in the order in which they are coded, and draws it with its own
OpenGL (:mod:`.worker_drawing`). Pictures are put together in pairs (Eilemann & Pajarola 2007; "binary tree"), each
where one of the two is, so that workers send them to each other and this process gets one. Only pixels that show
something are sent (:mod:`.sparse_picture`), so a picture of a part of the screen is small; binary swap and radix-k (as
IceT has them) would halve what the last workers do, but every worker would talk to every other.

A task whose worker has died is run again by dask, on another worker, which then fetches that part: the picture is late,
not wrong. Where there is a limit to its time (``patience``), it is given back without that part, and the next one of
the same view goes on.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cache, reduce
from typing import TYPE_CHECKING, Any

import moderngl

from ....codec.shards.unread_set import UnreadSet
from ...errors import EngineError
from ...gbuffer import EMPTY, GBuffer
from ...gl.capabilities import AUTO, check_choices
from ...view import View
from ..census import no_counts
from ..data.filter_textures import Filter, points_of_part
from ..data.sampled_volume import VolumeSource
from ..fiblet_drawable import has_layers
from ..pipelines import CONSTANTS
from ..style import FibletStyle
from .nearest_only import NearestOnly
from .parts import Stretches
from .shard_parts import ShardGroups
from .sparse_picture import Cost, SparsePicture, nearer, write_picture
from .worker_drawing import PartOfSet, Request, draw_part, merge_parts, source_of, value_range_of_part

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet
    from ..sample_layers import Rectangle, SampledLines

TICK = 0.5  # seconds from look to look whether there are workers left
LOOK = 0.05  # seconds for which a window stands still while samples of its picture are being drawn
GRACE = 10.0  # seconds in which a cluster without workers may get some: those that die are started again


class ClusterRenderer(NearestOnly):
    """Draws a set by workers."""

    def __init__(
        self,
        ctx: moderngl.Context,  # of this process; the workers make their own
        # mapped from a file, or in shards in a folder, that all workers see under the same name, or in shards at an
        # address: they read it themselves. Of one in memory each worker is sent its part.
        fiblets: FibletSet,
        cluster: Any,  # or the address of its scheduler, or the path of the scheduler's file
        *,
        count: int | None = None,  # parts; by default as many as there are workers now
        pipeline: str = AUTO,  # of the workers
    ) -> None:
        check_choices(pipeline=pipeline)
        super().__init__(ctx, CONSTANTS)
        self.pipeline = pipeline
        self._cluster = _client_of(cluster)
        self._whole = fiblets
        count = count or len(self._workers())
        key, path = source_of(fiblets)
        self._stretches: ShardGroups | Stretches
        if isinstance(fiblets, UnreadSet):  # workers are sent the manifest, and read the shards
            self._stretches = ShardGroups(fiblets, count)
        else:
            self._stretches = Stretches.of_count(fiblets, count)
        total = len(self._stretches)
        self._parts = [PartOfSet(key, path, number, total, int(fiblets.n_fiblets)) for number in range(total)]
        # What a worker reads itself is not sent; dask keeps what is sent once for all frames.
        self._sent = [None if path else self._send(self._stretches.part(one.number), one.number) for one in self._parts]
        self._filters: list[Any] = [None] * total
        self._filter_key = 0
        self._volume: tuple[VolumeSource, Any] | None = None
        self._asked: tuple[View, FibletStyle] | None = None
        self._drawing: list[Any] = []
        self._root: Any = None
        self._costs: tuple[Cost, ...] = ()
        self._left = 0

    def _present_workers(self) -> list[str]:
        return sorted(self._cluster.scheduler_info(n_workers=-1)["workers"])

    def _workers(self) -> list[str]:
        """Return the addresses of the workers that there are; those that are being started again have time for it."""
        until = time.monotonic() + GRACE
        while not (found := self._present_workers()):
            if time.monotonic() >= until:
                raise EngineError("the cluster has no workers; start some, or leave the cluster out to draw here")
            time.sleep(TICK)
        return found

    def _send(self, thing: Any, number: int) -> Any:
        there = self._workers()
        return self._cluster.scatter(thing, workers=[there[number % len(there)]], hash=False)

    def _submit_each(self, act: Any, given: Iterable[tuple[Any, ...]]) -> list[Any]:
        """Have something done for each part, by the worker that holds it; by another one if that is gone or late."""
        there = self._workers()
        return [
            self._cluster.submit(
                act, *arguments, workers=[there[number % len(there)]], allow_other_workers=True, pure=False, priority=10
            )
            for number, arguments in enumerate(given)
        ]

    @property
    def unfinished(self) -> bool:
        """Whether the last picture lacks parts that another one of the same view would show."""
        return not self.released and self._root is not None and bool(self._left)

    @property
    def resident(self) -> bool:
        """Whether the last picture is complete: workers hold their parts."""
        return not self.released and self._root is not None and not self._left

    def _draw(self, view: View, style: FibletStyle, outside: moderngl.Texture | None) -> GBuffer:  # noqa: ARG002
        if self._asked != (view, style):
            self._ask(view, style)
        with self._passes.timed("workers"):
            found = self._answer()
        target = self._fitting("gbuffer", view.size, lambda: GBuffer(self._ctx, view.size))
        target.want_relief(self._ctx, style.relief)
        target.want_edges(self._ctx, style.edges)
        with self._passes.timed("copy"):
            if found is None:
                for texture in (target.depth, target.owner):
                    texture.write(EMPTY.to_bytes(4, "little") * (view.size[0] * view.size[1]))
            else:
                write_picture(found, target)
                self._costs = found.costs
        return target

    def _ask(self, view: View, style: FibletStyle) -> None:
        """Have a picture begun, and what is left of the last one dropped."""
        self._forget()
        self._drawing, self._root = self._submit(view, style)
        self._asked = view, style

    def _submit(self, view: View, style: FibletStyle, *, samples: bool = False) -> tuple[list[Any], Any]:
        """Have a picture begun; return its parts, and all of it."""
        volume = self._volume_of(style)
        plain = style if volume is None else replace(style, values=None)
        request = Request(view, plain, self.pipeline, self._filter_key, samples)
        each = zip(self._parts, self._sent, self._filters, strict=True)
        drawing = self._submit_each(draw_part, ((part, request, sent, kept, volume) for part, sent, kept in each))
        level = list(drawing)
        while len(level) > 1:
            pairs = [
                self._cluster.submit(merge_parts, level[at], level[at + 1], pure=False, priority=20)
                for at in range(0, len(level) - 1, 2)
            ]
            level = pairs + level[2 * len(pairs) :]
        return drawing, level[0]

    def _answer(self) -> SparsePicture | None:
        """Wait for the picture, or for as long as patience lasts; None if nothing is there by then."""
        until = None if self.patience is None else time.monotonic() + self.patience
        while not self._root.done():
            left = TICK if until is None else min(until - time.monotonic(), TICK)
            if left <= 0.0:
                break
            self._wait(self._root, left)
            if not self._root.done():
                self._workers()  # raises where none is left
        if self._root.done():
            self._lack(0)
            found: SparsePicture = _result_of(self._root)
            return found
        done = [_result_of(one) for one in self._drawing if one.done()]
        self._lack(len(self._drawing) - len(done))
        # All may be drawn and not yet put together: then it is this process that does it.
        return reduce(nearer, done) if done else None

    def _wait(self, root: Any, seconds: float) -> None:
        from distributed import TimeoutError as TooLong
        from distributed import wait

        with self._cluster.as_current(), contextlib.suppress(TooLong, TimeoutError):
            wait([root], timeout=seconds)

    def layers_samples(self, view: View, style: FibletStyle) -> bool:
        """See :meth:`.FibletDrawable.layers_samples`; a worker without compute shaders raises."""
        return self.resident and has_layers(view, style)

    def sampled(self, view: View, style: FibletStyle, rectangle: Rectangle) -> list[SampledLines]:
        """See :meth:`.FibletDrawable.sampled`."""
        from ..sample_layers import SampledLines

        self._check_alive()
        return [SampledLines(view, style, rectangle, self._draw_samples)]

    def _draw_samples(self, view: View, style: FibletStyle, target: GBuffer, adds: bool) -> Iterator[None]:
        _, root = self._submit(view, style, samples=True)
        while not root.done():
            self._wait(root, LOOK)
            if not root.done():
                self._workers()
                yield
        write_picture(_result_of(root), target, adds=adds)

    def _forget(self) -> None:
        # dask gives up what nobody holds any more; told to cancel, it would stop at tasks that have just ended.
        self._drawing, self._root, self._asked = [], None, None
        self._lack(0)

    def _lack(self, left: int) -> None:
        self._left = left
        self.share = 1.0 - left / len(self._parts)

    def _volume_of(self, style: FibletStyle) -> Any:
        """Return where the volume of a style's values is, sent once."""
        if not isinstance(style.values, VolumeSource):
            self._volume = None
            return None
        if self._volume is None or self._volume[0] is not style.values:
            self._volume = style.values, self._cluster.scatter(style.values, broadcast=True, hash=False)
        return self._volume[1]

    def _take_filter(self, wanted: Filter | None) -> None:
        if wanted is not None:
            wanted.check(self._whole)
        self._forget()
        self._filter_key += 1
        for number in range(len(self._parts)):
            self._filters[number] = None if wanted is None else self._send(self._of_part(wanted, number), number)

    def _of_part(self, wanted: Filter, number: int) -> Filter:
        points = wanted.points
        if points is not None:
            points = points_of_part(points, self._whole, self._stretches.ids(number))
        return Filter(wanted.streamlines, points)

    def value_range(self, values: str | VolumeSource) -> tuple[float, float]:
        """Return the least and the greatest of a per-point value; see :meth:`.FibletRenderer.value_range`."""
        self._check_alive()
        if isinstance(values, VolumeSource):
            return values.range
        each = zip(self._parts, self._sent, strict=True)
        asked = self._submit_each(value_range_of_part, ((part, values, self.pipeline, sent) for part, sent in each))
        ranges = [_result_of(one) for one in asked]
        return min(low for low, _ in ranges), max(high for _, high in ranges)

    def _facts(self, *, counts: bool) -> dict[str, Any]:  # noqa: ARG002
        total = int(self._whole.n_fiblets)
        cluster = {
            "parts": len(self._parts),
            "left": self._left,
            "draw_ms": [1e3 * cost.seconds for cost in self._costs if cost.step == "draw"],
            "merge_ms": [1e3 * cost.seconds for cost in self._costs if cost.step == "merge"],
            "bytes": sum(cost.bytes for cost in self._costs),
        }
        return {"fiblets_total": total, "fiblets": no_counts(total), "share": self.share, "cluster": cluster}

    def release(self) -> None:
        """Give back everything on the GPU, and what was sent to the workers; twice is harmless."""
        self._forget()
        self._sent, self._filters, self._volume = [], [], None
        super().release()


@cache
def _client_at(address: str) -> Any:
    import distributed

    where = {"scheduler_file": address} if address.endswith(".json") else {"address": address}
    try:
        return distributed.Client(**where, timeout=GRACE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise EngineError(f"no scheduler of dask answers at {address} ({error}); start one: dask scheduler") from error


def _client_of(cluster: Any) -> Any:
    """Return the client of a cluster: what is given, or one for an address, the same for the same."""
    if isinstance(cluster, str):
        try:
            return _client_at(cluster)
        except ImportError as error:
            raise EngineError(f"{error}; a cluster needs dask: pip install 'pvfiblets[cluster]'") from None
    if not (hasattr(cluster, "submit") and hasattr(cluster, "scheduler_info")):
        raise TypeError(
            f"cluster is {cluster!r}; give a distributed.Client, or the address of a scheduler such as tcp://host:8786"
        )
    return cluster


def _result_of(future: Any) -> Any:
    """Return a result, or raise what a worker has raised, as an error of the engine where it is none of ours."""
    try:
        return future.result()
    except (EngineError, ValueError, TypeError, OSError):
        raise
    except Exception as error:  # of dask's own kinds, which have no base in common
        raise EngineError(f"the cluster gave no picture: {type(error).__name__}: {error}") from error
