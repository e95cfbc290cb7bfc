"""Tables of streamlines: NumPy and the csv module find the same."""

import csv

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.cli import command as cli
from pvfiblets.query.measures.measures import measure


@pytest.fixture
def lines():
    """Three lines and one without points; values of all sorts, one missing."""
    rng = np.random.default_rng(1)
    points = np.cumsum(rng.normal(size=(30, 3)), axis=0)
    fa = np.linspace(0.0, 1.0, 30)
    fa[3] = np.nan
    return pf.Streamlines(
        points, [0, 10, 10, 11, 30], {"fa": fa, "rgb": rng.random((30, 3))},
        {"weight": [1.0, 2.0, np.nan, 4.0], "name": np.array(["a", "b", "c, d", "e"])},
        {"left": [0, 3], "long": [3]},
    )  # fmt: skip


@pytest.mark.parametrize("coded", [False, True])
def test_rows_are_numpys(lines, coded):
    data = pf.compress(lines, per_point=["fa", "rgb"], max_error=1e-4, per_point_bits=16) if coded else lines
    found, near = data.table(), {"atol": 2e-3 if coded else 1e-12}
    each = list(lines)
    assert found["streamline"].tolist() == [0, 1, 2, 3]
    assert found["n_points"].tolist() == [10, 0, 1, 19]
    length = [np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in each]
    np.testing.assert_allclose(found["length"], length, **near)
    for i, axis in enumerate("xyz"):
        np.testing.assert_allclose(found[f"start_{axis}"], [s[0][i] if len(s) else np.nan for s in each], **near)
        np.testing.assert_allclose(found[f"end_{axis}"], [s[-1][i] if len(s) else np.nan for s in each], **near)
    apart = [np.linalg.norm(s[-1] - s[0]) if len(s) else np.nan for s in each]
    np.testing.assert_allclose(found["end_distance"], apart, **near)
    fa = np.asarray(lines.per_point["fa"])
    steps = [np.linalg.norm(np.diff(each[k], axis=0), axis=1) for k in (0, 3)]
    lengths = [np.convolve(step, [0.5, 0.5]) for step in steps]  # half of the segments beside each point
    some = np.isfinite(fa[:10])
    weighed = [np.average(fa[:10][some], weights=lengths[0][some]), np.average(fa[11:], weights=lengths[1])]
    np.testing.assert_allclose(found["mean_fa"], [weighed[0], np.nan, fa[10], weighed[1]], **near)
    means = [np.nanmean(fa[:10]), np.nan, fa[10], fa[11:].mean()]
    np.testing.assert_allclose(data.table(weights="points")["mean_fa"], means, **near)
    assert {"mean_rgb[0]", "mean_rgb[1]", "mean_rgb[2]"} <= set(found)
    assert found["groups"].tolist() == ["left", "", "", "left;long"]
    assert found["name"].tolist() == ["a", "b", "c, d", "e"]
    if coded:
        np.testing.assert_allclose(found["mean_curvature"], measure(data, "mean_curvature").array())
    some = data.table([3, 0, 3])
    assert some["streamline"].tolist() == [3, 0]
    assert some["length"].tolist() == found["length"][[3, 0]].tolist()
    image = (np.random.default_rng(2).random((9, 9, 9)), np.diag([2.0, 2, 2, 1]))
    t1 = data.table([3, 0], images={"t1": image})["mean_t1"]
    np.testing.assert_array_equal(t1, data.sample(image, "mean")[[3, 0]])
    assert data.table([]).n_rows == 0
    assert set(data.table([])) == set(found)


def test_the_command_writes_what_the_csv_module_reads(lines, tmp_path, capsys):
    pf.compress(lines, per_point=["fa"]).save(tmp_path / "a.fiblets")
    table = pf.FibletSet.open(tmp_path / "a.fiblets").table()
    assert cli.main(["table", str(tmp_path / "a.fiblets"), str(tmp_path / "a.csv")]) == 0
    rows = list(csv.DictReader((tmp_path / "a.csv").read_text().splitlines()))
    assert list(rows[0]) == list(table)
    assert [float(row["length"]) for row in rows] == table["length"].tolist()
    assert [row["name"] for row in rows] == ["a", "b", "c, d", "e"]
    assert [row["weight"] for row in rows] == ["1.0", "2.0", "", "4.0"]
    assert cli.main(["table", str(tmp_path / "a.fiblets"), "--group", "long"]) == 0
    assert [row["streamline"] for row in csv.DictReader(capsys.readouterr().out.splitlines())] == ["3"]
    assert cli.main(["table", str(tmp_path / "a.fiblets"), "--group", "wide"]) == 1
    assert "has no group 'wide'; it has: left, long" in capsys.readouterr().err


def test_notebooks_get_html(lines):
    lines.groups["<b>"] = np.array([0])
    for text in (lines._repr_html_(), pf.compress(lines)._repr_html_()):
        assert "&lt;b&gt;" in text
        assert "<b>" not in text
        assert "Streamlines</th><td>4<" in text
    assert "&lt;b&gt;" in lines.table()._repr_html_()
    assert "4 streamlines" in lines.table()._repr_html_()
