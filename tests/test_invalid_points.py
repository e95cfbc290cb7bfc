"""Points that are no numbers are refused, left out, or end their line; data and groups follow, and all is counted."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.invalid_points import CUT, NONFINITE, valid_points
from pvfiblets.lines import gather

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


def test_compress_says_so_or_does_so(lines):
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
    for given in (mesh, (points, cells)):
        with pytest.warns(UserWarning, match="non-finite points: 1; streamlines added .*: 1"):
            found = gather(given)
        ends, tubes = found.segments()
        np.testing.assert_array_equal(found.points[found.ids[ends], 0], [[0, 1], [3, 4], [4, 5]])
        np.testing.assert_array_equal(tubes, [0, 3, 4] if given is mesh else [0, 1, 1])
        assert np.isfinite(found.points).all()
        assert found.n_rows == (5 if given is mesh else 1)
