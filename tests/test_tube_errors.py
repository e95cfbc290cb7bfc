"""The error report of spline tubes runs from one command, and judges rightly."""

from __future__ import annotations

import dataclasses
import importlib
import json
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from pvfiblets.report.cameras import Lens, orbit
from pvfiblets.report.tubes_rays import Rays, of_class, of_set
from pvfiblets.report.tubes_sweeps import lengthwise

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture
def bench(monkeypatch):
    """Return the report's modules, which are no package."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    names = {"pictures": "tube_error_pictures", "sweeps": "tube_error_sweeps", "command": "tube_errors",
             "ways": "tube_ways", "reference": "tube_reference"}  # fmt: skip
    modules = {key: importlib.import_module(name) for key, name in names.items()}
    yield SimpleNamespace(**modules)
    for name in (*names.values(), "orbit"):
        sys.modules.pop(name, None)


@pytest.fixture
def tubes(bench):
    return bench.ways.helices(4, 9)


def test_one_command_measures_all_parts(tmp_path):
    command = [sys.executable, "benchmarks/tube_errors.py", "--quick", "--sets", "helices-3", "--size", "160", "90"]
    command += ["--rays", "400", "--iterations", "2", "8", "--pixels", "300", "--segments", "20", "--repeats", "1"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg"}
    done = subprocess.run(
        [*command, "--output", str(tmp_path)], capture_output=True, text=True, check=False, cwd=ROOT, env=environment
    )
    assert done.returncode == 0, done.stderr
    (path,) = tmp_path.glob("tube-errors-*.json")
    told = json.loads(path.read_text())
    rows = {part: [row for row in told["results"] if row["part"] == part]
            for part in ("solvers", "pictures", "sweeps", "approximation")}  # fmt: skip
    assert {row["of"] for row in rows["solvers"]} == {"thin", "usual", "bent", "thick", "blob", "cone", "helices-3"}
    (default,) = (row for row in rows["solvers"] if row["default"] and row["of"] == "usual")
    assert default["way"] == told["default"]
    assert 0.0 < default["p50"] <= default["p99"] <= default["max"] < 1e-3  # float32 rounds, and does no worse
    coarse = next(row for row in rows["solvers"]
                  if (row["of"], row["solver"], row["iterations"]) == ("usual", "bisection", 2))  # fmt: skip
    assert coarse["p99"] > 1e-2  # a quarter of the bracket is no root
    assert {(row["view"], row["default"]) for row in rows["pictures"]} == {
        ("far", True), ("close", True), ("far", False), ("close", False)
    }  # fmt: skip
    assert all(0.0 < row["depth"]["p99"] and row["ms"] > 0.0 for row in rows["pictures"])
    assert len({row["sweep"] for row in rows["sweeps"]}) == 7
    better, papers = rows["approximation"]
    assert better["share"] == 0.25
    assert better["p99"] < papers["p99"]
    text = path.with_suffix(".md").read_text()
    for heading in ("Solvers alone", "Whole pictures", "Stiff and extreme", "Two quadratics"):
        assert f"## {heading}" in text
    assert path.with_suffix(".png").stat().st_size > 0


def test_the_error_of_a_ray_by_a_sphere(bench):
    ball = np.tile([1.0, 2.0, 3.0, 0.5], (5, 3, 1))
    beside = np.array([0.0, 0.3, 0.4, 0.49, 0.6])
    origins = np.stack([1.0 + beside, np.full(5, 2.0), np.full(5, -7.0)], axis=1)
    rays = Rays(ball, origins, np.tile([0.0, 0.0, 1.0], (5, 1)))
    depth = 10.0 - np.sqrt(np.maximum(0.25 - beside**2, 0.0))
    np.testing.assert_allclose(rays.clearance, beside - 0.5, atol=1e-12)
    right = rays.errors(np.where(beside < 0.5, depth, np.nan), np.full(5, 0.5), (beside < 0.5).astype(int))
    assert right["max"] < 1e-12
    assert right["missed"] == right["false"] == right["silhouette"] == 0.0
    # One is 0.05 mm too far, one is missed 0.01 mm inside the silhouette, one is met 0.1 mm outside of it.
    off = rays.errors(depth + [0.0, 0.05, 0.0, np.nan, 0.0], np.full(5, 0.5), np.array([1, 1, 1, 0, 1]))
    assert off["missed"] == off["false"] == pytest.approx(0.2)
    assert off["silhouette"] == pytest.approx(0.2)
    assert off["above_goal"] == pytest.approx(0.6)
    assert off["p50"] == pytest.approx(0.02)


def test_rays_are_aimed_at_their_halves(bench, tubes):
    for rays in (of_class("bent", 500), of_set(tubes, 500, (320, 180))):
        assert len(rays.controls) == 500
        np.testing.assert_allclose(np.linalg.norm(rays.directions, axis=1), 1.0)
        share = (rays.truth.kind > 0).mean()
        assert 0.7 < share < 1.0  # within 1.15 radii: a quarter of a disc is beyond 1, but another sphere may be there
        np.testing.assert_array_equal(rays.truth.kind > 0, rays.clearance < 0.0)


def test_a_lens_is_the_orbits_camera(bench, tubes):
    camera = orbit(tubes, "close", 4, (160, 90))[1]
    lens = Lens.of(camera)
    np.testing.assert_allclose(lens.matrix, camera.model_view_projection, rtol=1e-12)
    pixels = np.array([0, 159, 7250, 160 * 90 - 1])
    directions, forwards = lens.rays(pixels)
    w = np.array([lens.near, 0.5 * (lens.near + lens.far), lens.far, lens.near])
    points = lens.eye + (w / forwards)[:, None] * directions
    clip = np.column_stack([points, np.ones(4)]) @ camera.model_view_projection.T
    ndc = clip[:, :3] / clip[:, 3:]
    np.testing.assert_allclose((ndc[:, 0] + 1.0) * 80.0, pixels % 160 + 0.5, atol=1e-7)
    np.testing.assert_allclose((ndc[:, 1] + 1.0) * 45.0, pixels // 160 + 0.5, atol=1e-7)
    np.testing.assert_allclose(0.5 * (ndc[:, 2] + 1.0), lens.depth(w), atol=1e-12)
    np.testing.assert_allclose(lens.distance(1.0 - lens.depth(w)), w, rtol=1e-9)


def test_the_nearest_of_all_is_found(bench, tubes):
    from pvfiblets.tubes.reference import nearest_hits

    lens = Lens.of(orbit(tubes, "close", 4, (160, 90))[0])
    pixels = np.arange(0, 160 * 90, 37)
    directions, forwards = lens.rays(pixels)
    found, _, segment = bench.pictures.nearest(tubes, lens, pixels, lens.far / forwards)
    halves = bench.pictures.widened(tubes, np.arange(tubes.n_segments), lens).reshape(-1, 3, 4)
    true = nearest_hits(halves, lens.eye, directions, start=lens.near / forwards, end=lens.far / forwards)
    np.testing.assert_array_equal(np.isfinite(found), true.half >= 0)
    met = np.isfinite(found)
    assert 20 < met.sum() < len(pixels)
    np.testing.assert_allclose(found[met], true.l[met], rtol=1e-12)
    # Where two meet at one node either may be named.
    assert (segment[met] == true.half[met] // 2).mean() > 0.95


def test_tubes_are_widened_to_a_pixel(bench, tubes):
    lens = Lens.of(orbit(tubes, "far", 4, (160, 90))[0])
    hair = dataclasses.replace(tubes, radius=0.0 * tubes.radius, radius_slopes=0.0 * tubes.radius)
    ends = bench.pictures.widened(hair, np.arange(hair.n_segments), lens)[:, [0, 1], [0, 2]]
    # The width in pixels of what is seen at an end: its diameter over what a pixel takes there.
    per_mm = 45.0 / np.tan(np.radians(22.5)) / ((lens.eye - ends[..., :3]) @ lens.backwards)
    np.testing.assert_allclose(2.0 * ends[..., 3] * per_mm, 1.0)
    exact = bench.pictures.widened(tubes, np.arange(tubes.n_segments), lens, 0.0)[:, 0, 0]
    np.testing.assert_allclose(exact[:, 3], tubes.radius[tubes.segments[:, 0]])


def test_the_front_holds_what_nothing_beats(bench):
    rows = [{"ns": ns, "p99.9": error} for ns, error in ((10, 0.1), (20, 0.5), (30, 0.01), (30, 0.02), (40, 0.01))]
    bench.command.mark_front(rows)
    assert [row["front"] for row in rows] == [True, False, True, False, False]


def test_what_float32_holds_up_to(bench):
    rows = [{"ratio": ratio, "p99": error} for ratio, error in ((1, 1e-6), (10, 1e-5), (100, 2e-4), (1000, 5e-5))]
    assert bench.sweeps.holding(rows, 1e-4) == (10, 100)
    assert bench.sweeps.holding(rows, 1e-2) == (1000, None)
    assert bench.sweeps.holding(rows, 1e-7) == (None, 1)


def test_swept_angles_are_those_asked_for(bench):
    rng = np.random.default_rng(0)
    for degrees in (90.0, 10.0, 0.1, 0.0):
        rays = lengthwise(degrees, 50, rng)
        axis = rays.controls[:, 2, :3] - rays.controls[:, 0, :3]
        across = np.linalg.norm(np.cross(axis, rays.directions), axis=1)
        along = np.einsum("ni,ni->n", axis, rays.directions)
        np.testing.assert_allclose(np.degrees(np.arctan2(across, along)), degrees, atol=1e-9)
