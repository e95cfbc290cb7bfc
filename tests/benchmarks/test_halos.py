"""The benchmark of halos runs from one command, and what it measures by is right."""

import math

import numpy as np
import pytest

from .scripts import imported, run

SIZE = (160, 120)


@pytest.fixture
def bench():
    """Return the benchmark's modules."""
    with imported(methods="halos_methods", command="halos") as modules:
        yield modules


@pytest.mark.exhaustive
def test_one_command_measures_halos_beside_plain_lines_and_points(tmp_path):
    command = ["--rows", "lines-30", "points-50-anaglyph", "--places", "2", "--frames", "2"]
    path, told = run(tmp_path, "halos", *command, "--size", *SIZE)
    rows = {(row["row"], row["method"]): row for row in told["results"]}
    assert set(rows) == {("lines-30", method) for method in ("vtk", "plotter", "engine", "engine-unculled")} | {
        ("points-50-anaglyph", method) for method in ("vtk", "plotter")
    }
    for row in rows.values():
        assert "unmeasured" not in row
        assert row["frames"] == 4
        assert row["ms_spread"][0] <= row["ms"] <= row["ms_spread"][1]
        assert row["about"]["anaglyph"] == (row["row"] == "points-50-anaglyph")
    plain, ours = rows["lines-30", "vtk"], rows["lines-30", "engine"]
    assert plain["gpu_bytes"] == 12 * 1200 + 8 * 30 * 39
    assert rows["points-50-anaglyph", "vtk"]["gpu_bytes"] == 16 * 500
    assert ours["times_vtk"] == pytest.approx(ours["ms"] / plain["ms"])
    # One look, whoever draws it; a picture of black lines on white differs by rounding to bytes alone.
    assert ours["darkness"] == rows["lines-30", "engine-unculled"]["darkness"]
    assert rows["lines-30", "plotter"]["darkness"] == pytest.approx(ours["darkness"], abs=2e-3)
    assert 0.0 < rows["points-50-anaglyph", "plotter"]["darkness"] < 0.1
    written = path.with_suffix(".md").read_text()
    assert f"| lines-30 | 30 | 1,200 | {plain['strip_pixels']:.1f} | vtk | {plain['ms']:.1f} " in written


def test_what_takes_too_long_is_left_out_and_said(tmp_path):
    command = ["--rows", "points-50", "--methods", "engine", "--limit", "0.01"]
    path, told = run(tmp_path, "halos", *command, "--size", *SIZE)
    (row,) = told["results"]
    assert row["unmeasured"] == "takes more than 0.01 s here"
    written = path.with_suffix(".md").read_text()
    assert "| points-50 | | |  | engine | unmeasured: takes more than 0.01 s here |" in written


@pytest.mark.parametrize("size", [(400, 100), (100, 400)])
def test_data_fill_the_window_at_every_place(bench, size):
    lines = bench.methods.helices(5)
    extents = []
    cameras = bench.methods.orbit(lines, 4, 2, size)
    assert [len(place) for place in cameras] == [3] * 4
    for camera in np.ravel(cameras):
        clip = np.column_stack([lines.points, np.ones(lines.n_points)]) @ camera.model_view_projection.T
        assert (clip[:, 3] > 0.0).all()
        place = abs(clip[:, :3] / clip[:, 3:])
        assert place.max() < 1.0
        extents.append(place[:, :2].max())
    assert max(extents) > 0.98
    turn = [camera.backwards[:2] / np.linalg.norm(camera.backwards[:2]) for camera in cameras[0]]
    assert math.degrees(math.acos(turn[0] @ turn[1])) == pytest.approx(1.14)


def test_goals_are_judged_where_there_are_many_vertices(bench):
    about = {"kind": "lines", "vertices": 2_000_000}
    told = bench.command.goals([
        {"row": "a", "method": "vtk", "about": about, "bytes_per_vertex": 20.0, "times_vtk": 1.0},
        {"row": "a", "method": "engine", "about": about, "bytes_per_vertex": 20.1, "times_vtk": 1.4},
        {"row": "a", "method": "plotter", "about": about, "unmeasured": "no"},
        {"row": "b", "method": "engine", "about": {**about, "vertices": 999}, "bytes_per_vertex": 9.0},
    ])  # fmt: skip
    assert told[-1] == "- a, engine: 1.40 times VTK's time, kept; 20.1 bytes a vertex, missed."
    assert len([line for line in told if line.startswith("- ")]) == 1


def test_rows_are_the_papers(bench):
    from pvfiblets.synthetic.halos import HALO_SETS

    assert [row.figure for row in bench.methods.ROWS.values()] == [
        "15(a)", "1", "8(b)", "11", "8(a)", "15(b)", "10(a)", "12", "14", "13",
    ]  # fmt: skip
    assert {row.data for row in bench.methods.ROWS.values()} == set(HALO_SETS)
