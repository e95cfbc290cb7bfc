"""Slots of streamlines coded by NumPy alone: for small sets, which are coded before kernels would be loaded.

The answer is that of the kernels, bit for bit. Two microseconds a point on one core is the price.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import direction_arrays, lattice_arrays, turn_arrays

if TYPE_CHECKING:
    from ..parameters import Parameters

Ints = npt.NDArray[np.int64]


class ArrayCoder:
    """Cuts and codes the streamlines of one chunk; parameters and methods as of :class:`.CompiledCoder`."""

    def __init__(
        self,
        points: npt.NDArray[np.floating],
        offsets: Ints,
        parameters: Parameters,
        bound: tuple[float, float, float],
    ) -> None:
        p = self._parameters = parameters
        self._offsets, self._bound = offsets, bound
        self._source = lattice_arrays.Source(
            points, np.array(p.origin), np.array(p.anchor_scale), 2.0**p.anchor_bits - 1.0, p.lattice,
            turn_arrays.turning(points, offsets, bound),
        )  # fmt: skip

    def cut(self) -> tuple[Ints, Ints]:
        """Slots ``(m, 2)`` of at most 60 points: first point and count; number of slots of each streamline."""
        return turn_arrays.cut(self._offsets, self._source.turning.bends, self._bound)

    def code_directions(self, slots: Ints, end: npt.NDArray[np.uint8], out: tuple[npt.NDArray[Any], ...]) -> None:
        """Try to code every slot with direction bytes."""
        s, p = self._source, self._parameters
        ok, _, *rest = out
        direction_arrays.encode_directions(
            s.points, s.origin, slots, end, s.scale, s.top, (p.step_lo, p.step_hi), p.budget, s.turning, p.end_scale,
            (ok, *rest),
        )  # fmt: skip

    def gather(self, codes: npt.NDArray[np.uint8], first: Ints, size: Ints, at: Ints, out: Any) -> None:
        """Copy runs of ``size`` codes from ``first`` to ``at``."""
        place = np.arange(int(size.sum())) - np.repeat(np.cumsum(size) - size, size)
        out[place + np.repeat(at, size)] = codes[place + np.repeat(first, size)]

    def plan_lattices(self, slots: Ints, end: npt.NDArray[np.uint8], wanted: Ints) -> tuple[Ints, Ints]:
        """Plan how slots ``wanted`` are split: number of pieces, and bytes of their codes."""
        pieces, size, cuts = lattice_arrays.plan_lattices(self._source, slots[wanted], end[wanted] == 0)
        self._plan = pieces, cuts
        return pieces, size

    def code_lattices(
        self, slots: Ints, end: npt.NDArray[np.uint8], wanted: Ints, at: Ints, out: tuple[npt.NDArray[Any], ...]
    ) -> None:
        """Code slots ``wanted`` as planned."""
        lattice_arrays.encode_lattices(
            self._source, slots[wanted], end[wanted] == 0, self._plan, self._parameters.end_scale, at, out
        )
