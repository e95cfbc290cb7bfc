"""`LineData`: lines in float64 with data of points, cut, thinned and made into PolyData of VTK's own.

What the engine draws lies on the GPU, and VTK is connected to a few triangles (`pvfiblets.mappers.vtk_pipeline.proxy`).
Exporters, pickers and views in browsers read VTK's data: they get these lines instead
(`pvfiblets.mappers.vtk_pipeline.readable_lines`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]

COLOURS, RADIUS, STREAMLINE = "colours", "radius", "streamline"
"""Names of the arrays: RGBA of points, mm of points, and the number of each cell's streamline (tube, point)."""

SIDES = 12
"""Flat sides of a tube around a line: its surface lies inside of the round one by 3.4 % of the radius at most."""

STEPS = 8  # straight pieces of a segment of spline tubes

_HALVINGS = 30


@dataclass(frozen=True, eq=False)
class LineData:
    """Lines with rows of data for each point."""

    points: npt.NDArray[Any]  # `(n, 3)` floats, mm of the data
    offsets: Ints  # `(k + 1,)` int64: line `i` is `points[offsets[i]:offsets[i + 1]]`
    ids: Ints  # `(k,)` int64: the streamline of each line
    columns: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)  # arrays with a row for each point

    @property
    def owners(self) -> Ints:
        """``(n,)`` int64: which line each point belongs to."""
        return np.repeat(np.arange(len(self.ids)), np.diff(self.offsets))

    def tangents(self) -> Floats:
        """Return ``(n, 3)`` unit directions at the points: the mean over the adjacent segments; 0 without any."""
        points, owners = np.asarray(self.points, np.float64), self.owners
        steps = np.diff(points, axis=0)
        sizes = np.linalg.norm(steps, axis=1)
        within = (owners[1:] == owners[:-1]) & (sizes > 0.0)
        units = np.zeros_like(steps)
        units[within] = steps[within] / sizes[within, None]
        sums = np.zeros_like(points)
        sums[:-1] += units
        sums[1:] += units
        lengths = np.linalg.norm(sums, axis=1, keepdims=True)
        return np.divide(sums, lengths, out=np.zeros_like(sums), where=lengths > 0.0)

    def with_points(self, points: Flags) -> LineData:
        """Return the segments with both points kept, and kept lines of one point."""
        if points.all():
            return self
        owners = self.owners
        begins = points.copy()
        begins[1:] &= ~(points[:-1] & (owners[1:] == owners[:-1]))
        rows = np.flatnonzero(points)
        return self._runs(rows, np.zeros(len(rows)), begins[points])

    def ends(self, points: Flags | None = None) -> LineData:
        """Return the first and the last point of each line as lines of one point, where the segment there is kept."""
        first, last = self.offsets[:-1], self.offsets[1:] - 1
        rows = np.concatenate([first[last >= first], last[last > first]])
        if points is not None:
            inner = np.concatenate([np.minimum(first + 1, last)[last >= first], (last - 1)[last > first]])
            rows = rows[points[rows] & points[inner]]
        rows = np.sort(rows)
        columns = {name: column[rows] for name, column in self.columns.items()}
        return LineData(self.points[rows], np.arange(len(rows) + 1), self.ids[self.owners[rows]], columns)

    def with_segments(self, goes_on: Flags) -> LineData:
        """Return some of the segments: of each point, whether the one that starts there is kept."""
        before = np.concatenate([np.zeros(1, bool), goes_on])[:-1]
        rows = np.flatnonzero(goes_on | before)
        return self._runs(rows, np.zeros(len(rows)), ~before[rows])

    def inside(self, contains: Callable[[Floats], Flags]) -> LineData:
        """Return the lines within a region, cut at its boundary; one that a segment leaves and enters is not found."""
        within = contains(np.asarray(self.points, np.float64))
        if within.all():
            return self
        owners = self.owners
        crossing = np.flatnonzero((owners[1:] == owners[:-1]) & (within[1:] != within[:-1]))
        share = self._crossings(crossing, within[crossing], contains)
        kept = np.flatnonzero(within)
        before, share = np.concatenate([kept, crossing]), np.concatenate([np.zeros(len(kept)), share])
        # A crossing comes after the point before it, and before the one after, however near.
        order = np.argsort(np.concatenate([2 * kept, 2 * crossing + 1]), kind="stable")
        entering = np.concatenate([np.zeros(len(kept), bool), within[crossing + 1]])
        first = np.concatenate([np.isin(kept, self.offsets[:-1]), np.zeros(len(crossing), bool)])
        return self._runs(before[order], share[order], (entering | first)[order])

    def _crossings(self, before: Ints, inside: Flags, contains: Callable[[Floats], Flags]) -> Floats:
        """Shares of segments at which they cross, by halving."""
        start, stop = (np.asarray(self.points[at], np.float64) for at in (before, before + 1))
        low, high = np.zeros(len(before)), np.ones(len(before))
        for _ in range(_HALVINGS):
            middle = (low + high) / 2.0
            same = contains(start + middle[:, None] * (stop - start)) == inside
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return np.asarray(np.where(inside, low, high))

    def _runs(self, before: Ints, share: Floats, begins: Flags) -> LineData:
        """Return lines through places, a share of the way behind points, a new one where one begins."""
        # Pieces of a single point are dropped.
        starts = np.flatnonzero(begins)
        counts = np.diff(starts, append=len(before))
        owners = self.owners[before[starts]]
        good = (counts > 1) | (np.diff(self.offsets)[owners] == 1)
        keep = np.repeat(good, counts)
        before, share = before[keep], share[keep]

        def between(rows: npt.NDArray[Any]) -> npt.NDArray[Any]:
            weight = share.reshape(-1, *[1] * (rows.ndim - 1))
            after = np.minimum(before + 1, len(rows) - 1)
            mixed = np.where(weight > 0.0, rows[before] * (1.0 - weight) + rows[after] * weight, rows[before])
            return (np.round(mixed) if rows.dtype.kind in "ui" else mixed).astype(rows.dtype)

        offsets = np.concatenate([np.zeros(1, np.int64), np.cumsum(counts[good])])
        columns = {name: between(rows) for name, rows in self.columns.items()}
        return LineData(between(np.asarray(self.points)), offsets, self.ids[owners[good]], columns)

    def with_columns(self, **columns: npt.NDArray[Any]) -> LineData:
        """Return the same lines with more data of points."""
        return replace(self, columns={**self.columns, **columns})

    def to_polydata(self, *, segments: bool = False, vertices: bool = False) -> vtkPolyData:
        """Return PolyData with a cell for each line and cell data ``'streamline'``."""
        made = vtkPolyData()
        points = vtkPoints()
        points.SetData(numpy_to_vtk(np.ascontiguousarray(self.points).reshape(-1, 3), deep=True))
        made.SetPoints(points)
        ids = self.ids
        connectivity, offsets = np.arange(len(self.points)), self.offsets
        if vertices:
            offsets, ids = np.arange(len(self.points) + 1), ids[self.owners]
        elif segments:
            owners = self.owners
            first = np.flatnonzero(owners[1:] == owners[:-1])
            connectivity, offsets = np.column_stack([first, first + 1]).ravel(), 2 * np.arange(len(first) + 1)
            ids = ids[owners[first]]
        cells = vtkCellArray()
        cells.SetData(*(numpy_to_vtkIdTypeArray(np.asarray(a, np.int64), deep=True) for a in (offsets, connectivity)))
        (made.SetVerts if vertices else made.SetLines)(cells)
        for name, rows in self.columns.items():
            made.GetPointData().AddArray(_named(name, rows))
        made.GetCellData().AddArray(_named(STREAMLINE, ids))
        if COLOURS in self.columns:
            made.GetPointData().SetActiveScalars(COLOURS)
        return made


def _named(name: str, rows: npt.NDArray[Any]) -> Any:
    array = numpy_to_vtk(np.ascontiguousarray(rows), deep=True)
    array.SetName(name)
    return array


def tube_surface(lines: LineData) -> vtkPolyData:
    """Return tubes of `SIDES` sides around lines whose columns have a ``'radius'``, mm; balls around lone points."""
    from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkGlyph3D, vtkTriangleFilter, vtkTubeFilter
    from vtkmodules.vtkFiltersSources import vtkSphereSource

    points, owners = np.asarray(lines.points, np.float64), lines.owners
    same = np.zeros(len(points), bool)  # VTK leaves out lines with steps of no length
    same[1:] = (owners[1:] == owners[:-1]) & (points[1:] == points[:-1]).all(axis=1)
    rows = np.flatnonzero(~same)
    counts = np.bincount(owners[rows], minlength=len(lines.ids))
    offsets = np.concatenate([np.zeros(1, np.int64), np.cumsum(counts)])
    columns = {name: column[rows] for name, column in lines.columns.items()}
    shape = LineData(lines.points[rows], offsets, lines.ids, columns)
    data = shape.to_polydata()
    data.GetPointData().SetActiveScalars(RADIUS)
    tubes = vtkTubeFilter()
    tubes.SetInputData(data)
    tubes.SetNumberOfSides(SIDES)
    tubes.SetVaryRadiusToVaryRadiusByAbsoluteScalar()
    tubes.CappingOn()
    triangles = vtkTriangleFilter()  # of the strips, which exporters leave out
    triangles.SetInputConnection(tubes.GetOutputPort())
    triangles.PassLinesOff()
    triangles.PassVertsOff()
    triangles.Update()
    parts = [triangles.GetOutput()]
    alone = counts == 1
    if alone.any():
        at = offsets[:-1][alone]
        rows_of = {name: column[at] for name, column in columns.items()}
        balls = LineData(shape.points[at], np.arange(len(at) + 1), lines.ids[alone], rows_of)
        given = balls.to_polydata(vertices=True)
        given.GetPointData().SetActiveScalars(RADIUS)
        source, glyph = vtkSphereSource(), vtkGlyph3D()
        source.SetRadius(1.0)
        source.SetThetaResolution(SIDES)
        source.SetPhiResolution(SIDES)
        glyph.SetSourceConnection(source.GetOutputPort())
        glyph.SetInputData(given)
        glyph.SetScaleModeToScaleByScalar()
        glyph.Update()
        many = glyph.GetOutput().GetNumberOfCells() // len(balls.ids)
        glyph.GetOutput().GetCellData().AddArray(_named(STREAMLINE, np.repeat(balls.ids, many)))
        parts.append(glyph.GetOutput())
    if len(parts) == 1:
        whole = parts[0]
    else:
        joined = vtkAppendPolyData()
        for part in parts:
            joined.AddInputData(part)
        joined.Update()
        whole = joined.GetOutput()
    if COLOURS in lines.columns:
        whole.GetPointData().SetActiveScalars(COLOURS)
    return whole


def segment_ids(tubes: Any) -> tuple[Ints, Ints]:
    """Return where runs of segments of `SplineTubes` begin that follow each other in one tube, and their tubes."""
    start, stop = np.asarray(tubes.segments, np.int64).reshape(-1, 2).T
    owners = np.asarray(tubes.tubes, np.int64)
    follows = (start[1:] == stop[:-1]) & (owners[1:] == owners[:-1])
    begins = np.flatnonzero(np.concatenate([np.ones(min(len(start), 1), bool), ~follows]))
    return begins, owners[begins]
