"""The study of spline tubes: what it measures, what it leaves out, and where it cannot be done."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pvfiblets.report.cameras import ELEVATION, Camera, by_turns, orbit
from pvfiblets.report.record import LeftOut
from pvfiblets.report.studies.tubes import solvers as tubes_solvers
from pvfiblets.report.studies.tubes import study as tubes
from pvfiblets.report.studies.tubes.drawings import MeshedTubes
from pvfiblets.report.studies.tubes.pictures import FORMATS, Truth, helices
from pvfiblets.report.study import Budget
from pvfiblets.tubes import SplineTubes

from .little import little


@pytest.fixture
def small(monkeypatch):
    """Have the study measure hardly anything."""
    monkeypatch.setattr(tubes_solvers, "QUICK_CLASSES", ("usual",))
    monkeypatch.setattr(tubes_solvers, "QUICK_RAYS", 400)
    monkeypatch.setattr(tubes, "QUICK_SIZE", (64, 36))
    monkeypatch.setattr(tubes, "TUBES", 2)


@pytest.mark.more
def test_all_parts_are_measured_and_exact_solvers_are_exact(gl, small):
    left = []
    options = little(left_out=left)
    records = list(tubes.STUDY.run(options))
    assert not left
    assert options.driver.startswith(gl.info["GL_RENDERER"])
    assert all(math.isfinite(figure.value) for record in records for figure in record.errors.values())
    rays = {(record.method, record.setting): record for record in records if record.group == "rays"}
    default = next(record for record in rays.values() if record.default)
    assert default.label == "illinois, loop (48 iterations)"
    assert 0.0 < default.errors["hit p50"].value <= default.errors["hit p99"].value < 1e-4  # float32 rounds, no more
    assert rays["bisection, chain", "2 iterations"].errors["hit p99"].value > 1e-2  # a quarter of a bracket is no root
    assert all(record.times["hit"].each > 0.0 for record in rays.values())
    shown = {(record.data, record.setting): record for record in records if record.group == "pictures"}
    views = ("2 helices, far", "2 helices, close")
    assert {view for view, _ in shown} == {*views, *(f"{view}, in a window" for view in views)}
    for view in ("far", "close"):
        cast, coarse = (shown[f"2 helices, {view}", setting] for setting in ("illinois", "6 sides"))
        assert cast.default
        assert cast.errors["silhouette"].value < 0.02 < coarse.errors["silhouette"].value
        assert cast.errors["depth p99"].value < 1e-3 < coarse.errors["depth p99"].value
        assert coarse.errors["silhouette"].value > shown[f"2 helices, {view}", "30 sides"].errors["silhouette"].value
        assert cast.times["draw"].item == "frame"
        window = f"2 helices, {view}, in a window"
        cast, coarse, fine = (shown[window, setting] for setting in
                              ("in a window", "6 sides", "30 sides, 4 samples a segment"))  # fmt: skip
        assert cast.errors["silhouette"].value < 0.02 < fine.errors["silhouette"].value
        assert fine.errors["silhouette"].value < 0.7 * coarse.errors["silhouette"].value
        # Walls of quads, two flat caps of six corners; 24 bytes a corner, those of caps once more.
        assert coarse.costs["geometry"].value == 2 * (24 * 6 * (25 + 2) + 12 * (24 * 6 * 2 + 2 * 4))
    stiff = [record for record in records if record.group == "stiff"]
    length = next(record for record in stiff if record.data == "length over radius" and record.ours)
    assert length.errors["p99 at ratio 1"].value < 1e-5 < length.errors["p99 at ratio 100000"].value
    stored = {record.method: record.errors for record in records if record.group == "stored"}
    assert stored["24 bits"]["p99 at far/near 1e+06"].value > 0.1
    assert stored["key of 32 bits, as drawn"]["p99 at far/near 1e+06"].value < 0.02
    cubics = {
        record.setting: record.errors["apart max"].value for record in records if record.data.startswith("cubics")
    }
    assert cubics["c = 0.25"] < cubics["c = 1/3, the paper's"]


def test_what_there_was_no_time_for_is_told(gl, small):
    left = []
    records = list(tubes.STUDY.run(little(budget=Budget(0.0), left_out=left)))
    assert all(not record.errors for record in records)
    assert {item.reason for item in left} == {"the time given was used up"}
    told = " ".join(item.what for item in left)
    assert all(name in told for name in ("usual", "2 helices, far", "length over radius", "far/near 10", "fibers"))
    assert isinstance(left[0], LeftOut)


# -------------------------------------------------------------------------------------------------------- its reference


def ball():
    """A sphere of 2 mm around (0, 0, 0), seen from 10 mm in front of it: its camera and what is right."""
    tubes_ = SplineTubes(points=[[0, 0, 0]], segments=[[0, 0]], radius=[2.0], tangents=[[0, 0, 0]], radius_slopes=[0.0],
                         scaled=True, tubes=[0], n_tubes=1)  # fmt: skip
    camera = Camera((120, 80), np.array([0.0, -10.0, 0.0]), np.zeros(3), 5.0, 20.0, 0.4)
    return camera, Truth.from_tubes(tubes_, camera)


def test_what_is_right_is_a_balls_own_formula_and_errors_are_in_radii_and_pixels():
    camera, truth = ball()
    directions, _ = camera.rays(np.arange(120 * 80))
    towards = directions @ [0.0, 10.0, 0.0]
    inside = towards**2 - (100.0 - 4.0)
    assert np.array_equal(truth.there, inside >= 0.0)
    np.testing.assert_allclose(truth.along[truth.there], (towards - np.sqrt(np.maximum(inside, 0.0)))[truth.there])
    np.testing.assert_allclose(truth.radius[truth.there], 2.0)
    right = np.where(truth.there, truth.along * truth.forwards, 1.0)
    found = truth.errors(right, truth.there)
    assert found == {"silhouette": 0.0, "depth p50": pytest.approx(0.0, abs=1e-12), "depth p99": pytest.approx(0.0)}
    off = truth.errors(right + 0.5 * truth.forwards, truth.there)  # by half a mm along each ray
    assert off["depth p50"] == pytest.approx(0.25)
    wide = np.roll(truth.there.reshape(80, 120), 1, axis=1).ravel()  # moved by a pixel: 2/pi of one on average
    assert truth.errors(right, wide)["silhouette"] == pytest.approx(2.0 / np.pi, rel=0.05)
    camera = orbit(helices(1), "far", 2, (8, 8))[0]
    assert camera.distance(1.0 - camera.depth(camera.far)) == pytest.approx(camera.far)
    near = 20.0 / 1e6
    seen = replace(truth, camera=replace(camera, near=near))
    slope = 20.0 / (20.0 - near) * near / 8.0**2  # window depth by mm, 8 mm in front of the eye
    for name, quantum in (
        ("24 bits", 1.0 / (2**24 - 1)),
        ("float32", 2.0**-24),
        ("key of 32 bits, rounded once", 2.0**-32),
    ):
        assert seen.stored(FORMATS[name]) <= 0.51 * quantum / slope / 2.0 * 1.6  # the ball's rim is 9.6 mm away
        assert seen.stored(FORMATS[name]) >= 0.2 * quantum / slope / 2.0


def test_no_picture_is_asked_for_twice_in_a_row():
    seen = []
    cameras = orbit(helices(1), "far", 2, (8, 8))
    draw = by_turns(lambda camera: seen.append(camera.far), cameras)
    for _ in range(3):
        draw()
    assert seen[:2] != seen[2:4] != seen[4:]
    assert seen[:2] == seen[4:]
    np.testing.assert_allclose(seen, [camera.far for camera in cameras] * 3, rtol=1e-6)


def test_a_tessellated_tube_is_as_wide_as_it_should_be(gl):
    tubes_ = SplineTubes(points=[[0, 0, -5], [0, 0, 5]], segments=[[0, 1]], radius=[1, 1], tangents=[[0, 0, 1]] * 2,
                         radius_slopes=[0, 0], scaled=True, tubes=[0], n_tubes=1)  # fmt: skip
    camera = orbit(tubes_, "far", 4, (1600, 900))[0]
    drawn = MeshedTubes(gl, tubes_, (1600, 900), (6, 30))
    drawn.draw(camera)
    _, there = drawn.visible(camera)
    drawn.release()
    distance = np.hypot(*(camera.eye - camera.centre)[:2])  # the tube stands upright, the camera looks down on it
    tilt = np.cos(np.radians(ELEVATION))
    expected = 2.0 * np.tan(np.arcsin(1.0 / distance)) * camera.pixels * tilt
    assert there.reshape(900, 1600)[450].sum() == pytest.approx(expected, abs=2.0)
