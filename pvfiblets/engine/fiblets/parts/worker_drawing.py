"""What a worker of a cluster does for a picture: it draws its part of a set, in an OpenGL context of its own.

A context belongs to one thread: all drawing of a process runs in a thread that lives as long as the process. Renderers
of the last :data:`HELD` sets and parts are kept, with their GPU memory.
"""

from __future__ import annotations

import hashlib
import os
import time
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from ....codec.shards.unread_set import UnreadSet
from ...errors import EngineError
from ...gbuffer import EMPTY, GBuffer
from ...view import View
from ..style import FibletStyle
from .sparse_picture import Cost, SparsePicture, nearer, read_picture

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet
    from ..data.filter_textures import Filter
    from ..fiblet_drawable import FibletDrawable

HELD = 4

Found = TypeVar("Found")


@dataclass(frozen=True)
class PartOfSet:
    """Streamlines that are coded one after another: the `number`-th of `count` parts of a set."""

    key: str  # of the set: another one for other bytes
    path: str | None  # its file, which all workers see under this name; None for a part that comes along
    number: int
    count: int
    fiblets: int  # of the whole set


@dataclass(frozen=True)
class Request:
    """A picture that is wanted."""

    view: View
    style: FibletStyle  # without a volume for its values, which come apart from it
    pipeline: str
    filter_key: int  # another one for another filter
    samples: bool = False  # whether each pixel is a sample (`pvfiblets.engine.fiblets.sample_layers`)


class _Drawing:
    """The one of a process."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, "fiblets")
        self._renderers: OrderedDict[Any, Any] = OrderedDict()
        self._filters: dict[Any, int] = {}
        self._ctx: Any = None

    def run(self, act: Callable[[], Found]) -> Found:
        return self._thread.submit(act).result()

    def renderer(self, part: PartOfSet, fiblets: FibletSet | None, pipeline: str) -> Any:
        from .streamed_renderer import streamed_renderer

        if self._ctx is None:
            from ...gl.standalone import bare_context

            self._ctx = bare_context()
        key = part, pipeline
        if key in self._renderers:
            self._renderers.move_to_end(key)
            return self._renderers[key]
        while len(self._renderers) >= HELD:
            old, renderer = self._renderers.popitem(last=False)
            self._filters.pop(old, None)
            renderer.release()
        given = _part_of_file(part) if fiblets is None else fiblets
        made = self._renderers[key] = streamed_renderer(
            self._ctx, given, pipeline=pipeline, alike=part.fiblets
        )
        return made

    def draw(
        self, part: PartOfSet, request: Request, fiblets: FibletSet | None, filtering: Filter | None, volume: Any
    ) -> SparsePicture:
        begun = time.perf_counter()
        renderer = self.renderer(part, fiblets, request.pipeline)
        key = part, request.pipeline
        if self._filters.get(key, 0) != request.filter_key:
            renderer.filtering = filtering
            self._filters[key] = request.filter_key
        style = request.style if volume is None else replace(request.style, values=volume)
        if request.samples:
            found = self._draw_samples(renderer, request.view, style, part.number)
        else:
            found = read_picture(renderer.render(request.view, style), part.number)
        return replace(found, costs=(Cost("draw", time.perf_counter() - begun, found.nbytes),))


    def _draw_samples(self, renderer: FibletDrawable, view: View, style: FibletStyle, order: int) -> SparsePicture:
        if renderer.pipeline != "compute":
            raise EngineError(f"a worker has no compute shaders for samples; its pipeline is {renderer.pipeline!r}")
        target = GBuffer(self._ctx, view.size)
        try:
            adds = False
            for lines in renderer.sampled(view, style, (0, 0, *view.size)):
                for _ in lines.draw(view, style, target, adds):
                    pass
                adds = True
            if not adds:  # no part is in the view
                target.depth.write(EMPTY.to_bytes(4, "little") * (view.size[0] * view.size[1]))
            return read_picture(target, order)
        finally:
            target.release()


_drawing: _Drawing | None = None


def _here() -> _Drawing:
    global _drawing
    if _drawing is None:
        _drawing = _Drawing()
    return _drawing


def draw_part(
    part: PartOfSet,
    request: Request,
    fiblets: FibletSet | None = None,
    filtering: Filter | None = None,
    volume: Any = None,
) -> SparsePicture:
    """Draw a part of a set; runs on a worker."""
    here = _here()
    return here.run(lambda: here.draw(part, request, fiblets, filtering, volume))


def merge_parts(one: SparsePicture, other: SparsePicture) -> SparsePicture:
    """Put two pictures together, and note what that took; runs where one of them is."""
    begun = time.perf_counter()
    found = nearer(one, other)
    return replace(found, costs=(*found.costs, Cost("merge", time.perf_counter() - begun, found.nbytes)))


def value_range_of_part(
    part: PartOfSet, values: str, pipeline: str, fiblets: FibletSet | None = None
) -> tuple[float, float]:
    """Return the range of a per-point value of a part; runs on a worker."""
    here = _here()
    found: tuple[float, float] = here.run(lambda: here.renderer(part, fiblets, pipeline).value_range(values))
    return found


def source_of(fiblets: FibletSet) -> tuple[str, str | None]:
    """Return key and path of a set: of the file that it is mapped from, if it is from one."""
    # The key tells files apart by size and time of change, sets in shards by their manifests, and sets in memory by
    # where they are.
    if isinstance(fiblets, UnreadSet):
        manifest = fiblets.shards.manifest.to_json().encode()
        return f"{fiblets.shards.name} {hashlib.sha256(manifest).hexdigest()}", None
    name = getattr(fiblets.codes, "filename", None)
    if name is None:
        return f"memory {os.getpid()} {id(fiblets)}", None
    path = Path(name).resolve()
    return _key_of(path), str(path)


def _key_of(path: Path) -> str:
    told = path.stat()
    return f"{path} {told.st_size} {told.st_mtime_ns}"


def _part_of_file(part: PartOfSet) -> FibletSet:
    from ....codec.fibletset import FibletSet
    from .parts import Stretches

    assert part.path is not None
    path = Path(part.path)
    if not path.is_file():
        raise EngineError(
            f"worker {os.uname().nodename if hasattr(os, 'uname') else ''} finds no {path}; put the set where all "
            "workers see it under the same name, or read it into memory first"
        )
    if _key_of(path) != part.key:
        raise EngineError(f"{path} is another file on this worker, or has been changed since it was opened")
    whole = FibletSet.open(path)
    return Stretches.of_count(whole, part.count).part(part.number)
