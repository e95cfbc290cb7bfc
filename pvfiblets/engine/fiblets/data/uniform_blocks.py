"""Uniform blocks that every pass of a renderer shares: what the set's numbers mean, and what a camera makes of them."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import moderngl
import numpy as np
import numpy.typing as npt

from ....codec import direction_codebook, layout
from ...clipping import CLIP_PLANES_BLOCK, clip_planes_block
from ...frame import FRAME_BLOCK, frame_block, segment_pixels
from ...gl.bindings import BLOCKS, STORAGE
from ...gl.block_buffers import BlockBuffers
from ...gl.passes import has_storage
from ...gl.uniform_struct import Field, UniformStruct
from ..line_tubes import TUBES_BLOCK, tubes_block

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet
    from ...view import View
    from ..style import FibletStyle
    from .chunks import Chunk

CODING_BLOCK = UniformStruct(
    "Coding",
    Field("anchor_scale", "vec3", "mm per anchor integer, along each axis"),
    Field("radius_scale", "float", "mm per unit of a capsule's radius"),
    Field("step_low", "float", "mm: the least step of direction fiblets"),
    Field("step_span", "float", "mm from there to the greatest"),
    Field("lattice_edge", "float", "mm"),
    Field("end_vector_scale", "float", "mm per unit of an end vector"),
    Field("rotation_scales", "vec4[4]", "of each cap angle, by fours: what the integers of its rotations are times"),
)
ROTATIONS_BLOCK = UniformStruct(
    "Rotations", Field("rotations", "uvec4[1024]", "256 words a cap angle, by fours, of codec/direction_codebook.py")
)

Array = npt.NDArray[np.float64]


def decoding_features(fiblets: FibletSet, chunks: list[Chunk]) -> list[str]:
    """Return what fiblets need to be decoded, keys of :data:`pvfiblets.engine.gl.shaders.FEATURES`."""
    kinds = frozenset().union(*(chunk.kinds for chunk in chunks))
    wanted = {
        "ANCHORS_LOW": fiblets.anchors_low is not None,
        "DIRECTION": layout.Kind.DIRECTION in kinds,
        "LATTICE": bool(kinds - {layout.Kind.DIRECTION, layout.SPLINE}),
        "WIDE_LATTICE": layout.Kind.WIDE in kinds,
        "SPLINE": layout.SPLINE in kinds,
        "RANK_TO_ID": fiblets.rank_to_id is not None,
    }
    return [name for name, on in wanted.items() if on]


class SharedBlocks(BlockBuffers):
    """The blocks of one set."""

    def __init__(self, ctx: moderngl.Context, fiblets: FibletSet) -> None:
        super().__init__(ctx)
        self._fiblets = fiblets
        self.top = 2**32 - 1 if fiblets.anchors_low is not None else 2**16 - 1
        self._view: View | None = None
        self._stored = has_storage(ctx, "rotations")
        coding = CODING_BLOCK.pack(
            anchor_scale=fiblets.anchor_scale,
            radius_scale=fiblets.reach_scale,
            step_low=fiblets.step_lo,
            step_span=fiblets.step_hi - fiblets.step_lo,
            lattice_edge=fiblets.lattice,
            end_vector_scale=fiblets.parameters.end_scale,
            rotation_scales=direction_codebook.packed_scales().reshape(4, 4),
        )
        self.buffers |= {
            "rotations": ctx.buffer(ROTATIONS_BLOCK.pack(rotations=direction_codebook.packed().reshape(-1, 4))),
            "coding": ctx.buffer(coding),
            "frame": ctx.buffer(bytes(FRAME_BLOCK.nbytes)),
        }

    @cached_property
    def place(self) -> tuple[Array, Array, int]:
        """Origin of anchors and mm per anchor integer, ``(3,)`` float64, and the largest such integer."""
        fiblets = self._fiblets
        return np.asarray(fiblets.origin, np.float64), np.asarray(fiblets.anchor_scale, np.float64), self.top

    def bind(self) -> None:
        """Bind the blocks that every program has."""
        for name, block in (("frame", "Frame"), ("coding", "Coding"), ("rotations", "Rotations")):
            self.buffers[name].bind_to_uniform_block(BLOCKS[block])
        if self._stored:
            self.buffers["rotations"].bind_to_storage_buffer(STORAGE["rotations"])

    def forget_camera(self) -> None:
        """Have positions count from the first anchor's, so that measurements do not depend on the camera."""
        self.buffers["frame"].write(bytes(FRAME_BLOCK.nbytes))

    def write_camera(self, view: View, style: FibletStyle) -> tuple[bool, bool]:
        """Bring the blocks of the camera up to date; say whether anything may cross the edges, or planes."""
        self._view = view
        block, margin = frame_block(view, style, *self.place)
        radius = self._fiblets.parameters.largest_radius
        self.buffers["frame"].write(block)
        tubes = None if style.radius is None else tubes_block(view, style.radius, *self.place)
        self.put("tubes", TUBES_BLOCK, tubes)
        radius += style.radius or 0.0
        planes = clip_planes_block(view, style.half_width, *self.place, radius)
        return margin < radius, self.put("clip_planes", CLIP_PLANES_BLOCK, planes)

    def segment(self) -> float:
        """Return roughly how many pixels the longest segments take in the last view."""
        # Where steps vary, four times their mean stands for the longest.
        return 0.0 if self._view is None else segment_pixels(self._view, *self.place, 4.0 * self._fiblets.step)
