"""Whether a set fits into memory, asked before anything is allocated, and what share of it does.

Where free video memory can be known:

=====================  ==========================================================================================
OpenGL                 how
=====================  ==========================================================================================
software (Mesa)        the machine's own free memory, and no more than its control group allows
NVIDIA                 GL_NVX_gpu_memory_info
AMD                    GL_ATI_meminfo
others                 not at all: the driver fails while the set is copied
=====================  ==========================================================================================

Counted are the chunks' buffers, the passes' marks, the largest per-point value that a style may ask for, and a picture
of :data:`PICTURE` pixels.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import moderngl
import numpy as np

from ....codec.editing.restrict import Restriction, even_share
from ....support.memory import free_host_memory
from ...errors import EngineError, GPUMemoryError
from ...gl.moderngl_extras import INTEGERS, GLExtras
from ...gl.passes import is_software
from ..pipelines.limits import Limits
from .chunks import ChunkPlan, plan_chunks

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet

PICTURE = 1920 * 1080  # pixels of the picture that is reckoned with; larger ones live on the reserve

PICTURE_BYTES = 48 * PICTURE  # G-buffer 24; depth buffers, state kept between rounds, pyramid: 24 at most

SHARED_BYTES = 20_000  # bytes of the uniform blocks that all chunks share, with a reserve

RESERVE = 0.1  # share of the free memory that a sample leaves free

_ADVICE = "draw fewer streamlines, an even share of them by fit='sample', or all of them part by part by fit='stream'"



@dataclass(frozen=True)
class Fitted:
    """The drawn part of a set."""

    fiblets: FibletSet  # the set, or a part of it
    plans: list[ChunkPlan]  # its chunks
    share: float  # how many of the set's streamlines with points it has: 1.0 for all

    def fitting_set(self) -> FibletSet:
        """Return the set to keep once it is on the GPU: a part, without its codes."""
        return self.fiblets if self.share == 1.0 else replace(self.fiblets, codes=np.empty(0, np.uint8))


@dataclass(frozen=True)
class MemoryBudget:
    """Memory that a set may take; made by :meth:`of`."""

    limits: Limits  # of the pipeline
    video: int | None  # bytes free for buffers and pictures, None where that cannot be known
    host: int | None  # bytes free for what stays in the machine's memory
    shared: bool  # whether both are the same memory
    largest: int | None = None  # bytes that all buffers together may have, if the caller limits them

    @classmethod
    def from_context(cls, ctx: moderngl.Context, gl: GLExtras, limits: Limits, largest: int | None) -> MemoryBudget:
        """Ask the driver and the machine."""
        return cls(limits, free_memory(ctx, gl), free_host_memory(), is_software(ctx), largest)

    def fitted(self, fiblets: FibletSet, fit: str | None, most: float = 1.0) -> Fitted:
        """Plan a set, or what fits of it."""
        plans = self._plans(fiblets)
        if most >= 1.0 and (refusal := self._refusal(fiblets, plans)) is None:
            return Fitted(fiblets, plans, 1.0)
        if fit != "sample":
            assert refusal is not None
            raise refusal
        limit = min(self._fraction(fiblets, plans), most)
        share = 0.98 * limit  # streamlines differ in length: a share of them may be more than that share of the points
        while (part := Restriction(fiblets, even_share(fiblets, share))).n_ranks:
            fraction = _fraction_of(part, fiblets)
            if fraction <= limit:
                taken = part.make()
                plans = self._plans(taken)
                if (refusal := self._refusal(taken, plans)) is not None:
                    raise refusal
                return Fitted(taken, plans, part.n_ranks / fiblets.n_ranks)
            share *= 0.98 * limit / fraction
        raise GPUMemoryError(f"not one streamline fits: {self._said(fiblets, plans)}")

    def _plans(self, fiblets: FibletSet) -> list[ChunkPlan]:
        limits = self.limits
        return plan_chunks(fiblets, limits.buffer_bytes, limits.fiblets, clustered=limits.clustered)

    def _refusal(self, fiblets: FibletSet, plans: list[ChunkPlan]) -> EngineError | None:
        """Why a set does not fit."""
        if fiblets.n_fiblets > self.limits.marks:
            return EngineError(
                f"{fiblets.n_fiblets} fiblets are more than the {self.limits.marks} whose marks fit into this OpenGL's "
                f"largest {self.limits.marked_by}; {_ADVICE}"
            )
        buffers = self._buffers(fiblets, plans)
        too_many = self.largest is not None and buffers > self.largest
        too_large = self.video is not None and buffers + PICTURE_BYTES > self.video
        return GPUMemoryError(f"{self._said(fiblets, plans)}; {_ADVICE}") if too_many or too_large else None

    def _fraction(self, fiblets: FibletSet, plans: list[ChunkPlan]) -> float:
        """Return the share of a set that fits: 0 to 1."""
        # A part has the numbers of its streamlines on the GPU, and stays in memory.
        buffers = self._buffers(fiblets, plans) + 4 * fiblets.n_ranks
        host = max(fiblets.nbytes, 1)
        rooms = [self.limits.marks / max(fiblets.n_fiblets, 1)]
        if self.largest is not None:
            rooms.append((self.largest - SHARED_BYTES) / buffers)
        if self.video is not None:
            free = (1.0 - RESERVE) * self.video - PICTURE_BYTES - SHARED_BYTES
            rooms.append(free / (buffers + host if self.shared else buffers))
        if self.host is not None:
            rooms.append((1.0 - RESERVE) * self.host / host)
        return min(max(min(rooms), 0.0), 1.0)

    def needed(self, fiblets: FibletSet) -> int:
        """Bytes of all buffers that a set needs."""
        return self._buffers(fiblets, self._plans(fiblets))

    def fits(self, fiblets: FibletSet) -> bool:
        """Return whether a set fits as a whole, as far as can be known beforehand."""
        return self._refusal(fiblets, self._plans(fiblets)) is None

    @property
    def room(self) -> int | None:
        """Bytes that buffers may take beside a picture, :data:`RESERVE` less than are free; None if unknown."""
        # Half of that where both are the same memory: parts stand in it twice.
        rooms = [] if self.largest is None else [self.largest - SHARED_BYTES]
        if self.video is not None:
            free = (1.0 - RESERVE) * self.video - PICTURE_BYTES - SHARED_BYTES
            rooms.append(int(free / 2.0 if self.shared else free))
        return min(rooms, default=None)

    def _buffers(self, fiblets: FibletSet, plans: list[ChunkPlan]) -> int:
        """Bytes of all buffers that a set needs."""
        marks = self.limits.visibility_bytes(int(fiblets.n_fiblets))
        return sum(plan.nbytes + plan.values for plan in plans) + marks + SHARED_BYTES

    def _said(self, fiblets: FibletSet, plans: list[ChunkPlan]) -> str:
        """The numbers, for errors."""
        records, values = sum(plan.nbytes for plan in plans), sum(plan.values for plan in plans)
        marks = self.limits.visibility_bytes(int(fiblets.n_fiblets))
        parts = {"records and codes": records + SHARED_BYTES, "marks": marks, "values of points": values}
        rooms = [] if self.largest is None else [(self.largest, "as requested")]
        if self.video is not None:
            parts["a picture"] = PICTURE_BYTES
            rooms.append((self.video, "of the machine's own" if self.shared else "by the driver's word"))
        room, said = min(rooms)
        return (
            f"{fiblets.n_fiblets} fiblets need {sum(parts.values()) / 1e6:.1f} MB of GPU memory ("
            + ", ".join(f"{size / 1e6:.1f} for {what}" for what, size in parts.items())
            + f"), {room / 1e6:.1f} MB are available, {said}"
        )


def _fraction_of(part: Restriction, whole: FibletSet) -> float:
    """Return a part's share of a set: of its fiblets, codes or points, whichever is greatest."""
    sizes = ((part.n_fiblets, whole.n_fiblets), (part.n_codes, len(whole.codes)), (part.n_points, whole.n_points))
    return max(some / every for some, every in sizes if every)


def free_memory(ctx: moderngl.Context, gl: GLExtras) -> int | None:
    """Bytes that buffers can still take, where it can be known beforehand."""
    if is_software(ctx):
        return free_host_memory()
    for name in ("GL_GPU_MEMORY_INFO_CURRENT_AVAILABLE_VIDMEM_NVX", "GL_VBO_FREE_MEMORY_ATI"):
        if INTEGERS[name][1] in ctx.extensions:
            return 1024 * gl.get_integer(name)
    return None
