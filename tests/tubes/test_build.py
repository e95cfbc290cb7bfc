"""Tubes from every kind of source, with radii, values and derivatives given or found."""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest
import pyvista as pv
import vtk

from pvfiblets import Streamlines, compress
from pvfiblets.synthetic import brain_streamlines
from pvfiblets.tubes.build import as_spline_tubes

T = np.linspace(0, 5, 25)
HELIX = np.stack([10 * np.cos(T), 10 * np.sin(T), 2 * T], axis=1)


def same(a, b):
    """Assert that both draw the same tubes, nodes in whatever order."""
    assert (a.n_tubes, a.n_segments, a.scaled) == (b.n_tubes, b.n_segments, b.scaled)
    np.testing.assert_array_equal(a.tubes, b.tubes)
    for name in ("points", "radius", "tangents", "radius_slopes"):
        np.testing.assert_allclose(getattr(a, name)[a.segments], getattr(b, name)[b.segments], atol=1e-6)
    for name, value in a.values.items():
        np.testing.assert_allclose(value.values[a.segments], b.values[name].values[b.segments], atol=1e-6)
        np.testing.assert_allclose(value.slopes[a.segments], b.values[name].slopes[b.segments], atol=1e-6)


@pytest.mark.parametrize("method", ["finite", "catmull-rom", "natural"])
def test_all_sources_give_the_same_tubes(method):
    lines, widths = [HELIX, HELIX[::-2] + 30, HELIX[:2] - 30], [1 + T / 9, 2 - T[::2] / 9, T[:2] + 1]
    points, width = np.concatenate(lines), np.concatenate(widths)
    offsets = np.cumsum([0, 25, 13, 2])
    reference = as_spline_tubes(lines, radius=widths, scalars=[2 * w for w in widths], method=method)
    assert (reference.n_tubes, reference.n_segments, reference.n_nodes) == (3, 24 + 12 + 1, 40)
    assert reference.scaled == (method != "catmull-rom")
    streamlines = Streamlines(points, offsets, {"radius": width[:, None], "scalars": 2 * width})
    same(as_spline_tubes(streamlines, scalars="scalars", method=method), reference)
    mesh = streamlines.to_polydata()
    assert mesh.points.dtype == np.float64
    same(as_spline_tubes(mesh, scalars="scalars", method=method), reference)
    plain = vtk.vtkPolyData()
    plain.ShallowCopy(mesh)
    same(as_spline_tubes(plain, radius="radius", scalars="scalars", method=method), reference)
    segments = np.concatenate(
        [np.stack([np.arange(a, b - 1), np.arange(a + 1, b)], axis=1) for a, b in itertools.pairwise(offsets)]
    )
    same(as_spline_tubes((points, segments), radius=width, scalars=2 * width, method=method), reference)
    # Segments in any order are chained where they follow each other, and stay in the order given.
    order = np.random.default_rng(3).permutation(len(segments))
    mixed = as_spline_tubes((points, segments[order]), radius=width, scalars=2 * width, method=method)
    np.testing.assert_array_equal(mixed.points[mixed.segments], points[segments[order]])
    np.testing.assert_allclose(
        mixed.tangents[mixed.segments], reference.tangents[reference.segments][order], atol=1e-13
    )
    assert len({*zip(mixed.tubes.tolist(), reference.tubes[order].tolist(), strict=True)}) == 3
    assert as_spline_tubes(reference) is reference
    one = as_spline_tubes(HELIX, radius=1 + T / 9, scalars=2 + 2 * T / 9, method=method)
    same(one, reference.subset([0]))


def test_cells_of_two_points_are_smooth_where_they_follow_each_other():
    mesh = pv.lines_from_points(HELIX)
    mesh.cell_data["id"] = np.arange(24.0)
    tubes = as_spline_tubes(mesh, radius=1.0)
    whole = as_spline_tubes(HELIX, radius=1.0)
    np.testing.assert_allclose(tubes.tangents[tubes.segments], whole.tangents[whole.segments], atol=1e-6)
    assert tubes.tubes.tolist() == list(range(24)) == tubes.tube_values["id"].tolist()
    # A value of cells is, at a node between two, their mean.
    np.testing.assert_allclose(as_spline_tubes(mesh, radius="id").radius, [0, *np.arange(0.5, 23), 23])


def test_other_cells_and_unused_points():
    points = np.concatenate([[[99.0, 99, 99]], HELIX[:4]])
    mesh = pv.PolyData(points, verts=[1, 0], lines=[3, 1, 2, 3, 2, 3, 4])
    mesh.cell_data["kind"] = np.array([7, 8, 9])
    mesh.point_data["name"] = ["a", "b", "c", "d", "e"]
    tubes = as_spline_tubes(mesh, radius=0.5)
    assert tubes.n_nodes == 5  # the third point is on both lines, and has a node for each
    assert tubes.tube_values["kind"].tolist() == [8, 9]
    assert max(tubes.bounds) < 99


def test_a_fibletset_is_decompressed():
    lines = brain_streamlines(20, 1.0)
    fiblets = compress(lines, max_error=0.05)
    tubes = as_spline_tubes(fiblets, radius=0.4)
    assert (tubes.n_tubes, tubes.n_nodes) == (20, lines.n_points)
    assert np.linalg.norm(tubes.points - lines.points, axis=1).max() <= 0.05
    assert tubes.tube_values["bundle"].shape == (20,)


def test_lines_of_one_point_are_spheres_and_of_none_nothing():
    tubes = as_spline_tubes([HELIX[:1], [], HELIX[:3]], radius=2.0)
    assert (tubes.n_tubes, tubes.n_segments) == (3, 3)
    assert tubes.tubes.tolist() == [0, 2, 2]
    assert tubes.segments[0].tolist() == [0, 0]
    assert not tubes.tangents[0].any()
    for tangents in (None, np.ones((4, 3))):
        tubes = as_spline_tubes([HELIX[:1], HELIX[:3]], radius=2.0, tangents=tangents)
        assert not tubes.tangents[0].any()
    assert as_spline_tubes([]).n_tubes == 0
    assert as_spline_tubes(np.zeros((0, 3))).n_segments == 0
    ball = as_spline_tubes(np.ones((1, 3)))
    assert ball.radius.tolist() == [1.0]
    assert not ball.joined_ends.any()


def test_a_fork_shares_its_node_when_tangents_are_given():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 1, 0], [2, -1, 0]])
    fork = (points, [[0, 1], [1, 2], [1, 3]])
    given = as_spline_tubes(fork, radius=[3.0, 2, 1, 1], tangents=np.ones((4, 3)))
    assert (given.n_nodes, given.n_tubes, given.scaled) == (4, 3, False)
    np.testing.assert_array_equal(given.segments, fork[1])
    # By parameter; the fork's node has the mean of what its three segments ask for.
    np.testing.assert_allclose(given.radius_slopes, [-1, -1, -1, -1])
    own = as_spline_tubes(fork, radius=[3.0, 2, 1, 1])
    assert own.n_nodes == 6
    np.testing.assert_allclose(own.tangents[own.segments[2, 0]], np.array([1, -1, 0]) / np.sqrt(2))
    np.testing.assert_array_equal(own.points[own.segments], points[fork[1]])
    assert as_spline_tubes(fork, radius=1, tangents=np.ones((4, 3)), scaled=True).scaled


def test_a_fork_is_the_same_in_whichever_order_its_cells_are_listed():
    """A straight trunk of two cells, and two branches to its sides: nothing leans towards either."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 1, 0], [3, -1, 0], [4, 2, 0]])
    cells = np.array([[0, 1], [1, 2], [2, 3], [2, 4], [3, 5]])
    side = np.array([0.5**0.5, 0.5**0.5, 0.0])
    for order in itertools.permutations(range(len(cells))):
        mesh = pv.PolyData(points, lines=np.insert(cells[list(order)], 0, 2, axis=1).ravel())
        for source in (mesh, (points, cells[list(order)])):
            tubes = as_spline_tubes(source, radius=0.1)
            ends = tubes.tangents[tubes.segments][np.argsort(order)]  # of each cell at its start and its end
            np.testing.assert_allclose(ends[:2], np.tile([1.0, 0, 0], (2, 2, 1)), atol=1e-12)
            np.testing.assert_allclose(ends[[2, 2, 4, 4], [0, 1, 0, 1]], np.tile(side, (4, 1)), atol=1e-12)
            np.testing.assert_allclose(ends[3], np.tile(side * [1, -1, 1], (2, 1)), atol=1e-12)


def test_a_ring_by_index_is_smooth_and_may_share_its_node():
    ring = (np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), [[0, 1], [1, 2], [2, 3], [3, 0]])
    tubes = as_spline_tubes(ring, radius=0.1)
    assert tubes.n_tubes == 1
    assert tubes.joined_ends.all()
    np.testing.assert_allclose(tubes.tangents[tubes.segments[0, 0]], [0.5, -0.5, 0])
    np.testing.assert_array_equal(tubes.tangents[tubes.segments[3, 1]], tubes.tangents[tubes.segments[0, 0]])


def test_radius_of_every_kind():
    mesh = pv.Spline(HELIX, 40)
    assert as_spline_tubes(mesh).radius == pytest.approx(0.005 * np.linalg.norm(np.ptp(mesh.points, axis=0)), rel=1e-6)
    mesh.cell_data["width"] = [3]
    assert as_spline_tubes(mesh, radius="width").radius.tolist() == [3.0] * 40
    for name in ("MaximumInscribedSphereRadius", "Radius", "radius"):
        mesh.point_data[name] = np.full(40, float(len(name)), np.float32)
        assert as_spline_tubes(mesh).radius[0] == len(name)
    assert as_spline_tubes(mesh, radius=2).radius[7] == 2.0
    assert not as_spline_tubes(mesh, radius=2).radius_slopes.any()
    slopes = as_spline_tubes(mesh, radius=2, radius_slopes=0.25).radius_slopes
    assert slopes.tolist() == [0.25] * 40
    assert as_spline_tubes([HELIX, HELIX], radius=[1.0, 2.0]).radius.tolist() == [1.0] * 25 + [2.0] * 25


def test_scalars_of_every_kind():
    lines = [HELIX, HELIX[:5] + 20]
    per_line = as_spline_tubes(lines, scalars=[4, 5])
    assert not per_line.values
    assert per_line.tube_values["scalars"].tolist() == [4, 5]
    byte = np.random.default_rng(0).integers(0, 256, (30, 3)).astype(np.uint8)
    tubes = as_spline_tubes(lines, scalars=byte)
    colours = tubes.values["scalars"]
    np.testing.assert_allclose(colours.values, np.column_stack([byte / 255.0, np.ones(30)]))
    floats = as_spline_tubes(lines, scalars=byte / 255.0, rgb=True).values["scalars"]
    np.testing.assert_allclose(floats.values, colours.values)
    red = as_spline_tubes(lines, scalars=byte[:, 0] / 255.0).values["scalars"]
    np.testing.assert_allclose(colours.slopes[:, 0], red.slopes, atol=0.02)
    assert not colours.slopes[:, 3].any()
    given = as_spline_tubes(lines, scalars=byte, scalar_slopes=np.full((30, 3), 0.5)).values["scalars"]
    np.testing.assert_array_equal(given.slopes, [[0.5, 0.5, 0.5, 0.0]] * 30)
    missing = np.arange(30.0)
    missing[3] = np.nan
    assert np.isnan(as_spline_tubes(lines, scalars=missing).values["scalars"].values[3])


def test_the_radius_is_always_there_to_colour_by():
    assert not as_spline_tubes(HELIX, radius=1 + T, scalars="radius").values
    lines = Streamlines(HELIX, [0, 25], {"radius": T})
    assert not as_spline_tubes(lines, scalars="radius").values
    # ... but data of that name that is not the radius used is shown as it is
    assert as_spline_tubes(lines, radius=1.0, scalars="radius").values["radius"].values.tolist() == T.tolist()


NAMED = Streamlines(HELIX, [0, 25], {"size": T, "vectors": HELIX}, {"mean": [1.0]})


@pytest.mark.parametrize(
    ("source", "options", "message"),
    [
        (NAMED, {"radius": -1}, "radius 0 (line 0) is -1.0, expected finite numbers in mm, 0 or more"),
        ([HELIX, HELIX], {"radius": np.r_[np.ones(49), -2]}, "radius 49 (line 1) is -2.0"),
        (NAMED, {"radius": np.nan}, "radius 0 (line 0) is nan"),
        (NAMED, {"radius": "width"}, "radius is 'width', which the source does not have; it has point data 'size'"),
        (HELIX, {"radius": "width"}, "it has no data"),
        (NAMED, {"radius": np.ones(7)}, "radius has the shape (7,), expected a row for each of 25 points or"),
        (NAMED, {"radius": "vectors"}, "radius has the shape (25, 3), expected (n_points)"),
        (NAMED, {"tangents": np.ones(25)}, "tangents has the shape (25,), expected (n_points, 3)"),
        (NAMED, {"tangents": np.full((25, 3), np.inf)}, "tangents 0 (line 0) is [inf, inf, inf]"),
        (NAMED, {"scalars": np.ones((25, 2)), "rgb": True}, "colours with rgb=True"),
        (NAMED, {"scalars": "vectors", "rgb": True}, "colour 0 (line 0) is [10.0, 0.0, 0.0], expected 0 to 1"),
        (NAMED, {"scalars": "size", "rgb": True}, "drop rgb"),
        (NAMED, {"scalars": "mean", "scalar_slopes": T}, "of whole lines, which have none"),
        (NAMED, {"scalar_slopes": T}, "scalar_slopes came without scalars"),
        (HELIX, {"scalars": "radius", "scalar_slopes": T}, "give them as radius_slopes"),
        (NAMED, {"scalars": np.array(["a"] * 25)}, "words per point"),
        (NAMED, {"method": "spline"}, "method is 'spline', expected one of 'finite'"),
        (NAMED, {"method": "catmull-rom", "scaled": True}, "give scaled=False or method='finite'"),
        (pv.Sphere(), {}, "the PolyData has no lines but 1680 other cells"),
        (pv.PolyData(HELIX), {}, "the PolyData has no lines but 25 other cells"),
        ((HELIX, [[0, 1], [1, 25]]), {}, "segment 1 is [1, 25], but there are 25 points"),
        ([HELIX, np.ones((4, 2))], {}, "line 1 has the shape (4, 2), expected (n, 3)"),
        (np.ones((4, 2)), {}, "points have the shape (4, 2), expected (n, 3)"),
    ],
)
def test_bad_values_are_named(source, options, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        as_spline_tubes(source, **options)


@pytest.mark.parametrize("source", [3, "file.vtp", None, pv.ImageData(), {"points": HELIX}])
def test_what_cannot_be_tubes_is_refused(source):
    with pytest.raises(TypeError, match="tubes cannot be made from a"):
        as_spline_tubes(source)
    with pytest.raises(TypeError, match="with them came radius, scalars; leave it out"):
        as_spline_tubes(as_spline_tubes(HELIX), radius=1.0, scalars=T)
