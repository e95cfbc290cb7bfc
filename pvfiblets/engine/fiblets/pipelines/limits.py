"""Limits of a pipeline: the driver's, or the user's where they are less."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl

from ...gl.moderngl_extras import GLExtras
from ...gl.passes import work_groups
from ...gl.work_limits import WorkLimits
from .constants import CLASSES, LIST_SHARE, VISIBILITY_WORDS

TEXTURED = ("tessellation", "geometry")
"""Pipelines that read data through buffer textures, and need no storage buffers."""

MARKED = 2**32 - 2
"""Fiblets that have numbers of their own, beside that of no fiblet."""

MESH = ("mesh", "mesh-serial")

LARGEST = 2**31 - 4
"""Bytes of a buffer, whatever a driver allows: what shaders count in a chunk then fits into 32 bits (``chunks.py``)."""

_VISIBILITY_BYTES = {"texture": 32, "buffer": 4 * (VISIBILITY_WORDS + 32 * CLASSES // LIST_SHARE)}  # for 32 fiblets


@dataclass(frozen=True)
class Limits:
    """Limits of a pipeline on a context; made by :meth:`from_context`."""

    buffer_bytes: int  # Of one buffer of records
    groups: int  # Compute work groups along one axis; 0 where there are none
    marks: int  # Fiblets with a visibility bit in the pipeline
    marked_by: str  # Name of the resource that holds them
    fiblets: int  # Of one buffer of records, and with that of one call (:mod:`pvfiblets.engine.gl.work_limits`)
    call: int = LARGEST  # Fiblets of one call, where a buffer has several
    clustered: bool = False  # Whether chunks have clusters (:mod:`pvfiblets.engine.fiblets.data.clusters`)

    def visibility_bytes(self, n_fiblets: int) -> int:
        """Bytes of those marks, and of the mesh pipeline's marks of open fiblets."""
        opened = 8 if self.clustered and self.marked_by == "texture" else 0
        return -(-n_fiblets // 32) * (_VISIBILITY_BYTES[self.marked_by] + opened)

    @classmethod
    def from_context(
        cls, ctx: moderngl.Context, gl: GLExtras, pipeline: str, buffer_bytes: int | None, groups: int | None
    ) -> Limits:
        """Query the driver, and take the lesser limit."""
        work, listed = WorkLimits.from_context(ctx).fiblets, WorkLimits.from_context(ctx).listed
        side = gl.get_integer("GL_MAX_TEXTURE_SIZE")
        if pipeline in TEXTURED:
            # Of the buffers that decide how many fiblets a chunk holds, every texel has four bytes.
            most = min(4 * gl.get_integer("GL_MAX_TEXTURE_BUFFER_SIZE"), LARGEST)
            return cls(min(most, buffer_bytes or most), 0, side * side, "texture", work)
        most = gl.get_integer("GL_MAX_SHADER_STORAGE_BLOCK_SIZE")
        axis = work_groups(ctx)
        most = min(most, LARGEST)
        groups, records = min(axis, groups or axis), min(most, buffer_bytes or most)
        if pipeline in MESH:
            return cls(records, groups, side * side, "texture", work)
        return cls(records, groups, MARKED, "buffer", LARGEST, listed)
