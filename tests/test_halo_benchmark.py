"""The benchmarks of halos run from one command each, and what they measure by is right."""

from __future__ import annotations

import argparse
import importlib
import json
import math
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from pvfiblets.engine.halos import HaloRenderer
from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
from pvfiblets.report.cameras import Camera

ROOT = Path(__file__).resolve().parents[1]
SIZE = (160, 120)


@pytest.fixture
def bench(monkeypatch):
    """Return the benchmarks' modules, which are no package."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    names = {"ways": "halo_ways", "command": "halos", "errors": "halo_errors"}
    modules = {key: importlib.import_module(name) for key, name in names.items()}
    yield SimpleNamespace(**modules)
    for name in (*names.values(), "orbit"):
        sys.modules.pop(name, None)


def run(tmp_path, *command):
    """Run a benchmark, and return what it wrote: the JSON's path and content."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg"}
    whole = [sys.executable, *command, "--size", *map(str, SIZE), "--output", str(tmp_path)]
    done = subprocess.run(whole, capture_output=True, text=True, check=False, cwd=ROOT, env=environment)
    assert done.returncode == 0, done.stderr
    (path,) = tmp_path.glob("*.json")
    assert path.with_suffix(".png").stat().st_size > 0
    return path, json.loads(path.read_text())


def test_one_command_measures_halos_beside_plain_lines_and_points(tmp_path):
    command = ["benchmarks/halos.py", "--rows", "lines-30", "points-50-anaglyph", "--places", "2", "--frames", "2"]
    path, told = run(tmp_path, *command)
    rows = {(row["row"], row["way"]): row for row in told["results"]}
    assert set(rows) == {("lines-30", way) for way in ("vtk", "plotter", "engine", "engine-unculled")} | {
        ("points-50-anaglyph", way) for way in ("vtk", "plotter")
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
    command = ["benchmarks/halos.py", "--rows", "points-50", "--ways", "engine", "--limit", "0.01"]
    path, told = run(tmp_path, *command)
    (row,) = told["results"]
    assert row["unmeasured"] == "takes more than 0.01 s here"
    written = path.with_suffix(".md").read_text()
    assert "| points-50 | | |  | engine | unmeasured: takes more than 0.01 s here |" in written


def test_one_command_measures_errors(tmp_path):
    command = ["benchmarks/halo_errors.py", "--sets", "lines-30", "points-50", "--grids", "1", "2", "4"]
    path, told = run(tmp_path, *command, "--places", "2", "--repeats", "1")
    for name in ("lines-30", "points-50"):
        rows = [row for row in told["results"] if row["set"] == name]
        (reference,) = (row for row in rows if row["reference"])
        by = {(row["samples"], row["smooth"]): row for row in rows if not row["reference"]}
        assert set(by) == {(n, smooth) for n in (1, 4, 16) for smooth in (False, True)}
        # More samples, and transitions, are both nearer to the picture of many.
        assert by[1, False]["mean"] > 2.0 * by[4, False]["mean"] > 4.0 * by[16, False]["mean"] > 0.0
        assert by[1, True]["mean"] < 0.5 * by[1, False]["mean"]
        assert reference["mean"] < by[16, False]["mean"]
        assert all(0.0 < row["mean"] <= row["rms"] <= row["max"] <= 1.0 for row in rows)
        assert all(row["ms"] > 0.0 for row in by.values())
    assert "| lines-30 | 64 | reference | |" in path.with_suffix(".md").read_text()


@pytest.mark.parametrize("size", [(400, 100), (100, 400)])
def test_data_fill_the_window_at_every_place(bench, size):
    lines = bench.ways.helices(5)
    extents = []
    cameras = bench.ways.orbit(lines, 4, 2, size)
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


def across(bench, size=(64, 48)):
    """Return one line across a picture, its look and a camera that shows it 64 x 16 pixels wide."""
    camera = Camera(size, np.array([0.0, -100.0, 0.0]), np.zeros(3), 50.0, 150.0)
    k = camera.pixels / 100.0
    line = HaloLines([[-80.0, 0.0, 0.0], [80.0, 0.0, 0.0]], [0, 2])
    return line, HaloStyle(16.0 / k, 24.0 / k, 1.0, n_tapered=0, smooth=False, min_width=0.0), camera


@pytest.mark.parametrize("times", [1, 2, 3])
def test_a_picture_is_as_dark_as_its_line_is_wide(gl, bench, times):
    line, look, camera = across(bench)
    renderer = HaloRenderer(gl, line)
    shown = bench.errors.picture(renderer, camera, look, times)
    assert shown.shape == (48, 64)
    np.testing.assert_array_equal(np.flatnonzero(shown.mean(axis=1) == 1.0), np.arange(16, 32))
    assert shown.sum() == 64 * 16
    renderer.release()


def test_the_least_width_is_in_pixels_of_the_picture(gl, bench):
    line, look, camera = across(bench)
    thin = HaloStyle(1e-3, 1.0, 1.0, n_tapered=0, smooth=False, min_width=4.0)
    renderer = HaloRenderer(gl, line)
    for times in (1, 4):
        assert bench.errors.picture(renderer, camera, thin, times).sum() == 64 * 4
    renderer.release()


def test_tiles_make_the_whole_picture(gl, bench):
    lines = bench.ways.helices(6)
    camera = bench.ways.orbit(lines, 1, 1, (64, 48))[0][0]
    look = bench.errors.look_of(lines)
    renderer = HaloRenderer(gl, lines)
    whole = bench.errors.picture(renderer, camera, look, 4)
    tiled = bench.errors.picture(renderer, camera, look, 4, most=64 * 48)
    assert whole.mean() > 0.02
    # Coordinates are rounded otherwise, so that samples on an edge may turn out otherwise.
    assert abs(tiled - whole).max() <= 1.0 / 16.0 + 1e-6
    assert abs(tiled - whole).mean() < 1e-3
    with pytest.raises(ValueError, match="a picture of 64 x 49 pixels, 4x4 samples each, has no tiles of 100 samples"):
        bench.errors.picture(renderer, SimpleNamespace(size=(64, 49)), look, 4, most=100)
    renderer.release()


def test_errors_of_pictures(bench):
    right = np.zeros((2, 10, 10))
    shown = right.copy()
    shown[0, 0, :4] = 0.5
    told = bench.errors.differences(list(shown), list(right))
    assert told["mean"] == pytest.approx(0.01)
    assert told["rms"] == pytest.approx(math.sqrt(0.25 * 4 / 200))
    assert (told["max"], told["wrong"]) == (0.5, 0.02)


def test_vtk_draws_the_same_lines(bench):
    lines = HaloLines(np.arange(18.0).reshape(6, 3), [0, 2, 2, 6])
    mesh = bench.ways.polydata(lines)
    assert mesh.n_points == 6
    np.testing.assert_array_equal(mesh.lines, [2, 0, 1, 0, 4, 2, 3, 4, 5])
    assert bench.ways.polydata(HaloPoints(lines.points)).n_verts == 6


def test_goals_are_judged_where_there_are_many_vertices(bench):
    about = {"kind": "lines", "vertices": 2_000_000}
    told = bench.command.goals([
        {"row": "a", "way": "vtk", "about": about, "bytes_per_vertex": 20.0, "times_vtk": 1.0},
        {"row": "a", "way": "engine", "about": about, "bytes_per_vertex": 20.1, "times_vtk": 1.4},
        {"row": "a", "way": "plotter", "about": about, "unmeasured": "no"},
        {"row": "b", "way": "engine", "about": {**about, "vertices": 999}, "bytes_per_vertex": 9.0},
    ])  # fmt: skip
    assert told[-1] == "- a, engine: 1.40 times VTK's time, kept; 20.1 bytes a vertex, missed."
    assert len([line for line in told if line.startswith("- ")]) == 1


def test_an_unknown_row_is_refused(bench):
    with pytest.raises(argparse.ArgumentTypeError, match="unknown row 'lines', expected one of shape-small, "):
        bench.command.known_row("lines")
    assert bench.command.known_row("points-8-anaglyph") == "points-8-anaglyph"
    assert bench.ways.row_of("office-anaglyph").data == bench.ways.row_of("office").data == "office"


def test_rows_are_the_papers(bench):
    from pvfiblets.synthetic.halos import HALO_SETS

    assert [row.figure for row in bench.ways.ROWS.values()] == [
        "15(a)", "1", "8(b)", "11", "8(a)", "15(b)", "10(a)", "12", "14", "13",
    ]  # fmt: skip
    assert {row.data for row in bench.ways.ROWS.values()} == set(HALO_SETS)
