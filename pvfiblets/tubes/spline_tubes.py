"""SplineTubes: tubes of varying radius around Hermite splines, as nodes and segments.

A tube is the volume that a sphere sweeps whose centre and radius follow Hermite splines (Russig et al. 2020, section
3.1). Nodes carry position, radius, values and the derivatives of all of these; a segment names the two nodes it
leads from and to. That is all the shape there is: tubes form from segments that fit together. Nodes in more than two
segments are bifurcations, nodes that stand twice with different tangents are sharp corners. Which tube a segment
belongs to is kept beside, for colours and picking only.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from pvfiblets.support.real_numbers import is_number, real_numbers
from pvfiblets.support.value_reference import value_reference

Doubles: TypeAlias = npt.NDArray[np.float64]
Ints: TypeAlias = npt.NDArray[np.int64]
Bounds: TypeAlias = tuple[float, float, float, float, float, float]

_BLOCK = 1 << 16  # segments handled at a time: their working arrays stay in cache


@dataclass(frozen=True, eq=False)
class NodeValues:
    """One attribute at every node, interpolated between nodes as the position is."""

    # ``(n_nodes,)`` float64 numbers, or ``(n_nodes, 4)`` float64 RGBA from 0 to 1. Numbers that are not finite stand
    # for "no value".
    values: Doubles
    # Derivatives in the same shape, finite; per mm or per segment parameter, as the tubes' tangents are
    slopes: Doubles

    def __post_init__(self) -> None:
        """Take both as float64 and check them."""
        values, slopes = _doubles(self.values, "values"), _doubles(self.slopes, "slopes")
        if values.ndim != 1 and not (values.ndim == 2 and values.shape[1] == 4):
            raise ValueError(f"values have the shape {values.shape}, expected (n_nodes,) numbers or (n_nodes, 4) RGBA")
        if slopes.shape != values.shape:
            raise ValueError(f"slopes have the shape {slopes.shape}, expected {values.shape} as the values have")
        _check_finite(slopes, "slope")
        if values.ndim == 2 and not np.all((values >= 0.0) & (values <= 1.0)):
            bad = int(np.flatnonzero(~((values >= 0.0) & (values <= 1.0)).all(axis=1))[0])
            raise ValueError(f"colour {bad} is {values[bad].tolist()}, expected RGBA from 0 to 1; divide bytes by 255")
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "slopes", slopes)

    def __len__(self) -> int:
        return len(self.values)

    @cached_property
    def reference(self) -> float:
        """Offset subtracted from numbers on the graphics card; 0 for colours."""
        return 0.0 if self.is_colour else value_reference(self.values)

    @property
    def is_colour(self) -> bool:
        """Whether these are RGBA rather than numbers."""
        return self.values.ndim == 2

    @property
    def nbytes(self) -> int:
        """Bytes of both arrays."""
        return self.values.nbytes + self.slopes.nbytes


@dataclass(frozen=True, eq=False)
class SplineTubes:
    """Hermite spline tubes: nodes, segments, and the tube of each segment.

    Arrays are not copied if their type fits; do not change them afterwards.

    Parameters
    ----------
    points : array_like
        ``(n_nodes, 3)`` float64, mm: node positions, finite.
    segments : array_like
        ``(n_segments, 2)`` int64: start and end node of each segment. A node may be in any number of segments.
        A segment from a node to itself with a zero tangent is a sphere.
    radius : array_like
        ``(n_nodes,)`` float64, mm: finite, 0 or more.
    tangents : array_like
        ``(n_nodes, 3)`` float64: derivative of the position, finite.
    radius_slopes : array_like
        ``(n_nodes,)`` float64: derivative of the radius, finite.
    scaled : bool
        True: derivatives are by length (mm/mm; values per mm). Each segment multiplies them by the distance of its
        nodes. False: derivatives are by the segment's parameter from 0 to 1 (the paper's t_i).
    tubes : array_like
        ``(n_segments,)`` int64: tube of each segment, 0 to ``n_tubes - 1``.
    n_tubes : int
        Number of tubes, including tubes without segments.
    values : mapping of str to NodeValues, optional
        Arrays to colour by, with one row per node.
    tube_values : mapping of str to array, optional
        ``(n_tubes,)`` or ``(n_tubes, k)`` arrays: one row per tube.

    Raises
    ------
    ValueError
        If a shape is wrong, an index is out of range, a number is not finite or a radius is negative; the message
        names the array and the first bad row.

    Examples
    --------
    A straight tube of 10 mm that widens from 1 mm to 2 mm:

    >>> from pvfiblets import SplineTubes
    >>> tubes = SplineTubes(
    ...     points=[[0, 0, 0], [10, 0, 0]], segments=[[0, 1]], radius=[1, 2], tangents=[[1, 0, 0], [1, 0, 0]],
    ...     radius_slopes=[0.1, 0.1], scaled=True, tubes=[0], n_tubes=1,
    ... )
    >>> tubes.n_segments
    1
    """

    points: Doubles
    segments: Ints
    radius: Doubles
    tangents: Doubles
    radius_slopes: Doubles
    scaled: bool
    tubes: Ints
    n_tubes: int
    values: Mapping[str, NodeValues] = field(default_factory=dict)
    tube_values: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Take the arrays in their types and check that they fit together."""

        def put(name: str, value: object) -> None:
            object.__setattr__(self, name, value)

        points = _doubles(self.points, "points")
        if points.size == 0:
            points = points.reshape(0, 3)
        n = len(points)
        put("points", _shaped(points, "points", (n, 3), "(n_nodes, 3)"))
        for name, shape in (("tangents", (n, 3)), ("radius", (n,)), ("radius_slopes", (n,))):
            array = _doubles(getattr(self, name), name)
            array = array.reshape(shape) if array.size == 0 == n else array
            put(name, _shaped(array, name, shape, f"{shape}: one row for each of the {n} points"))
        for name, what in (("points", "point"), ("tangents", "tangent"), ("radius", "radius"),
                           ("radius_slopes", "radius slope")):
            _check_finite(getattr(self, name), what)
        if n and self.radius.min() < 0.0:
            bad = int(np.argmax(self.radius < 0.0))
            raise ValueError(f"radius {bad} is {self.radius[bad]:g} mm, expected 0 or more; clip the radii at 0")
        segments = _integers(self.segments, "segments")
        if segments.size == 0:
            segments = segments.reshape(0, 2)
        put("segments", _shaped(segments, "segments", (len(segments), 2), "(n_segments, 2)"))
        _check_range(self.segments, n, "segment", "points")
        put("n_tubes", int(self.n_tubes))
        put("tubes", _shaped(_integers(self.tubes, "tubes"), "tubes", (len(segments),), "one tube for each segment"))
        _check_range(self.tubes, self.n_tubes, "the tube of segment", "tubes")
        put("scaled", bool(self.scaled))
        for key, rows in self.values.items():
            if len(rows) != n:
                raise ValueError(f"values[{key!r}] have {len(rows)} rows, expected one for each of the {n} points")
        put("values", dict(self.values))
        put("tube_values", {key: np.asarray(value) for key, value in self.tube_values.items()})
        for key, array in self.tube_values.items():
            if array.ndim == 0 or len(array) != self.n_tubes:
                raise ValueError(
                    f"tube_values[{key!r}] has the shape {array.shape}, expected a row for each of {self.n_tubes} tubes"
                )

    def __repr__(self) -> str:
        facts = [f"{self.n_tubes:,} tubes", f"{self.n_segments:,} segments", f"{self.n_nodes:,} nodes"]
        facts += [f"{title}: {', '.join(d)}" for title in ("values", "tube_values") if (d := getattr(self, title))]
        return f"<SplineTubes: {'; '.join(facts)}>"

    # ------------------------------------------------------------------ sizes

    @property
    def n_nodes(self) -> int:
        """Number of nodes, including nodes without a segment."""
        return len(self.points)

    @property
    def n_segments(self) -> int:
        """Number of segments of all tubes together."""
        return len(self.segments)

    @property
    def n_streamlines(self) -> int:
        """Number of tubes, under the name that mappers use."""
        return self.n_tubes

    def value_reference(self, name: Any) -> float:
        """Return the offset subtracted from values on the graphics card."""
        return self.values[name].reference if name in self.values else 0.0

    @property
    def n_points(self) -> int:
        """Number of nodes, under the name that mappers use."""
        return self.n_nodes

    @property
    def promise(self) -> float:
        """Greatest distance of drawn positions from the given ones, mm: nodes are kept as they are."""
        return 0.0

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays."""
        own = (self.points, self.segments, self.radius, self.tangents, self.radius_slopes, self.tubes)
        kept: list[Any] = [*own, *self.values.values(), *self.tube_values.values()]
        return sum(a.nbytes for a in kept)

    # ------------------------------------------------------------------ geometry

    @cached_property
    def bounds(self) -> Bounds:
        """(xmin, xmax, ymin, ymax, zmin, zmax) in mm, around every tube; six NaN without segments.

        They enclose the spheres around each cubic's Bézier points, so the drawn tubes lie inside.
        """
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        for first in range(0, self.n_segments, _BLOCK):
            ends = self.segments[first : first + _BLOCK]
            places = self.points[ends]
            third = np.ones(len(ends))
            if self.scaled:
                third = np.linalg.norm(places[:, 1] - places[:, 0], axis=1)
            # Out of the end, on into the segment: forwards at its start, backwards at its end.
            third = third[:, None] * (np.array([1.0, -1.0]) / 3.0)
            inner = places + third[..., None] * self.tangents[ends]
            radius = self.radius[ends]
            inner_radius = np.maximum(radius + third * self.radius_slopes[ends], 0.0)
            for centre, reach in ((places, radius), (inner, inner_radius)):
                low = np.minimum(low, (centre - reach[..., None]).min(axis=(0, 1)))
                high = np.maximum(high, (centre + reach[..., None]).max(axis=(0, 1)))
        if not self.n_segments:
            low[:] = high[:] = np.nan
        return cast("Bounds", tuple(np.stack([low, high], axis=1).ravel().tolist()))

    @cached_property
    def joined_ends(self) -> npt.NDArray[np.bool_]:
        """``(n_segments, 2)`` bool: True if the start, or the end, of a segment continues in another segment.

        The two segments share the node, or have two nodes of equal position and radius, and derivatives in one
        direction; their surfaces meet smoothly there. False for a segment from a node to itself.
        """
        moving = self.segments[:, 0] != self.segments[:, 1]
        node = self._equal_at_ends()[self.segments]
        starts, stops = np.zeros((2, self.n_nodes), bool)
        starts[node[moving, 0]] = True
        stops[node[moving, 1]] = True
        joined = np.stack([stops[node[:, 0]], starts[node[:, 1]]], axis=1)
        return cast("npt.NDArray[np.bool_]", joined & moving[:, None])

    def _equal_at_ends(self) -> Ints:
        """(n_nodes,): each node, or for nodes in one segment only the first equal one: few are, where tubes end."""
        uses = np.bincount(self.segments.ravel(), minlength=self.n_nodes)
        ends = np.flatnonzero(uses == 1)
        slopes = np.column_stack([self.tangents, self.radius_slopes])[ends]
        sizes = chord_lengths(slopes)
        directions = np.round(slopes / np.where(sizes > 0.0, sizes, 1.0)[:, None], 9)
        rows = np.column_stack([self.points[ends], self.radius[ends], directions]) + 0.0  # -0 is 0
        _, first, group = np.unique(rows, axis=0, return_index=True, return_inverse=True)
        node = np.arange(self.n_nodes)
        node[ends] = ends[first[group.ravel()]]
        return node

    def lengths(self) -> Doubles:
        """``(n_segments,)`` float64: each segment's chord, the distance between its two nodes in mm."""
        result = np.empty(self.n_segments)
        for first in range(0, self.n_segments, _BLOCK):
            ends = self.segments[first : first + _BLOCK]
            chord = self.points[ends[:, 1]] - self.points[ends[:, 0]]
            result[first : first + _BLOCK] = chord_lengths(chord)
        return result

    def with_segments(self, kept: npt.NDArray[np.bool_]) -> SplineTubes:
        """Return the same nodes and tubes with some of the segments, ``(n_segments,)`` bool."""
        return replace(self, segments=self.segments[kept], tubes=self.tubes[kept])

    def subset(self, tubes: npt.ArrayLike) -> SplineTubes:
        """Return the chosen tubes, in the given order, with their nodes and values.

        Parameters
        ----------
        tubes : array_like
            Tube indices, each at most once, or a boolean mask ``(n_tubes,)``.

        Returns
        -------
        SplineTubes
            Tube ``i`` of the result is tube ``tubes[i]`` of this object.

        Raises
        ------
        IndexError
            If an index is out of range or repeated, or a mask has the wrong length.
        """
        chosen = np.asarray(tubes)
        if chosen.dtype == bool:
            if chosen.shape != (self.n_tubes,):
                raise IndexError(f"a mask of shape {chosen.shape} cannot select among {self.n_tubes} tubes")
            chosen = np.flatnonzero(chosen)
        chosen = chosen.astype(np.int64).reshape(-1)
        if len(chosen) and (chosen.min() < 0 or chosen.max() >= self.n_tubes):
            raise IndexError(f"tubes {chosen.min()} to {chosen.max()} do not exist; there are {self.n_tubes} tubes")
        new = np.full(self.n_tubes, -1, np.int64)
        new[chosen] = np.arange(len(chosen))
        if len(chosen) != np.count_nonzero(new >= 0):
            raise IndexError("a tube is repeated; give each index once")
        keep = np.flatnonzero(new[self.tubes] >= 0)
        keep = keep[np.argsort(new[self.tubes[keep]], kind="stable")]
        nodes, segments = np.unique(self.segments[keep], return_inverse=True)
        return SplineTubes(
            self.points[nodes],
            segments.reshape(-1, 2),
            self.radius[nodes],
            self.tangents[nodes],
            self.radius_slopes[nodes],
            self.scaled,
            new[self.tubes[keep]],
            len(chosen),
            {key: NodeValues(v.values[nodes], v.slopes[nodes]) for key, v in self.values.items()},
            {key: v[chosen] for key, v in self.tube_values.items()},
        )

    def simplify(self, tolerance: float, *, value_share: float = 0.01) -> SplineTubes:
        """Merge segments within an error bound.

        A run of segments of one tube becomes one segment between two of the old nodes. These nodes stay as they are:
        also the simplified tubes are smooth. Ends, bifurcations and points where tubes meet are always kept.

        Parameters
        ----------
        tolerance : float
            Greatest distance in mm, above 0, between the axis before and after: every point of one has a point of the
            other this near, in the same order along the tube (Fréchet distance). There, radii differ by no more than
            `tolerance` either, so that surfaces are apart by at most twice that. The bound holds for the merged
            cubics, and for the quadratic halves that are drawn for them.
        value_share : float, default: 0.01
            Greatest difference of ``values`` at these points, above 0: a share of the range of each array's finite
            numbers; of colours, of 0..1. A run has either finite values or none. Directions have no bound of their
            own.

        Returns
        -------
        SplineTubes
            Nodes in use, fewer segments in the same order, the same tubes and ``tube_values``. With
            ``scaled=False``, a merged segment has its own nodes where the next one's derivatives differ in size; such
            ends still count as `joined_ends`. Segments at bifurcations are then kept.

        Raises
        ------
        ValueError
            If `tolerance` or `value_share` is not a number above 0.

        Notes
        -----
        Based on the outlook of Russig et al. 2020, section 5. Runs are found one after the other, each as long as the
        bound allows: time grows with the number of segments.

        Examples
        --------
        >>> import numpy as np
        >>> from pvfiblets.tubes import as_spline_tubes
        >>> t = np.linspace(0, 6, 1000)
        >>> tubes = as_spline_tubes(np.stack([10 * np.cos(t), 10 * np.sin(t), t], axis=1), radius=0.5)
        >>> tubes.n_segments, tubes.simplify(0.05).n_segments
        (999, 8)
        """
        for name, number, what in (
            ("tolerance", tolerance, "distance in mm above 0, such as 0.05"),
            ("value_share", value_share, "share of each array's range above 0, such as 0.01"),
        ):
            if not (is_number(number) and number > 0.0):
                raise ValueError(f"{name} is {number!r}, expected a {what}")
        from .merge_kernels import find_chains, merge

        lengths = self.lengths()
        order, offsets = np.empty(self.n_segments, np.int64), np.zeros(self.n_segments + 1, np.int64)
        n_chains = find_chains(self._followers(), order, offsets)
        # Rows are the nodes of all chains, one after the other: one more than the chain has segments.
        offsets = offsets[: n_chains + 1] + np.arange(n_chains + 1)
        chain = np.repeat(np.arange(n_chains), np.diff(offsets) - 1)
        ids, steps = np.empty(offsets[-1], np.int64), np.zeros(offsets[-1])
        ids[np.arange(self.n_segments) + chain + 1] = self.segments[order, 1]
        ids[offsets[:-1]] = self.segments[order[offsets[:-1] - np.arange(n_chains)], 0]
        steps[np.arange(self.n_segments) + chain] = lengths[order]
        kept = np.zeros(len(ids), bool)
        nodes, slopes = self._in_tolerances(float(tolerance), float(value_share))
        merge(nodes[ids], slopes[ids], steps, ids, offsets, self.scaled, float(tolerance), kept)

        rows = np.flatnonzero(kept)
        sums = np.add.reduceat(steps, rows) if len(rows) else steps
        inner = np.ones(len(rows), bool)
        inner[np.searchsorted(rows, offsets[1:] - 1)] = False
        begin, end = rows[inner], rows[np.flatnonzero(inner) + 1]
        first = order[begin - np.searchsorted(offsets, begin, side="right") + 1]
        ends, factors = np.stack([ids[begin], ids[end]], axis=1), np.ones((len(begin), 2))
        if not self.scaled:
            merged = end - begin > 1
            factors[merged] = sums[inner][merged, None] / np.stack([steps[begin], steps[end - 1]], axis=1)[merged]
        given = np.argsort(first)
        return self._with_ends(ends[given], factors[given], self.tubes[first[given]])

    def _followers(self) -> Ints:
        """(n_segments,): the segment that each may be merged with at its end, or -1."""
        start, stop = self.segments.T
        starts, stops = (np.bincount(ends, minlength=self.n_nodes) for ends in (start, stop))
        inner = (starts == 1) & (stops == 1)
        if not self.scaled:
            # Branches share their node's derivatives; a merged segment would need larger ones.
            inner[self.segments[(starts + stops > 2)[self.segments].any(axis=1)]] = False
        after = np.full(self.n_nodes, -1)
        after[start] = np.arange(self.n_segments)
        following = np.where(inner[stop], after[stop], -1)
        return np.where(self.tubes[following] == self.tubes, following, -1)

    def _in_tolerances(self, tolerance: float, share: float) -> tuple[Doubles, Doubles]:
        """Return (n_nodes, k) columns that may each differ by 1, and their derivatives."""
        with np.errstate(over="ignore", invalid="ignore"):
            nodes, slopes = [self.points / tolerance, self.radius / tolerance], [self.tangents, self.radius_slopes]
            slopes = [each / tolerance for each in slopes]
            for held in self.values.values():
                known = np.isfinite(held.values)
                low, high = 0.0, 1.0
                if not held.is_colour and known.any():
                    low, high = held.values[known].min(), held.values[known].max()
                unit = share * (high - low or 1.0)
                nodes.append(np.where(known, held.values - low, 0.0) / unit)
                slopes.append(np.where(known, held.slopes, 0.0) / unit)
                if not known.all():  # known and missing values are far apart
                    nodes.append(np.where(known, 0.0, 1e6))
                    slopes.append(np.zeros(known.shape))
            return np.column_stack(nodes), np.column_stack(slopes)

    def _with_ends(self, ends: Ints, factors: Doubles, tubes: Ints) -> SplineTubes:
        """Return these segments; a node whose derivatives have two factors becomes two."""
        rank = np.lexsort((factors.ravel(), ends.ravel()))
        nodes, factor = ends.ravel()[rank], factors.ravel()[rank]
        new = np.ones(len(rank), bool)
        new[1:] = (np.diff(nodes) != 0) | (np.diff(factor) != 0.0)
        segments = np.empty(len(rank), np.int64)
        segments[rank] = np.cumsum(new) - 1
        nodes, factor = nodes[new], factor[new]

        def grown(slopes: Doubles) -> Doubles:
            return slopes[nodes] * factor.reshape(-1, *(1,) * (slopes.ndim - 1))

        return SplineTubes(
            self.points[nodes],
            segments.reshape(-1, 2),
            self.radius[nodes],
            grown(self.tangents),
            grown(self.radius_slopes),
            self.scaled,
            tubes,
            self.n_tubes,
            {key: NodeValues(held.values[nodes], grown(held.slopes)) for key, held in self.values.items()},
            self.tube_values,
        )


def chord_lengths(chords: Doubles) -> Doubles:
    """Lengths of ``(n, k)`` vectors, right from the smallest to the largest numbers that there are."""
    largest = np.abs(chords).max(axis=1, initial=0.0)
    # Squares of numbers near 1 neither vanish nor overflow; powers of two scale without rounding.
    exponent = np.frexp(largest)[1]
    scaled = np.ldexp(chords, -exponent[:, None])
    return cast("Doubles", np.ldexp(np.sqrt(np.einsum("ij,ij->i", scaled, scaled)), exponent))


def _doubles(array: npt.ArrayLike, name: str) -> Doubles:
    return np.ascontiguousarray(real_numbers(array, name))


def _integers(array: npt.ArrayLike, name: str) -> Ints:
    result = np.asarray(array)
    if result.size and result.dtype.kind not in "iu":
        raise ValueError(f"{name} have the type {result.dtype}, expected integers")
    return np.ascontiguousarray(result, np.int64)


def _shaped(array: npt.NDArray[Any], name: str, shape: tuple[int, ...], expected: str) -> npt.NDArray[Any]:
    if array.shape != shape:
        raise ValueError(f"{name} have the shape {array.shape}, expected {expected}")
    return array


def _check_finite(array: Doubles, what: str) -> None:
    finite = np.isfinite(array)
    if not finite.all():
        bad = int(np.flatnonzero(~finite.reshape(len(array), -1).all(axis=1))[0])
        raise ValueError(
            f"{what} {bad} is {array[bad].tolist()}, expected finite numbers; leave that node out or repair it"
        )


def _check_range(indices: Ints, n: int, what: str, of: str) -> None:
    outside = (indices < 0) | (indices >= n)
    if outside.any():
        bad = int(np.argwhere(outside)[0, 0])
        raise ValueError(f"{what} {bad} is {indices[bad].tolist()}, but there are {n} {of}, counted from 0")
