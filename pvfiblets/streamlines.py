"""Streamlines: the one in-memory form of a tractogram, between the formats and the codec.

All points of all streamlines lie in one ``(n_points, 3)`` array; ``offsets`` says where each
streamline begins. No Python object is made per streamline. Coordinates are millimetres in RAS+
space with voxel centres at integer voxel indices (the convention of NIfTI and nibabel).

Zero-point and one-point streamlines are legal: other files (weights, clusters) count
streamlines by position, so dropping one would shift all later ones.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, cast, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pvfiblets.line_cells import field_of, parts_of_polydata, polydata_of
from pvfiblets.support.ragged import (
    Array,
    Floats,
    Ints,
    as_affine,
    as_columns,
    as_ids,
    as_members,
    as_offsets,
    as_points,
    blocks,
    join,
    lengths,
    offsets_from_counts,
)

if TYPE_CHECKING:
    import pyvista

    from pvfiblets.query.bundles.clusters import Clusters
    from pvfiblets.query.bundles.similar import Similar
    from pvfiblets.query.measures.table import Table

__all__ = ["Streamlines", "blocks", "offsets_from_counts"]


class Streamlines:
    """Streamlines of any lengths, with data per point, per streamline and per group.

    Parameters
    ----------
    points : (n_points, 3) array of float32 or float64
        RAS+ millimetres. Other number types are converted (float16 to float32, the rest to
        float64); float32 and float64 are kept as they are, memory maps included.
    offsets : (n_streamlines + 1,) array of int64
        Streamline ``i`` is ``points[offsets[i]:offsets[i + 1]]``; starts at 0, ends at
        ``n_points``, never decreases.
    per_point : mapping of str to (n_points[, k]) array, optional
    per_streamline : mapping of str to (n_streamlines[, k]) array, optional
    groups : mapping of str to array of int, optional
        Streamline indices that belong to each group; a streamline may be in many.
    per_group : mapping of str to mapping of str to array, optional
        Data of a group as a whole.
    affine : (4, 4) array, optional
        Voxel index to RAS+ mm of the image that the file refers to; identity if unknown.
    space : mapping, optional
        Further header values for writers: ``dimensions`` (3 int), ``voxel_sizes`` (3 float, mm), both along the axes of
        ``voxel_order`` (such as ``"RAS"``; the affine's own if it is not given), and what else a header says.
    dropped : mapping of str to int, optional
        Number of parts that reading omitted or changed, by reason.

    Raises
    ------
    ValueError
        If shapes or offsets contradict each other. The message names the array.
    """

    def __init__(
        self,
        points: ArrayLike,
        offsets: ArrayLike,
        per_point: Mapping[str, ArrayLike] | None = None,
        per_streamline: Mapping[str, ArrayLike] | None = None,
        groups: Mapping[str, ArrayLike] | None = None,
        per_group: Mapping[str, Mapping[str, ArrayLike]] | None = None,
        affine: ArrayLike | None = None,
        space: Mapping[str, Any] | None = None,
        dropped: Mapping[str, int] | None = None,
    ) -> None:
        self.points: Floats = as_points(points)
        self.offsets: Ints = as_offsets(offsets, len(self.points))
        self.per_point = as_columns(per_point, len(self.points), "per_point", "points")
        self.per_streamline = as_columns(per_streamline, len(self), "per_streamline", "streamlines")
        self.groups = {name: as_members(name, ids, len(self)) for name, ids in (groups or {}).items()}
        self.per_group: dict[str, dict[str, Array]] = {
            group: {name: np.asarray(value) for name, value in values.items()}
            for group, values in (per_group or {}).items()
        }
        self.affine: NDArray[np.float64] = np.eye(4) if affine is None else as_affine(affine)
        self.space: dict[str, Any] = dict(space or {})
        self.dropped: dict[str, int] = {k: int(v) for k, v in (dropped or {}).items()}

    # ------------------------------------------------------------------ size and selection

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @property
    def n_points(self) -> int:
        """Total number of points."""
        return len(self.points)

    @property
    def counts(self) -> Ints:
        """(n_streamlines,) int64: points of each streamline."""
        return np.diff(self.offsets)

    def __repr__(self) -> str:
        facts = [f"{len(self):,} streamlines", f"{self.n_points:,} points", str(self.points.dtype)]
        facts += [
            f"{title}: {', '.join(names)}"
            for title in ("per_point", "per_streamline", "groups", "dropped")
            if (names := getattr(self, title))
        ]
        return f"<Streamlines: {'; '.join(facts)}>"

    def _repr_html_(self) -> str:
        from pvfiblets.support.summary import summary_html

        return summary_html("Streamlines", self)

    def __add__(self, other: object) -> Streamlines:
        """Both's streamlines, one behind the other, as `concatenate` joins them."""
        return Streamlines.concatenate([self, other]) if isinstance(other, Streamlines) else NotImplemented

    def table(self, ids: Any = None, **options: Any) -> Table:
        """Return a row for each streamline, or for the streamlines in `ids`; see :func:`pvfiblets.table`."""
        from pvfiblets import table

        return table(self, ids, **options)

    def sample(self, image: Any, statistic: Any = None, **options: Any) -> NDArray[np.float64]:
        """Return the values of an image at the points, or a statistic of them; see :func:`pvfiblets.sample`."""
        from pvfiblets import sample

        return sample(self, image, statistic, **options)

    def clusters(self, threshold: float = 10.0, **options: Any) -> Clusters:
        """Cluster similar streamlines; see :func:`pvfiblets.clusters`."""
        from pvfiblets import clusters

        return clusters(self, threshold, **options)

    def similar(self, like: Any, distance: float = 10.0, **options: Any) -> Similar:
        """Find streamlines similar to given ones; see :func:`pvfiblets.similar`."""
        from pvfiblets import similar

        return similar(self, like, distance, **options)

    def plot(self, **options: Any) -> Any:
        """Show the streamlines in a new plotter; see :func:`pvfiblets.plot`."""
        from pvfiblets import plot

        return plot(self, **options)

    def __iter__(self) -> Iterator[Floats]:
        for first, last in zip(self.offsets[:-1], self.offsets[1:], strict=True):
            yield self.points[first:last]

    @overload
    def __getitem__(self, index: int | np.integer[Any]) -> Floats: ...
    @overload
    def __getitem__(self, index: slice | Array | Sequence[int] | Sequence[bool]) -> Streamlines: ...
    def __getitem__(self, index: Any) -> Floats | Streamlines:
        """One streamline's points for an integer, else the chosen streamlines with their data.

        Parameters
        ----------
        index : int, slice, boolean mask (n_streamlines,), or integer array
            Integer arrays may repeat and reorder; negative indices count from the end.

        Returns
        -------
        (k, 3) array or Streamlines
            Slices of step 1 share memory with this object.

        Raises
        ------
        IndexError
            If an index is out of range, or a mask has the wrong length.
        """
        if isinstance(index, (int, np.integer)) and not isinstance(index, (bool, np.bool_)):
            i = int(index)
            if not -len(self) <= i < len(self):
                raise IndexError(f"streamline {i} is out of range: there are {len(self)} streamlines")
            i %= len(self)
            return self.points[self.offsets[i] : self.offsets[i + 1]]
        if isinstance(index, slice):
            start, stop, step = index.indices(len(self))
            if step == 1:
                return self._span(start, max(start, stop))
            return self._gather(np.arange(start, stop, step, dtype=np.int64))
        return self._gather(as_ids(index, len(self)))

    def _span(self, start: int, stop: int) -> Streamlines:
        first, last = int(self.offsets[start]), int(self.offsets[stop])
        groups = {k: v[(v >= start) & (v < stop)] - start for k, v in self.groups.items()}
        return Streamlines(
            self.points[first:last],
            self.offsets[start : stop + 1] - first,
            {k: v[first:last] for k, v in self.per_point.items()},
            {k: v[start:stop] for k, v in self.per_streamline.items()},
            groups,
            self.per_group,
            self.affine,
            self.space,
            self.dropped,
        )

    def _gather(self, ids: Ints) -> Streamlines:
        counts = self.counts[ids]
        offsets = offsets_from_counts(counts)
        source = np.arange(offsets[-1]) + np.repeat(self.offsets[ids] - offsets[:-1], counts)
        groups = {}
        for name, members in self.groups.items():
            inside = np.zeros(len(self), bool)
            inside[members] = True
            groups[name] = np.flatnonzero(inside[ids])
        return Streamlines(
            self.points[source],
            offsets,
            {k: v[source] for k, v in self.per_point.items()},
            {k: v[ids] for k, v in self.per_streamline.items()},
            groups,
            self.per_group,
            self.affine,
            self.space,
            self.dropped,
        )

    # ------------------------------------------------------------------ measures

    def lengths(self) -> NDArray[np.float64]:
        """Return the length of each streamline, (n_streamlines,) float64, mm."""
        return lengths(self.points, self.offsets)

    @property
    def bounds(self) -> tuple[float, float, float, float, float, float]:
        """(xmin, xmax, ymin, ymax, zmin, zmax) in mm; six NaN where there is no point."""
        if self.n_points == 0:
            return (np.nan,) * 6
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        b = np.stack([low, high], axis=1).ravel().astype(float).tolist()
        return cast("tuple[float, float, float, float, float, float]", tuple(b))

    def blocks(self, max_points: int) -> Iterator[tuple[int, int]]:
        """Consecutive ranges of streamlines of at most `max_points` points each.

        A streamline longer than that forms a range of its own. Together the ranges cover every
        streamline once; there is none when there are no streamlines.

        Parameters
        ----------
        max_points : int
            At least 1.

        Yields
        ------
        (int, int)
            First streamline and one past the last.
        """
        yield from blocks(self.offsets, max_points)

    # ------------------------------------------------------------------ from and to others

    @classmethod
    def from_list(cls, streamlines: Iterable[ArrayLike], **rest: Any) -> Streamlines:
        """Make streamlines from a list of ``(k, 3)`` arrays.

        Parameters
        ----------
        streamlines : iterable of (k, 3) arrays
            An empty array stands for a streamline without points.
        **rest
            ``per_point``, ``groups`` and so on, as in the constructor.
        """
        arrays = [np.asarray(s) for s in streamlines]
        for i, a in enumerate(arrays):
            if a.size and (a.ndim != 2 or a.shape[1] != 3):
                raise ValueError(f"streamline {i} has the shape {a.shape}, expected (k, 3)")
        counts = np.array([len(a) if a.size else 0 for a in arrays], np.int64)
        full = [a for a in arrays if a.size]
        points = np.concatenate(full) if full else np.zeros((0, 3), np.float32)
        return cls(points, offsets_from_counts(counts), **rest)

    def to_list(self) -> list[Floats]:
        """Return one ``(k, 3)`` array per streamline; they share memory with this object."""
        return list(self)

    @classmethod
    def concatenate(cls, parts: Iterable[Streamlines]) -> Streamlines:
        """All streamlines of `parts`, in order, with their data.

        Groups of the same name are joined, `dropped` is summed. The affine and space are the
        first part's. Parts without streamlines contribute only their `dropped`, so they need
        not carry the same data.

        Raises
        ------
        ValueError
            If one part has data that another lacks: keeping it would need invented values.
        """
        all_parts = list(parts)
        if not all_parts:
            return cls(np.zeros((0, 3), np.float32), np.zeros(1, np.int64))
        dropped: dict[str, int] = {}
        for part in all_parts:
            for reason, count in part.dropped.items():
                dropped[reason] = dropped.get(reason, 0) + count
        full = [p for p in all_parts if len(p)] or all_parts[:1]
        first = full[0]
        groups: dict[str, list[Ints]] = {}
        per_group: dict[str, dict[str, Array]] = {}
        start = 0
        for part in full:
            for name, members in part.groups.items():
                groups.setdefault(name, []).append(members + start)
            for name, values in part.per_group.items():
                per_group.setdefault(name, {}).update(values)
            start += len(part)
        return cls(
            np.concatenate([p.points for p in full]),
            offsets_from_counts(np.concatenate([p.counts for p in full])),
            join([p.per_point for p in full], "per_point"),
            join([p.per_streamline for p in full], "per_streamline"),
            {name: np.concatenate(members) for name, members in groups.items()},
            per_group,
            first.affine,
            first.space,
            dropped,
        )

    @classmethod
    def from_polydata(cls, polydata: Any) -> Streamlines:
        """Make streamlines from the line cells of a PolyData.

        Parameters
        ----------
        polydata : pyvista.PolyData or vtkPolyData
            Point data becomes `per_point`, cell data of the lines `per_streamline`. Points
            shared by several lines are repeated. Groups, their data and the affine come back
            from the field data that :meth:`to_polydata` writes, groups only if no filter of VTK's has taken lines away.
            Points are RAS+ mm, or LPS+ where a field array of strings called ``SPACE`` says ``LPS``, as 3D Slicer
            writes it: then x and y change sign.

        Returns
        -------
        Streamlines
            ``dropped["cells that are not lines"]`` counts vertices, polygons and strips;
            ``dropped["points of no line"]`` points that no line uses; ``dropped["groups of other lines"]`` groups that
            a filter has passed on with fewer lines.
        """
        return cls(**parts_of_polydata(polydata))

    def to_polydata(self) -> pyvista.PolyData:
        """Return a PolyData with one polyline per streamline, in order, and all data.

        Per-point data becomes point data, per-streamline data cell data. Groups
        (``groups/NAME``; ``groups_of``, of how many streamlines), their data (``per_group/NAME/KEY``), an affine that
        is not the identity (``affine``) and the rest of the header (``space/KEY``; text as its UTF-8 bytes, since
        VTK loses arrays of text in some of its formats) are kept as field data. The field array ``SPACE`` says ``RAS``,
        for 3D Slicer.
        """
        return polydata_of(self.points, self.offsets, self.per_point, self.per_streamline, self.field_data())

    def field_data(self) -> dict[str, Array]:
        """Return groups, group data, affine and space as flat named arrays (see :meth:`to_polydata`)."""
        return field_of(len(self), self.groups, self.per_group, self.affine, self.space)
