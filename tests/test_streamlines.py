"""Streamlines: selection, joining, measures and conversions, against plain lists of arrays."""

import pickle

import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st

import pvfiblets
from pvfiblets.errors import FibletsError, FormatError
from pvfiblets.invalid_points import CUT, NONFINITE, valid_points
from pvfiblets.lines import gather
from pvfiblets.streamlines import Streamlines


def made(counts, seed=0, dtype=np.float32) -> Streamlines:
    rng = np.random.default_rng(seed)
    n, m = sum(counts), len(counts)
    return Streamlines(
        rng.normal(size=(n, 3)).astype(dtype),
        np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        per_point={"fa": rng.random(n), "rgb": rng.integers(0, 255, (n, 3), dtype=np.uint8)},
        per_streamline={"id": np.arange(m), "pair": rng.random((m, 2))},
        groups={"even": np.arange(0, m, 2), "none": np.zeros(0, np.int64)},
        per_group={"even": {"color": np.array([1, 2, 3])}},
        dropped={"reason": 2},
    )


counts_lists = st.lists(st.integers(0, 6), max_size=9)


@given(counts_lists, st.data())
def test_selection_is_that_of_a_list(counts, data):
    s = made(counts)
    rows = [p.tolist() for p in s.to_list()]
    m = len(counts)
    index = data.draw(
        st.one_of(
            st.slices(m),
            st.lists(st.booleans(), min_size=m, max_size=m).map(lambda v: np.array(v, bool)),
            st.lists(st.integers(-m, m - 1), max_size=12).map(lambda v: np.array(v, int))
            if m
            else st.just(np.zeros(0, int)),
        )
    )
    ids = np.arange(m)[index]
    part = s[index]
    assert [p.tolist() for p in part.to_list()] == [rows[i] for i in ids]
    assert part.per_streamline["id"].tolist() == ids.tolist()
    fa = np.split(s.per_point["fa"], s.offsets[1:-1]) if m else []
    assert np.array_equal(part.per_point["fa"], np.concatenate([[], *(fa[i] for i in ids)]))
    # A member of a group is one wherever it went.
    assert sorted(part.groups["even"]) == [k for k, i in enumerate(ids) if i % 2 == 0]
    assert part.per_group["even"]["color"].tolist() == [1, 2, 3]


@given(counts_lists, st.integers(1, 12))
def test_blocks_cover_all_and_join_again(counts, max_points):
    s = made(counts)
    spans = list(s.blocks(max_points))
    assert [i for a, b in spans for i in range(a, b)] == list(range(len(s)))
    assert all(b - a == 1 or s.offsets[b] - s.offsets[a] <= max_points for a, b in spans)
    joined = Streamlines.concatenate([s[a:b] for a, b in spans])
    assert np.array_equal(joined.points, s.points)
    assert np.array_equal(joined.offsets, s.offsets)
    if len(s):
        assert np.array_equal(joined.groups["even"], s.groups["even"])
        assert np.array_equal(joined.per_point["rgb"], s.per_point["rgb"])
    assert joined.dropped == ({"reason": 2 * len(spans)} if spans else {})


@given(counts_lists, st.sampled_from([np.float32, np.float64]))
def test_polydata_and_back(counts, dtype):
    s = made(counts, dtype=dtype)
    back = Streamlines.from_polydata(s.to_polydata())
    assert back.points.dtype == dtype or not s.n_points
    assert np.array_equal(back.points, s.points)
    assert np.array_equal(back.offsets, s.offsets)
    for name in s.per_point if s.n_points else ():
        assert np.array_equal(back.per_point[name], s.per_point[name])
    for name in s.per_streamline if len(s) else ():
        assert np.array_equal(back.per_streamline[name], s.per_streamline[name])
    assert back.groups["even"].tolist() == s.groups["even"].tolist()
    assert back.per_group["even"]["color"].tolist() == [1, 2, 3]


def test_polydata_has_one_polyline_per_streamline_and_other_kinds_are_refused():
    mesh = made([3, 1, 2]).to_polydata()
    assert mesh.n_lines == 3
    assert [mesh.get_cell(i).point_ids for i in range(3)] == [[0, 1, 2], [3], [4, 5]]
    import pyvista as pv

    with pytest.raises(ValueError, match="expected a PolyData"):
        Streamlines.from_polydata(pv.ImageData(dimensions=(2, 2, 2)))


def test_polydata_with_shared_points_and_other_cells():
    import pyvista as pv

    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [5, 5, 5], [9, 9, 9.0]])
    mesh = pv.PolyData(points, lines=[3, 0, 1, 2, 2, 2, 0], verts=[1, 3])
    mesh.point_data["h"] = [0.0, 1, 2, 3, 4]
    mesh.cell_data["c"] = [7, 8, 9]  # the vertex comes first
    s = Streamlines.from_polydata(mesh)
    assert [p.tolist() for p in s] == [points[[0, 1, 2]].tolist(), points[[2, 0]].tolist()]
    assert s.per_point["h"].tolist() == [0, 1, 2, 2, 0]
    assert s.per_streamline["c"].tolist() == [8, 9]
    assert s.dropped == {"cells that are not lines": 1, "points of no line": 2}


def test_lengths_and_bounds_by_arithmetic_also_far_from_the_origin():
    s = Streamlines.from_list([[[0, 0, 0], [3, 4, 0], [3, 4, 12]], [[1, 1, 1]], [], [[0, 0, 0], [0, 0, 0], [0, 2, 0]]])
    assert s.lengths().tolist() == [17, 0, 0, 2]
    assert s.counts.tolist() == [3, 1, 0, 3]
    rng = np.random.default_rng(3)
    counts = rng.integers(0, 400_000, 4)
    points = rng.normal(size=(counts.sum(), 3)) + 1e6
    s = Streamlines(points, np.concatenate([[0], np.cumsum(counts)]))
    expected = [np.linalg.norm(np.diff(p, axis=0), axis=1).sum() for p in s]
    assert np.allclose(s.lengths(), expected, rtol=1e-12)
    s = Streamlines.from_list([[[-5, 2, 3], [1, -2, 9]], [[0, 7, -1]]])
    assert s.bounds == (-5, 1, -2, 7, -1, 9)
    assert all(isinstance(v, float) for v in s.bounds)
    assert np.isnan(Streamlines.from_list([]).bounds).all()


def test_types_are_kept_or_widened_and_memory_shared():
    for given_type, kept in [("f2", "f4"), ("f4", "f4"), ("f8", "f8"), (">f8", "f8"), ("i2", "f8")]:
        s = Streamlines(np.ones((2, 3), given_type), [0, 2])
        assert s.points.dtype == np.dtype(kept)
        assert s.points.dtype.isnative
    s = made([3, 2, 4])
    assert np.shares_memory(s[1], s.points)
    assert np.shares_memory(s[1:].points, s.points)
    assert s[-1].tolist() == s[2].tolist()
    assert s[np.int32(0)].shape == (3, 3)
    with pytest.raises(IndexError, match="integers or a mask"):
        made([1, 1])[np.array([0.5])]
    text = repr(made([3, 2]))
    assert "2 streamlines; 5 points; float32" in text
    assert "fa" in text


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"points": np.zeros((4, 2))}, r"shape \(4, 2\)"),
        ({"points": np.array([["a", "b", "c"]])}, "expected numbers"),
        ({"offsets": [0, 3, 2, 4]}, "decrease after streamline 1"),
        ({"offsets": [0, 3]}, "run from 0 to 3, expected 0 to 4"),
        ({"offsets": [1, 4]}, "run from 1"),
        ({"offsets": []}, "offsets have the shape"),
        ({"offsets": [0.0, 4.0]}, "float64"),
        ({"per_point": {"fa": np.zeros(3)}}, r"per_point\['fa'\].*4 points"),
        ({"per_streamline": {"w": 3.0}}, r"per_streamline\['w'\]"),
        ({"groups": {"g": [2]}}, "group 'g' refers to streamlines 2 to 2"),
        ({"groups": {"g": [-1]}}, "-1"),
        ({"groups": {"g": [0.5]}}, "list of integers"),
        ({"affine": np.eye(3)}, r"\(3, 3\)"),
    ],
)
def test_contradictions_are_named(change, message):
    good = {"points": np.zeros((4, 3)), "offsets": [0, 2, 4]}
    with pytest.raises(ValueError, match=message):
        Streamlines(**{**good, **change})


@pytest.mark.parametrize("index", [3, -4, np.array([0, 3]), np.array([True]), np.zeros((1, 1), int)])
def test_index_out_of_range(index):
    with pytest.raises(IndexError):
        made([1, 1, 1])[index]


def test_parts_that_differ_are_not_joined():
    a, b = made([2]), made([2])
    del b.per_point["fa"]
    with pytest.raises(ValueError, match=r"per_point \['fa'\]"):
        Streamlines.concatenate([a, b])
    assert len(Streamlines.concatenate([])) == 0


def test_format_error_tells_four_facts_and_travels_between_processes():
    error = FormatError("a.tck", 12, "found this", "expected that")
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == "a.tck, byte 12: found found this, expected expected that"
    assert (again.path, again.position, again.found, again.expected) == error.args
    assert isinstance(error, FibletsError)
    assert isinstance(error, ValueError)


NAN, INF = np.nan, np.inf
X = [0, 2, 3, 4, 6, 7, 13, 14]  # of the points that are left of `lines`


@pytest.fixture
def lines():
    """Five lines of x = 0, 1, 2 ...: two with holes, one of nothing, one that is bad throughout, one good."""
    x = [[0, NAN, 2, 3, 4], [INF, 6, 7, NAN], [], [NAN, NAN], [13, 14]]
    points = np.array([[v, i, 0.0] for i, row in enumerate(x) for v in row])
    return pvfiblets.Streamlines(
        points,
        np.cumsum([0, *map(len, x)]),
        {"at": np.arange(13.0)},
        {"weight": np.arange(5.0)},
        {"some": np.array([4, 0]), "bad": np.array([3, 1])},
        {"some": {"n": np.array([2])}},
    )


def told(streamlines):
    return [line[:, 0].tolist() for line in streamlines]


def test_left_out_with_their_data(lines):
    kept = valid_points(lines, "drop")
    assert told(kept) == [[0, 2, 3, 4], [6, 7], [], [], [13, 14]]
    np.testing.assert_array_equal(kept.per_point["at"], [0, 2, 3, 4, 6, 7, 11, 12])
    np.testing.assert_array_equal(kept.per_streamline["weight"], lines.per_streamline["weight"])
    np.testing.assert_array_equal(kept.groups["bad"], [3, 1])
    assert kept.dropped == {"non-finite points": 5}
    assert lines.n_points == 13


def test_split_where_they_were(lines):
    kept = valid_points(lines, "split")
    assert told(kept) == [[0], [2, 3, 4], [6, 7], [], [], [13, 14]]
    np.testing.assert_array_equal(kept.per_streamline["weight"], [0, 0, 1, 2, 3, 4])
    np.testing.assert_array_equal(kept.per_point["at"], [0, 2, 3, 4, 6, 7, 11, 12])
    np.testing.assert_array_equal(kept.groups["some"], [5, 0, 1])
    np.testing.assert_array_equal(kept.groups["bad"], [4, 2])
    assert kept.per_group["some"]["n"] == 2
    assert kept.dropped == {NONFINITE: 5, CUT: 1}


def test_compress_treats_nan_as_chosen(lines):
    with pytest.raises(ValueError, match=r"point 1 is \[nan.*nan='drop' or nan='split'"):
        pvfiblets.compress(lines, nan="error")
    with pytest.raises(ValueError, match="nan is 'skip'; choose one of"):
        pvfiblets.compress(lines, nan="skip")
    whole = pvfiblets.compress(lines[[4]], nan="split")
    assert "non-finite points" not in whole.dropped
    for options, count in (({"nan": "drop"}, 5), ({}, 6)):
        fiblets = pvfiblets.compress(lines, **options, per_point="all")
        assert len(fiblets) == count
        assert fiblets.dropped["non-finite points"] == 5
        finite = lines.points[[0, 2, 3, 4, 6, 7, 11, 12]]
        np.testing.assert_allclose(fiblets.decompress().points, finite, atol=0.005)


@pytest.mark.parametrize("nan", ["drop", "split"])
def test_scalars_of_plotters_follow(lines, nan):
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.add_fiblets(lines, nan=nan, scalars=np.arange(5.0) * 2.0)
    values = actor.fiblets.per_streamline["Data"] if nan == "split" else actor.scalars
    np.testing.assert_array_equal(values, 2.0 * (np.array([0, 0, 1, 2, 3, 4]) if nan == "split" else np.arange(5)))
    actor = plotter.add_fiblets(lines, nan=nan, scalars=np.arange(13.0))
    np.testing.assert_allclose(actor.fiblets.decompress().per_point["Data"], [0, 2, 3, 4, 6, 7, 11, 12], atol=0.05)
    with pytest.raises(ValueError, match="finite coordinates"):
        plotter.add_fiblets(lines, nan="error")
    assert lines.to_polydata().fiblets.compress(nan=nan).n_points == 8
    plotter.close()


@pytest.mark.parametrize("add", ["add_spline_tubes", "add_halo_lines"])
@pytest.mark.parametrize("source", ["streamlines", "polydata", "arrays"])
def test_tubes_and_halos_are_cut_as_files_are(lines, add, source):
    given = {"streamlines": lines, "polydata": lines.to_polydata(), "arrays": list(lines)}[source]
    plotter = pv.Plotter(off_screen=True)
    of_pieces = [0, 0, 10, 20, 30, 40]
    for values, expected in ((np.arange(13.0), [0, 2, 3, 4, 6, 7, 11, 12]), (10.0 * np.arange(5.0), of_pieces)):
        with pytest.warns(UserWarning, match=r"non-finite points: 5; streamlines added .*: 1\)"):
            actor = getattr(plotter, add)(given, scalars=values)
        if add == "add_spline_tubes":
            drawn, stored = actor.tubes, {**actor.tubes.tube_values, **actor.tubes.values}["Data"]
        else:
            drawn = actor.lines
            stored = drawn.values["Data"] if len(values) == 13 else actor.scalars
        np.testing.assert_array_equal(getattr(drawn, "points", getattr(drawn, "positions", None))[:, 0], X)
        np.testing.assert_array_equal(getattr(stored, "values", stored), expected)


def test_cells_of_two_points_are_cut(lines):
    points = np.c_[[0, 1, NAN, 3, 4, 5.0], np.zeros((6, 2))]
    cells = np.c_[np.arange(5), np.arange(1, 6)]
    mesh = pv.PolyData(points, lines=np.c_[np.full(5, 2), cells])
    for mesh_or_cells in (mesh, (points, cells)):
        with pytest.warns(UserWarning, match="non-finite points: 1; streamlines added .*: 1"):
            found = gather(mesh_or_cells)
        ends, tubes = found.segments()
        np.testing.assert_array_equal(found.points[found.ids[ends], 0], [[0, 1], [3, 4], [4, 5]])
        np.testing.assert_array_equal(tubes, [0, 3, 4] if mesh_or_cells is mesh else [0, 1, 1])
        assert np.isfinite(found.points).all()
        assert found.n_rows == (5 if mesh_or_cells is mesh else 1)
