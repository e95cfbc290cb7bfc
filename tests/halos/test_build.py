"""Lines and points with halos from every kind of source, with the values that were asked for."""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest
import pyvista as pv
import vtk

from pvfiblets import Streamlines, compress
from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.halos.build import as_halo_lines, as_halo_points
from pvfiblets.synthetic import brain_streamlines

T = np.linspace(0, 5, 25)
HELIX = np.stack([10 * np.cos(T), 10 * np.sin(T), 2 * T], axis=1)
PARTS = [HELIX, HELIX[::-2] + 30, HELIX[:2] - 30]
POINTS, OFFSETS = np.concatenate(PARTS), np.array([0, 25, 38, 40])
FA, LENGTH = np.arange(40.0), np.array([7.0, 8.0, 9.0])
STREAMLINES = Streamlines(POINTS, OFFSETS, {"fa": FA, "col": FA[:, None]}, {"length": LENGTH})
SEGMENTS = np.concatenate(
    [np.stack([np.arange(a, b - 1), np.arange(a + 1, b)], axis=1) for a, b in itertools.pairwise(OFFSETS)]
)


def plain_vtk(mesh):
    plain = vtk.vtkPolyData()
    plain.ShallowCopy(mesh)
    return plain


SOURCES = {
    "streamlines": STREAMLINES,
    "PyVista": STREAMLINES.to_polydata(),
    "VTK": plain_vtk(STREAMLINES.to_polydata()),
    "arrays": PARTS,
    "lists": [part.tolist() for part in PARTS],
    "segments": (POINTS, SEGMENTS),
    "shuffled segments": (POINTS, SEGMENTS[::-1]),
    "HaloLines": HaloLines(POINTS, OFFSETS),
}


@pytest.mark.parametrize("source", SOURCES.values(), ids=SOURCES.keys())
def test_all_sources_give_the_same_lines(source):
    lines, line_values = as_halo_lines(source, scalars=FA, filter_by=FA[::-1])
    order = np.argsort([line[0] for line in np.split(lines.values["scalars"], lines.offsets[1:-1])])
    found = [np.split(lines.points, lines.offsets[1:-1])[i] for i in order]
    for part, wanted in zip(found, PARTS, strict=True):
        np.testing.assert_array_equal(part, wanted)
    assert sorted(lines.values) == ["filter", "scalars"]
    np.testing.assert_array_equal(np.sort(lines.values["scalars"]), FA)
    np.testing.assert_array_equal(lines.values["filter"], 39 - lines.values["scalars"])
    assert not line_values


def test_other_sources():
    mesh = pv.Line((-1, -2, 3), (-4, -5, 6))
    mesh.field_data["SPACE"] = ["LPS"]  # as 3D Slicer says where points are
    np.testing.assert_array_equal(as_halo_points(mesh).points, [[1, 2, 3], [4, 5, 6]])
    np.testing.assert_array_equal(as_halo_lines(mesh).lines.points, [[1, 2, 3], [4, 5, 6]])
    assert as_halo_lines(HELIX).lines.n_lines == 1
    assert as_halo_lines(np.stack([HELIX, HELIX + 1])).lines.offsets.tolist() == [0, 25, 50]
    assert as_halo_lines(HELIX.tolist()).lines.n_segments == 24
    ring = as_halo_lines((HELIX[:4], [[0, 1], [1, 2], [2, 3], [3, 0]])).lines
    np.testing.assert_array_equal(ring.points, HELIX[[0, 1, 2, 3, 0]])
    brain = brain_streamlines(20, 1.0)
    lines, values = as_halo_lines(compress(brain, max_error=0.05), scalars="bundle")
    assert lines.offsets.tolist() == brain.offsets.tolist()
    assert np.abs(lines.points - brain.points).max() <= 0.05
    np.testing.assert_array_equal(values["bundle"], np.ravel(brain.per_streamline["bundle"]))


def test_only_what_is_asked_for_is_kept():
    for source in (STREAMLINES, SOURCES["PyVista"]):
        assert not as_halo_lines(source).lines.values
        assert not as_halo_lines(source).line_values
        assert list(as_halo_lines(source, filter_by="fa").lines.values) == ["fa"]
        lines, line_values = as_halo_lines(source, scalars="length", filter_by="length")
        assert list(lines.values) == ["length"]
        assert line_values["length"].tolist() == LENGTH.tolist()
        np.testing.assert_array_equal(lines.values["length"], np.repeat(LENGTH, np.diff(OFFSETS)))
    assert list(as_halo_lines(STREAMLINES, scalars="fa", filter_by="fa").lines.values) == ["fa"]
    assert as_halo_lines(STREAMLINES, scalars="col").lines.values["col"].shape == (40,)


def test_numbers_of_lines_are_given_in_any_form():
    for scalars in (LENGTH, LENGTH.tolist(), LENGTH[:, None]):
        lines, line_values = as_halo_lines(PARTS, scalars=scalars, filter_by=scalars)
        assert line_values["scalars"].tolist() == LENGTH.tolist()
        assert list(lines.values) == ["filter"]
        np.testing.assert_array_equal(lines.values["filter"], np.repeat(LENGTH, np.diff(OFFSETS)))
    missing = np.where(np.arange(40) % 3, FA, np.nan)
    both = as_halo_lines(Streamlines(POINTS, OFFSETS, {"x": missing}), scalars="x", filter_by="x").lines
    np.testing.assert_array_equal(both.values["x"], missing)
    by_line = np.split(FA, OFFSETS[1:-1])
    np.testing.assert_array_equal(as_halo_lines(PARTS, scalars=by_line).lines.values["scalars"], FA)
    # As many lines as points in all: a row for each point.
    assert list(as_halo_lines(HELIX[:1], scalars=[3.0]).lines.values) == ["scalars"]


def test_halo_lines_keep_their_values():
    given = HaloLines(POINTS, OFFSETS, {"fa": FA, "md": 2 * FA})
    lines, line_values = as_halo_lines(given, scalars="fa", filter_by=LENGTH)
    assert lines.points is given.points
    assert sorted(lines.values) == ["fa", "filter", "md"]
    assert not line_values
    points = as_halo_points(HaloPoints(POINTS, {"fa": FA}), scalars=2 * FA, filter_by="fa")
    assert sorted(points.values) == ["fa", "scalars"]
    assert as_halo_points(points).values["scalars"] is points.values["scalars"]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_float32_stays(dtype):
    points = POINTS.astype(dtype)
    mesh = pv.PolyData(points, lines=np.concatenate([[25, *range(25)], [15, *range(25, 40)]]))
    assert mesh.points.dtype == dtype
    sources = (points, [points[:20], [], points[20:]], Streamlines(points, OFFSETS), mesh, (points, SEGMENTS))
    for source in sources:
        found = as_halo_lines(source).lines.points
        assert found.dtype == dtype
        np.testing.assert_array_equal(found, points)
    for source in (points, Streamlines(points, OFFSETS), mesh):
        assert as_halo_points(source).points.dtype == dtype
    assert as_halo_lines(np.arange(6).reshape(2, 3)).lines.points.dtype == np.float64
    assert as_halo_points(np.arange(6).reshape(2, 3)).points.dtype == np.float64


def test_vtk_may_change_its_memory_afterwards():
    mesh = STREAMLINES.to_polydata().copy()
    lines, points = as_halo_lines(mesh, scalars="fa").lines, as_halo_points(mesh, scalars="fa")
    mesh.points[:] = -1.0
    mesh.point_data["fa"][:] = -1.0
    for made in (lines, points):
        np.testing.assert_array_equal(made.points, POINTS)
        np.testing.assert_array_equal(made.values["fa"], FA)


def test_other_cells_and_points_of_no_line_are_left_out():
    points = np.concatenate([[[np.nan] * 3], HELIX[:4]])
    mesh = pv.PolyData(points, verts=[1, 0], lines=[3, 1, 2, 3, 2, 3, 4])
    mesh.cell_data["kind"] = np.array([7, 8, 9])
    mesh.point_data["fa"] = np.arange(5.0)
    lines, line_values = as_halo_lines(mesh, scalars="kind", filter_by="fa")
    # The point that both lines use is one of each.
    assert lines.values["fa"].tolist() == [1, 2, 3, 3, 4]
    np.testing.assert_array_equal(lines.points, points[[1, 2, 3, 3, 4]])
    assert line_values["kind"].tolist() == [8, 9]
    fewer = pv.PolyData(HELIX, lines=[3, 5, 4, 3])
    assert as_halo_lines(fewer, scalars=np.arange(25)).lines.values["scalars"].tolist() == [5, 4, 3]


def test_cells_of_two_points_become_lines():
    mesh = pv.lines_from_points(HELIX[:5].astype(np.float32))
    mesh.cell_data["fa"] = np.array([1.0, 2.0, 4.0, 8.0])
    lines, line_values = as_halo_lines(mesh, scalars="fa", filter_by="fa")
    assert lines.offsets.tolist() == [0, 5]
    assert not line_values
    assert lines.values["fa"].tolist() == [1, 1.5, 3, 6, 8]
    mesh.cell_data["rgb"] = np.array([[255, 0, 0], [0, 255, 0], [0, 255, 0], [0, 0, 255]], np.uint8)
    colours = as_halo_lines(mesh, scalars="rgb").lines.values["rgb"]
    np.testing.assert_allclose(colours[1], [0.5, 0.5, 0, 1])
    # Where none follows another, each cell is a line.
    apart = pv.line_segments_from_points(HELIX[:6])
    lines, line_values = as_halo_lines(apart, scalars=[1, 2, 3])
    assert lines.n_lines == 3
    assert line_values["scalars"].tolist() == [1, 2, 3]


@pytest.mark.parametrize("columns", [3, 4])
def test_colours(columns):
    bytes_ = np.random.default_rng(0).integers(0, 256, (40, columns)).astype(np.uint8)
    wanted = np.ones((40, 4))
    wanted[:, :columns] = bytes_ / 255
    for given, rgb in ((bytes_, None), (bytes_, True), (bytes_ / 255, True), (bytes_ / np.float32(255), True)):
        for colours in (
            as_halo_lines(PARTS, scalars=given, rgb=rgb).lines.values["scalars"],
            as_halo_points(POINTS, scalars=given, rgb=rgb).values["scalars"],
        ):
            assert colours.dtype == np.float32
            assert colours.max() <= 1.0
            np.testing.assert_allclose(colours, wanted, atol=1e-6)
    of_lines = as_halo_lines(PARTS, scalars=bytes_[:3]).line_values["scalars"]
    assert of_lines.dtype == np.float32
    np.testing.assert_allclose(of_lines, wanted[:3], atol=1e-6)
    # Three lines, and three numbers for each: colours of lines, not arrays of theirs.
    assert as_halo_lines(PARTS, scalars=[[1, 0, 0], [0, 1, 0], [0, 0, 1]], rgb=True).line_values["scalars"].shape == (
        3,
        4,
    )


def test_empty_and_one_point_lines():
    for source in ([], np.zeros((0, 3)), [[], []], Streamlines(np.zeros((0, 3)), [0])):
        lines = as_halo_lines(source).lines
        assert (lines.n_points, lines.n_segments) == (0, 0)
    lines, line_values = as_halo_lines([HELIX[:1], [], HELIX[:3]], scalars=LENGTH, filter_by=LENGTH)
    assert lines.offsets.tolist() == [0, 1, 1, 4]
    assert line_values["scalars"].tolist() == [7, 8, 9]
    assert lines.values["filter"].tolist() == [7, 9, 9, 9]
    for source in (np.zeros((0, 3)), [], pv.PolyData(), vtk.vtkPolyData(), Streamlines(np.zeros((0, 3)), [0])):
        assert as_halo_points(source).n_points == 0


def test_points_of_every_kind():
    mesh = pv.Sphere(theta_resolution=8, phi_resolution=6)
    mesh.point_data["z"] = mesh.points[:, 2]
    grid = mesh.cast_to_unstructured_grid()
    image = pv.ImageData(dimensions=(2, 3, 4), spacing=(1, 2, 3))
    image.point_data["z"] = image.points[:, 2]
    for source in (mesh, grid, image, image.cast_to_rectilinear_grid(), plain_vtk(mesh)):
        points = as_halo_points(source, scalars="z")
        np.testing.assert_array_equal(points.points, pv.wrap(source).points)
        np.testing.assert_array_equal(points.values["z"], points.points[:, 2])
    points = as_halo_points(STREAMLINES, scalars="length", filter_by="fa")
    np.testing.assert_array_equal(points.values["length"], np.repeat(LENGTH, np.diff(OFFSETS)))
    assert as_halo_points(HELIX.tolist()).n_points == 25
    brain = brain_streamlines(5, 1.0)
    assert as_halo_points(compress(brain, max_error=0.05), filter_by="bundle").n_points == brain.n_points


# ---------------------------------------------------------------------- errors

COLOURS = np.ones((40, 3))
BROKEN = POINTS.copy()
BROKEN[30, 1] = np.inf


@pytest.mark.parametrize(
    ("build", "source", "arguments", "message"),
    [
        (as_halo_lines, STREAMLINES, {"scalars": "md"}, "it has point data 'fa', 'col' and line data 'length'"),
        (as_halo_lines, PARTS, {"filter_by": "md"}, "is 'md', which the source does not have; it has no data"),
        (as_halo_lines, PARTS, {"scalars": np.zeros(5)}, "(5,), expected a row for each of 40 points or of 3 lines"),
        (as_halo_lines, PARTS, {"scalars": 1.0}, "scalars has the shape (), expected a row"),
        (as_halo_lines, PARTS, {"scalars": ["a"] * 40}, "words per point"),
        (as_halo_lines, PARTS, {"scalars": COLOURS[:, :2], "rgb": True},
         "the shape (40, 2) and type float64, expected one number"),
        (as_halo_lines, PARTS, {"scalars": FA, "rgb": True},
         "rgb=True asks for colours, but 'scalars' has one number in each row"),
        (as_halo_lines, PARTS, {"scalars": 2 * COLOURS, "rgb": True},
         "colour 0 of 'scalars' is [2.0, 2.0, 2.0], expected 0 to 1"),
        (as_halo_lines, PARTS, {"scalars": np.nan * COLOURS, "rgb": True}, "colour 0 of 'scalars' is [nan, nan, nan]"),
        (as_halo_lines, PARTS, {"filter_by": COLOURS},
         "filter_by 'filter' has the shape (40, 3), expected one number in each row"),
        (as_halo_lines, Streamlines(POINTS, OFFSETS, {"scalars": FA}), {"scalars": 2 * FA, "filter_by": "scalars"},
         "both are called 'scalars'"),
        (as_halo_lines, Streamlines(POINTS, OFFSETS, None, {"scalars": LENGTH}),
         {"scalars": LENGTH, "filter_by": "scalars"}, "both are called 'scalars'"),
        (as_halo_lines, np.zeros((4, 2)), {}, "points have the shape (4, 2), expected (n, 3)"),
        (as_halo_lines, (POINTS, [[0, 40]]), {}, "segment 0 is [0, 40], but there are 40 points"),
        (as_halo_lines, pv.Sphere(), {}, "the PolyData has no lines but 1680 other cells"),
        (as_halo_points, BROKEN, {}, "point 30 of points is"),
        (as_halo_points, np.zeros((4, 2)), {}, "points of the shape (4, 2), expected (n, 3)"),
        (as_halo_points, np.float64(3), {}, "points of the shape ()"),
        (as_halo_points, POINTS, {"scalars": LENGTH},
         "scalars has the shape (3,), expected a row for each of 40 points"),
        (as_halo_points, POINTS, {"scalars": COLOURS[:, :2], "rgb": True}, "'scalars' has the shape (40, 2)"),
        (as_halo_points, POINTS, {"filter_by": COLOURS}, "filter_by 'filter' has the shape (40, 3)"),
        (as_halo_points, STREAMLINES.to_polydata(), {"scalars": "length"},
         "it has point data 'fa', 'col'; cell data 'length' becomes point data by cell_data_to_point_data()"),
        (as_halo_points, HaloPoints(POINTS, {"scalars": FA}), {"scalars": 2 * FA, "filter_by": "scalars"},
         "both are called 'scalars'"),
    ],
)  # fmt: skip
def test_what_lines_and_points_cannot_be(build, source, arguments, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        build(source, **arguments)


def test_what_has_no_lines_or_points():
    for build, sources in (
        (as_halo_lines, (None, "lines.trk", 3, pv.ImageData(dimensions=(2, 2, 2)))),
        (as_halo_points, (None, "cloud.ply", PARTS, pv.MultiBlock([pv.Sphere()]), vtk.vtkTable())),
    ):
        for source in sources:
            with pytest.raises(TypeError, match=f"with halos cannot be made from a {type(source).__name__}; give"):
                build(source)
