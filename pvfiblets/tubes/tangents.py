"""Derivatives at the nodes of lines, where only positions and values are known.

Lines are ragged: row ``i`` of an array is a node, and each line is a run of rows. All lines are done at once; nothing
here loops over lines or nodes. Three rules hold for every method:

* A step of no length (a node that stands twice in a row) ends one smooth piece and begins another: a sharp corner.
  So does a number that is not finite, for that attribute alone.
* A line whose last node lies where its first one lies is closed: derivatives are the same at both, as if they were one.
* Derivatives are finite, whatever the lengths: where a long step meets a very short one, over which a value jumps, the
  value's derivative is held to what keeps the long step's curve near its ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .spline_tubes import Doubles, Ints, chord_lengths

METHODS = ("finite", "catmull-rom", "natural")

_STEEPEST = 3.0
"""How far a derivative may lead along the longer step, in changes of value: a monotone cubic's limit (Fritsch and
Carlson 1980). Changes in proportion to lengths come nowhere near it."""

_HUGE = 1e300  # slopes end here: a segment's curve takes a few of their sums before its length makes them small

_SWEEPS = 6
"""Reductions after which a spline's equations are solved. A row's two neighbours weigh at most half of the row itself,
and every reduction squares that share: 2**-64 after six, however long the line is."""


@dataclass(frozen=True, eq=False)
class Steps:
    """The steps from node to node of ragged lines."""

    # `(n_nodes,)` float64, mm: from each node to the next of its line; 0 at each line's last node, which has none
    lengths: Doubles
    # `(n_nodes,)` int64: the steps that lead to and from each node, as rows of `lengths`. Where there is none, a row
    # whose length is 0. Closed lines go on at their other end.
    behind: Ints
    ahead: Ints

    @classmethod
    def between(cls, points: Doubles, offsets: Ints) -> Steps:
        """Find the steps of lines."""
        n = len(points)
        full = np.diff(offsets) > 0
        first, last = offsets[:-1][full], offsets[1:][full] - 1
        lengths = np.zeros(n)
        lengths[:-1] = chord_lengths(np.diff(points, axis=0)) if n else 0.0
        lengths[last] = 0.0
        behind, ahead = np.arange(n) - 1, np.arange(n)
        behind[first] = last
        # Fewer than three places enclose nothing: such a line goes there and back.
        closed = (last - first >= 3) & np.all(points[first] == points[last], axis=1)
        behind[first[closed]] = last[closed] - 1
        ahead[last[closed]] = first[closed]
        return cls(lengths, behind, ahead)

    def uniform(self) -> Steps:
        """The same steps, each of length 1 but for those without length: derivatives by a segment's parameter."""
        return Steps((self.lengths > 0.0).astype(np.float64), self.behind, self.ahead)


def derivatives(values: npt.ArrayLike, steps: Steps, method: str = "finite") -> Doubles:
    """Derivatives of positions or values at all nodes."""
    # The natural spline's equations for derivatives D are, row by row, `u D[i-1] + 2 D[i] + (1 - u) D[i+1] = 3 (u
    # s[i-1] + (1 - u) s[i])` with the slopes s of the two chords and the share u of the step ahead in both. They are
    # solved by cyclic reduction of all rows at once.
    if method not in METHODS:
        raise ValueError(f"method is {method!r}, expected one of {', '.join(map(repr, METHODS))}")
    if method == "catmull-rom":
        steps = steps.uniform()
    rows = np.asarray(values, np.float64)
    if len(rows) == 0:
        return np.zeros(rows.shape)
    flat = rows.reshape(len(rows), -1)
    with np.errstate(over="ignore", invalid="ignore"):
        change = np.zeros(flat.shape)
        np.subtract(flat[1:], flat[:-1], out=change[:-1])
        live = (steps.lengths > 0.0) & np.isfinite(change).all(axis=1)
        change[~live] = 0.0
        lengths = np.where(live, steps.lengths, 0.0)
        slopes = np.clip(change / np.where(live, lengths, 1.0)[:, None], -_HUGE, _HUGE)
    back, forth = lengths[steps.behind], lengths[steps.ahead]
    inner = (back > 0.0) & (forth > 0.0)
    both = np.where(inner, back + forth, 1.0)
    # The parabola leans on the nearer neighbour: the slope behind weighs as much as the step ahead is long.
    share = np.where(inner, forth / both, back > 0.0)
    rest = np.where(inner, back / both, forth > 0.0)
    mean = share[:, None] * slopes[steps.behind] + rest[:, None] * slopes[steps.ahead]
    if method == "natural":
        result = _natural(mean, share, rest, steps)
    else:
        result = _held(mean, change, back, forth, steps)
    return np.clip(result, -_HUGE, _HUGE).reshape(rows.shape)


def _held(mean: Doubles, change: Doubles, back: Doubles, forth: Doubles, steps: Steps) -> Doubles:
    """Hold central differences that lead too far along the longer of the two steps."""
    # Between steps in a proportion of up to 3 a parabola's slope cannot lead that far.
    rows = np.flatnonzero((np.minimum(back, forth) > 0.0) & (np.maximum(back, forth) / 3.0 > np.minimum(back, forth)))
    largest = np.maximum(chord_lengths(change[steps.behind[rows]]), chord_lengths(change[steps.ahead[rows]]))
    with np.errstate(over="ignore"):
        most = _STEEPEST * largest / np.maximum(back, forth)[rows]
    slope = chord_lengths(mean[rows])
    steep = slope > most
    mean[rows[steep]] *= (most[steep] / slope[steep])[:, None]
    return mean


def _natural(mean: Doubles, share: Doubles, rest: Doubles, steps: Steps) -> Doubles:
    """Solve the splines' equations, whose rows are divided by 2 so that the diagonal is 1."""
    left, right, known = 0.5 * share, 0.5 * rest, 1.5 * mean
    before, after = steps.behind, np.minimum(steps.ahead + 1, len(mean) - 1)
    for _ in range(_SWEEPS):
        # Put each neighbour's own equation in its place: the neighbours twice as far away remain.
        own = 1.0 - left * right[before] - right * left[after]
        known = (known - left[:, None] * known[before] - right[:, None] * known[after]) / own[:, None]
        left, right = -left * left[before] / own, -right * right[after] / own
        before, after = before[before], after[after]
    return known
