"""What one frame of the compute pipeline does, counted without a graphics card.

Numbers of fiblets are read from the lists that the passes made, and calls are counted on their way to OpenGL. Bytes
follow from the layouts (:mod:`pvfiblets.engine.fiblets.data.chunks` and
``shaders/fiblets/compute/visibility_bits.glsl``): what each pass reads and writes once, as if no cache helped.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from typing import Any
from unittest.mock import patch

import moderngl
import numpy as np
import numpy.typing as npt

from pvfiblets.engine import FibletRenderer
from pvfiblets.engine.fiblets.data.chunks import CLUSTER, Chunk
from pvfiblets.engine.fiblets.pipelines import ComputePipeline
from pvfiblets.engine.fiblets.pipelines.compute import (
    CANDIDATES,
    LAST_LEFT,
    NOW_LEFT,
    PREDICTED,
    REST,
    SEEN,
    TESTED,
    TIED,
)
from pvfiblets.engine.fiblets.pipelines.constants import CLASSES, GROUP_WORDS, VISIBILITY_WORDS
from pvfiblets.engine.gl.passes import GROUP_SIZE, Passes

BANDWIDTH, LATENCY = 3.35e12, 5e-6
"""Bytes a second of an NVIDIA H100, and seconds of a dispatch that waits for the one before."""

CAPSULE = 10  # bytes: anchor 8, radius 2; the end is the next one's anchor
RECORD = CAPSULE + 12 + 58 + 30  # and words, codes, and rows of the page table and rotations
ENTRY = 4  # of a list
ROUNDS = {"visible": SEEN, "predicted": PREDICTED, "depth": REST, "resolve_owner": CANDIDATES, "resolve_ties": TIED}


@dataclass
class Calls:
    """Calls of one frame, by pass."""

    dispatches: Counter[str] = field(default_factory=Counter)
    barriers: Counter[str] = field(default_factory=Counter)
    chunk_binds: Counter[str] = field(default_factory=Counter)
    full_screen_draws: Counter[str] = field(default_factory=Counter)


@contextmanager
def counted() -> Iterator[Calls]:
    """Count the calls of everything drawn meanwhile."""
    calls, where = Calls(), [""]

    def counting(owner: type, name: str, counter: Counter[str]) -> Any:
        honest: Callable[..., Any] = getattr(owner, name)

        def called(self: Any, *arguments: Any, **named: Any) -> Any:
            counter[where[-1]] += 1
            return honest(self, *arguments, **named)

        return patch.object(owner, name, called)

    timed = Passes.timed

    @contextmanager
    def passing(self: Passes, name: str) -> Iterator[None]:
        where.append(name)
        try:
            with timed(self, name):
                yield
        finally:
            where.pop()

    with ExitStack() as stack:
        stack.enter_context(patch.object(Passes, "timed", passing))
        for owner, name, counter in (
            (moderngl.ComputeShader, "run", calls.dispatches),
            (moderngl.ComputeShader, "run_indirect", calls.dispatches),
            (moderngl.Context, "memory_barrier", calls.barriers),
            (Chunk, "bind_storage", calls.chunk_binds),
            (moderngl.VertexArray, "render", calls.full_screen_draws),
        ):
            stack.enter_context(counting(owner, name, counter))
        yield calls


@dataclass(frozen=True)
class PassWork:
    """What a pass does with how many fiblets."""

    fiblets: float  # that it tests or draws; NaN of passes over pixels
    read: float  # bytes
    written: float

    def seconds(self, dispatches: int) -> float:
        """Return the least time that an H100 takes."""
        return (self.read + self.written) / BANDWIDTH + LATENCY * dispatches


def _pipeline_of(renderer: FibletRenderer) -> ComputePipeline:
    """Return the compute pipeline that a renderer draws with."""
    pipeline = renderer._pipeline  # noqa: SLF001 - its counts are of use only here
    assert isinstance(pipeline, ComputePipeline)
    return pipeline


def pass_work(renderer: FibletRenderer, pixels: int, owned: int) -> dict[str, PassWork]:
    """Return the work of the last frame by pass, given its pixels, and how many of them show something."""
    pipeline, fiblets = _pipeline_of(renderer), renderer.explain()["fiblets"]
    n = int(fiblets["total"])
    lengths = pipeline.list_lengths().sum(axis=(0, 2))
    marks, clusters = 4.0 * -(-n // 32), -(-n // CLUSTER)
    looked = CLUSTER * lengths[[LAST_LEFT, NOW_LEFT]].astype(np.float64)  # fiblets of clusters that are left
    list_pass = 4.0 * marks  # four kinds of bits
    found = {
        "clear": PassWork(np.nan, 0.0, 8.0 * pixels),
        "last picture": PassWork(np.nan, 4.0 * pixels * 4 / 3, 4.0 * pixels / 3),
        "pyramid": PassWork(np.nan, 4.0 * pixels * 4 / 3, 4.0 * pixels / 3),
    }
    clustered = bool(lengths[NOW_LEFT])
    tested = lengths[SEEN] if clustered else n
    found["cull"] = PassWork(float(tested), marks + CAPSULE * tested, VISIBILITY_WORDS * marks)
    for name, number in ROUNDS.items():
        drawn = float(lengths[number])
        shown = 16.0 * owned if name == "resolve_owner" else 0.0
        found[name] = PassWork(drawn, list_pass + (ENTRY + RECORD) * drawn, ENTRY * drawn + shown)
    if clustered:
        boxes, each = 12.0 * clusters, ENTRY + CAPSULE + 8  # order, capsule, and two words of bits
        found["predicted: tests"] = PassWork(float(looked[0]), boxes + each * looked[0], 8.0 * lengths[PREDICTED])
        found["occlusion"] = PassWork(float(looked[1]), boxes + each * looked[1], 12.0 * lengths[TESTED])
    else:
        rest = float(fiblets["in_frustum"]) - lengths[SEEN] - lengths[PREDICTED]
        found["occlusion"] = PassWork(rest, 2.0 * marks + CAPSULE * rest, 2.0 * marks)
    refined = float(lengths[TESTED])
    found["refine"] = PassWork(refined, list_pass + (ENTRY + CAPSULE) * refined, (ENTRY + 4.0) * refined)
    return found


def frame_lanes(renderer: FibletRenderer, number: int, width: int) -> float:
    """Return the share of the lanes of subgroups so wide that work in a round of the last frame; NaN without any."""
    pipeline = _pipeline_of(renderer)
    busy = issued = 0
    for chunk, lengths in enumerate(pipeline.list_lengths()):
        for part, count in enumerate(lengths[number]):
            busy += int(count)
            if count <= pipeline.list_room(chunk):
                issued += width * -(-int(count) // width)
                continue
            bits = _round_bits(pipeline.read_marks(chunk), number, part)
            sets = np.bitwise_count(np.pad(bits, (0, -len(bits) % GROUP_WORDS))).reshape(-1, GROUP_WORDS).sum(axis=1)
            whole, left = np.divmod(sets.astype(np.int64), GROUP_SIZE)
            issued += int((whole * GROUP_SIZE + width * -(-left // width)).sum())
    return busy / issued if issued else float("nan")


def _round_bits(marks: npt.NDArray[np.uint32], number: int, part: int) -> npt.NDArray[np.uint32]:
    """Return the bits of the fiblets of a round and class, as ``visibility_bits.glsl`` has them."""
    low, high, class_low, class_high, candidates, _, tied = marks
    of_round = {
        SEEN: low & ~high,
        PREDICTED: high & ~low,
        REST: low & high,
        CANDIDATES: candidates & (low | high),
        TIED: tied & (low | high),
    }[number]
    assert part < CLASSES
    of_class = (class_low if part & 1 else ~class_low) & (class_high if part & 2 else ~class_high)
    return of_round & of_class
