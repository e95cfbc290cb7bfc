"""Slots of streamlines coded by compiled kernels: for large sets."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numba
import numpy as np
import numpy.typing as npt

from ...support.array_types import Int64s, UInt8s
from ..direction_codebook import cap_ratios, directions, quaternions
from ..jit import parallel_kernel
from ..kernels import beam_kernels, direction_kernels, lattice_kernels, nearest, spline_kernels, turn_kernels
from ..layout import CAPS

if TYPE_CHECKING:
    from ..parameters import Effort, Parameters

Ints = npt.NDArray[np.int64]


@cache
def search_tables() -> tuple[npt.NDArray[Any], ...]:
    """Return the tables of the encoder's search: quaternions, directions, ratios, and candidates of all cap angles."""
    rows = [nearest.candidates(cap) for cap in range(CAPS)]
    base = np.cumsum([0] + [len(r.codes) for r in rows[:-1]])
    start = np.stack([r.start + b for r, b in zip(rows, base, strict=True)]).astype(np.int32)
    return quaternions().astype(np.float64), directions(), cap_ratios(), start, np.concatenate([r.codes for r in rows])


class CompiledCoder:
    """Cuts and codes the streamlines of one chunk."""

    def __init__(
        self,
        points: npt.NDArray[np.floating],  # `(n, 3)` float32 or float64, mm
        offsets: Ints,  # `(n_streamlines + 1,)` int64
        parameters: Parameters,
        # only segments longer than the first (mm) count; sine of the largest angle, and its
        # chord in the unit circle
        bound: tuple[float, float, float],
        effort: Effort = "fast",
    ) -> None:
        # One type of points, so that no kernel is compiled twice.
        self._points = points.astype(np.float64, copy=False)
        self._offsets, self._parameters, self._bound = offsets, parameters, bound
        self._kernels = beam_kernels if effort == "high" else direction_kernels
        self._splines = effort == "small"
        self._grid = np.array(parameters.anchor_scale), 2.0**parameters.anchor_bits - 1.0
        self._origin = np.array(parameters.origin)

    def cut(self) -> tuple[Ints, Ints]:
        """Slots ``(m, 2)`` of at most 60 points: first point and count; number of slots of each streamline."""
        per = np.zeros(len(self._offsets) - 1, np.int64)
        turn_kernels.cut(self._points, self._offsets, self._bound, per, per, np.empty((0, 2), np.int64))
        slots, at = np.empty((int(per.sum()), 2), np.int64), np.cumsum(per) - per
        if len(slots):
            turn_kernels.cut(self._points, self._offsets, self._bound, per, at, slots)
        return slots, per

    def code_directions(self, slots: Ints, end: npt.NDArray[np.uint8], out: tuple[npt.NDArray[Any], ...]) -> None:
        """Try to code every slot that is not `ok` with direction bytes, or by a spline of fewer."""
        # `out` is `ok`, `kind`, `shape`, `step`, `cap`, `radius` (mm), `end_words` of `m` slots, and `codes (n,)`, in
        # which a slot's codes stand where its points stand.
        p = self._parameters
        ok, kind, shape, step, cap, radius, end_words, codes = out
        for tails in (False, True) if self._splines else ():
            spline_kernels.encode_splines(
                self._points, self._origin, slots, *self._grid, p.lattice, p.budget, self._bound, p.end_scale,
                spline_kernels.NORMAL_EQUATIONS, tails, (ok, kind, shape, step, cap, radius, end, end_words, codes),
            )  # fmt: skip
        self._kernels.encode_directions(
            self._points, self._origin, slots, *self._grid, (p.step_lo, p.step_hi), p.budget, self._bound,
            p.end_scale, search_tables(), (ok, shape, step, cap, radius, end, end_words, codes),
        )  # fmt: skip

    def gather(self, codes: npt.NDArray[np.uint8], first: Ints, size: Ints, at: Ints, out: Any) -> None:
        """Copy runs of ``size`` codes from ``first`` to ``at``."""
        _gather(codes, first, size, at, out)

    def plan_lattices(self, slots: Ints, end: npt.NDArray[np.uint8], wanted: Ints) -> tuple[Ints, Ints]:
        """Plan how slots ``wanted`` are split: number of pieces, and bytes of their codes."""
        pieces, size = np.zeros(len(wanted), np.int64), np.zeros(len(wanted), np.int64)
        self._cuts = np.zeros(len(self._points), np.uint8)
        lattice_kernels.plan_lattices(
            self._points, self._origin, slots, wanted, end, *self._grid, self._parameters.lattice, self._bound,
            pieces, size, self._cuts,
        )  # fmt: skip
        return pieces, size

    def code_lattices(
        self, slots: Ints, end: npt.NDArray[np.uint8], wanted: Ints, at: Ints, out: tuple[npt.NDArray[Any], ...]
    ) -> None:
        """Code slots ``wanted`` as planned; ``at`` and ``out`` as in `lattice_kernels.encode_lattices`."""
        p = self._parameters
        lattice_kernels.encode_lattices(
            self._points, self._origin, slots, wanted, *self._grid, p.lattice, self._bound, p.end_scale,
            self._cuts, end, at, out,
        )  # fmt: skip


@parallel_kernel
def _gather(codes: UInt8s, first: Int64s, size: Int64s, at: Int64s, packed: UInt8s) -> None:
    for run in numba.prange(len(first)):
        for i in range(size[run]):
            packed[at[run] + i] = codes[first[run] + i]
