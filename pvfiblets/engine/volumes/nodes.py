"""The octree's nodes as a list on the GPU: what each says to rays depends on what there is to see."""

from __future__ import annotations

import time
from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...volumes.octree import HOMOGENEOUS, SKIP, Octree, build_octree, flags, homogeneous
from ...volumes.raycast_options import PROJECTIONS, RaycastOptions
from ...volumes.volume import RaycastVolume
from ..errors import EngineError
from ..gl.bindings import VOLUMES
from ..gl.moderngl_extras import BufferTexture, GLExtras

WORTH = 0.5
"""Part of the leaves that are looked into which must be even for rays to ask of each: fewer, and asking costs more than
it saves. Measured on two cores: 1.5 times as fast from 0.5 on, 1.08 at 0.4, 0.9 where there are none."""


class NodeList:
    """Numbers of all nodes of one volume's octree, leaves first (``shaders/volumes/nodes.glsl``)."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, volume: RaycastVolume) -> None:
        self._ctx, self._gl, self._volume = ctx, gl, volume
        self._octrees: dict[int, Octree] = {}
        self._took: dict[int, float] = {}
        self._made_for: object = None
        self._lists: dict[str, tuple[moderngl.Buffer, BufferTexture]] = {}
        # (n_levels, 4) int64: nodes along each axis, and place of the first
        self.levels: npt.NDArray[np.int64] = np.zeros((0, 4), np.int64)
        self.skipped = 0.0  # share of invisible leaves; 0 for peaks, where it depends on the ray
        # whether nodes that are even are taken as their mean: where it was asked for, and there are enough of them
        self.takes_means = False
        # what the octree costs: its `bytes`, their `share` of the volume's, and `ms` that building it took. All are 0
        # while rays skip nothing: then there is none, neither here nor on the GPU.
        self.octree: dict[str, float] = {}

    def make(self, casting: RaycastOptions) -> None:
        """Bring the list up to date."""
        key = (
            casting.octree, casting.mode, casting.filter, casting.values, casting.transfer, casting.low, casting.high,
            casting.homogeneous, casting.recon,
        )  # fmt: skip
        if self._made_for == key:
            return
        self.release()
        if not casting.octree:
            self._octrees.clear()
            self.octree = {"bytes": 0, "share": 0.0, "ms": 0.0}
            self.levels, self.skipped, self.takes_means = np.zeros((0, 4), np.int64), 0.0, False
            self._made_for = key
            return
        margin = 2 if casting.filter == "tricubic" else 1
        if margin not in self._octrees:
            start = time.perf_counter()
            self._octrees[margin] = build_octree(self._volume, margin)
            self._took[margin] = 1e3 * (time.perf_counter() - start)
        octree = self._octrees[margin]
        share = octree.nbytes / self._volume.values.nbytes
        self.octree = {"bytes": octree.nbytes, "share": share, "ms": self._took[margin]}
        numbers = _numbers(octree, casting)
        starts = np.cumsum([0, *(level.size for level in numbers)])[:-1]
        self.levels = np.array([[*of.shape, start] for of, start in zip(numbers, starts, strict=True)], np.int64)
        looked_into = casting.mode in ("isosurface", "composite")
        self.skipped = float(np.mean(numbers[0] == SKIP)) if looked_into else 0.0
        self._put("nodes", numbers)
        visited = np.count_nonzero(numbers[0] != SKIP) if looked_into else 0
        own = self._volume.colours is not None  # unknown to nodes
        even = np.count_nonzero(numbers[0] == HOMOGENEOUS) if _may_take_means(casting) and not own else 0
        self.takes_means = bool(even > 0 and even >= WORTH * visited)
        if self.takes_means:
            self._put("means", [level.mean for level in octree.levels])
        self._made_for = key

    def _put(self, name: str, levels: list[npt.NDArray[Any]]) -> None:
        data = np.concatenate([numbers.ravel(order="F") for numbers in levels]).astype("<f4")
        try:
            buffer = self._ctx.buffer(data)
        except moderngl.Error as error:
            raise EngineError(f"no memory for the {len(data)} nodes of an octree ({data.nbytes} bytes)") from error
        self._lists[name] = buffer, self._gl.texture_buffer(buffer, "r32f")

    @property
    def buffers(self) -> dict[str, moderngl.Buffer]:
        """By name."""
        return {name: buffer for name, (buffer, _) in self._lists.items()}

    def bind(self, program: moderngl.Program) -> None:
        """Bind all, and tell a program where they are."""
        for name, unit in ((name, VOLUMES[name]) for name in ("nodes", "means")):
            if name in self._lists:
                self._lists[name][1].bind(unit)
            self._gl.set_sampler(program, name, unit)

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        for buffer, texture in self._lists.values():
            texture.release()
            buffer.release()
        self._lists.clear()
        self._made_for = None


def _numbers(octree: Octree, casting: RaycastOptions) -> list[npt.NDArray[Any]]:
    """Return a number for each node: 0 where nothing is seen, of peaks the greatest value or minus the least."""
    low, high = casting.low, casting.high
    if _peaks(casting):
        down = casting.mode == "minimum"
        return [
            np.where(
                (level.greatest >= low) & (level.least <= high),
                -level.least.astype(np.float64) if down else level.greatest.astype(np.float64),
                -np.inf,
            )
            for level in octree.levels
        ]

    def visible(least: npt.NDArray[Any], greatest: npt.NDArray[Any]) -> npt.NDArray[np.bool_]:
        if casting.transfer is None:
            return np.logical_or.reduce([(least <= value) & (greatest >= value) for value in casting.values])
        return (greatest >= low) & (least <= high) & casting.transfer.visible_range(least, greatest)

    seen = flags(octree, visible)
    if casting.mode == "composite" and casting.homogeneous > 0.0:
        seen = homogeneous(octree, casting.homogeneous, seen)
    if casting.mode == "composite" and casting.recon and casting.transfer is not None:
        for before, level in zip(seen, octree.levels, strict=True):
            even = (level.least >= low) & (level.greatest <= high)
            even &= casting.transfer.even_range(level.least, level.greatest)
            before[even & (before != SKIP)] = HOMOGENEOUS
    return list(seen)


def _may_take_means(casting: RaycastOptions) -> bool:
    """Whether there may be nodes that are taken as their mean."""
    return casting.mode == "composite" and casting.octree and (casting.homogeneous > 0.0 or casting.recon)


def _peaks(casting: RaycastOptions) -> bool:
    return casting.mode in PROJECTIONS
