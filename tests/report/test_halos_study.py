"""The study of halos on very little data, and what it measures by."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pvfiblets import formats
from pvfiblets.codec.encoding.compress import compress
from pvfiblets.engine.halos import HaloRenderer
from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
from pvfiblets.report.cameras import Camera
from pvfiblets.report.record import LeftOut
from pvfiblets.report.studies.codec import data_sets
from pvfiblets.report.studies.halos import study as halos
from pvfiblets.report.studies.halos.drawing import FibletHalos, Strips
from pvfiblets.report.studies.halos.exact import crossings, gaps, pixel_errors
from pvfiblets.report.studies.halos.pictures import helices, look_of, orbit, picture
from pvfiblets.report.studies.halos.reference import picture as reference
from pvfiblets.report.studies.halos.windows import SETS, HaloWindow, PlainWindow
from pvfiblets.report.study import Budget
from pvfiblets.synthetic.halos import HALO_SETS

from .little import little


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(halos, "QUICK_SIZE", (120, 90))
    monkeypatch.setattr(halos, "QUICK_EXACT_SIZE", (60, 40))
    monkeypatch.setattr(halos, "QUICK_HELICES", 2)


@pytest.mark.more
def test_all_variants_are_measured_on_every_scene(gl, small, tmp_path):
    formats.write(tmp_path / "some.tck", data_sets.synthetic_tracking(0.5, False, 1500, 3))
    left = []
    records = list(halos.STUDY.run(little(points=1500, files=(tmp_path,), left_out=left)))
    assert not left
    windows = [record for record in records if record.data == "helices, 1,200 vertices, in a window"]
    assert [(record.method, record.default) for record in windows] == [("halos", True), ("VTK, plain", False)]
    assert all(record.times["draw"].median > 0.0 for record in windows)
    records = [record for record in records if record not in windows]
    assert {record.data for record in records} == {"2 helices", "crossings", "brain, 0.5 mm", "some.tck"}
    for record in records:
        assert record.errors
        assert all(math.isfinite(figure.value) for figure in record.errors.values())
        assert record.times["draw"].item == "frame"
        assert record.value("times/draw") > 0.0
    for scene in ("brain, 0.5 mm", "some.tck"):
        found = {record.label: record for record in records if record.data == scene}
        assert set(found) == {f"{variant.name} ({variant.setting})" for variant in halos.variants(True, True)} | {
            "black or white (64 samples)", "smooth edges (64 samples)",
        }  # fmt: skip
        assert [record.label for record in found.values() if record.default] == ["smooth edges (1 sample)"]
        mean = {label: record.errors["mean"].value for label, record in found.items()}
        # The picture that all are compared with is off by nothing, and more samples are nearer to it.
        assert {figure.value for figure in found["black or white (64 samples)"].errors.values()} == {0.0}
        assert mean["black or white (1 sample)"] > 2.0 * mean["black or white (4 samples)"] > 0.0
        assert mean["smooth edges (1 sample)"] < mean["black or white (1 sample)"]
        assert 0.0 < mean["smooth edges (64 samples)"] < mean["smooth edges (4 samples)"]
        assert found["smooth, not culled (1 sample)"].errors == found["smooth edges (1 sample)"].errors
        assert mean["halos of fiblets (1 sample)"] < 3.0 * mean["black or white (1 sample)"]


def test_the_float64_reference_is_off_by_nothing_and_pictures_by_next_to_nothing(gl, small):
    found = {r.label: r for r in halos.STUDY.run(little(points=1500)) if r.group == "helices"}
    right = found["float64 reference (1 sample)"]
    assert {figure.value for figure in right.errors.values()} == {0.0}
    assert not right.ours
    shown = found["smooth edges (1 sample)"]
    assert shown.default
    assert shown.errors["kind"].value < 0.1  # percent; a pixel at an edge may fall to either side
    assert shown.errors["mean"].value < 0.1
    assert shown.errors["depth"].value < 1e-4
    assert right.times["draw"].median > shown.times["draw"].median


def test_what_time_did_not_suffice_for_is_named(gl, small):
    left = []
    assert list(halos.STUDY.run(little(points=1500, budget=Budget(0.0), left_out=left))) == []
    late = [item.what for item in left if item.reason == "the time given was used up"]
    assert late[0] == "2 helices: everything"
    assert late[1:3] == ["crossings: everything", "brain, 0.5 mm: everything"]


def test_only_the_largest_files_are_measured_and_the_rest_is_reported(gl, small, tmp_path):
    for name in ("a", "b"):
        formats.write(tmp_path / f"{name}.tck", data_sets.synthetic_tracking(0.5, False, 300, 0))
    left = []
    found = halos.scenes(little(points=1500, files=(tmp_path,), left_out=left))
    assert [scene.name for scene in found] == ["brain, 0.5 mm", "a.tck"]
    assert left == [LeftOut("smaller files", "the largest are enough to see what halos are off by")]


# ----------------------------------------------------------------------------------------------------- what it measures


def test_gaps_of_a_perfect_picture_are_the_formula():
    """Drawn here without the engine: along a line behind, black but for a gap on either side of a line in front."""
    made = crossings()
    width, height = made.size
    half_line = 4.0
    fine = (np.arange(width * 50) + 0.5) / 50
    shown = np.zeros((height, width), np.float32)
    for row, right in zip(made.rows, made.truth, strict=True):
        away = np.abs(fine[:, None] - made.columns).min(axis=1)
        black = (away < half_line) | (away > half_line + right)
        shown[int(row) - 4 : int(row) + 4] = black.reshape(width, 50).mean(axis=1)
    found = gaps(shown, made)
    assert found["gap max"].value < 0.03  # samples are a fiftieth of a pixel apart
    assert found["gap"].value <= found["gap max"].value
    assert {figure.unit for figure in found.values()} == {"px"}
    # All black has no gaps: it is off by the mean of all widths.
    nothing = gaps(np.ones((height, width), np.float32), made)
    assert nothing["gap"].value == pytest.approx(made.truth.mean())
    assert nothing["gap max"].value == pytest.approx(made.truth.max())


def test_gaps_near_the_formula_with_the_number_of_samples(gl):
    made = crossings()
    assert made.truth[0] == 0.0
    assert made.truth[-1] == 12.0  # half of the strip's 32 pixels less the line's 8
    found = []
    for times in (1, 2, 4):
        strips = Strips(gl, made.lines, times)
        found.append(gaps(strips.read(strips.render(made, made.look)), made)["gap max"].value)
        strips.release()
    assert found[0] < 1.0
    assert found[1] < 0.6 * found[0]
    assert found[2] < 0.6 * found[1]


def test_pixel_errors_tell_what_differs(gl):
    drawn = helices(3)
    look = replace(look_of(drawn), smooth=False)
    camera = orbit(drawn, 1, 1, (80, 60))[0][1]
    strips = Strips(gl, drawn)
    buffer = strips.render(camera, look)
    dark = strips.read(buffer)
    right = reference(drawn, look, camera.model_view_projection, camera.size)
    kept = pixel_errors(buffer, dark, right, camera)
    changed = right.kind.copy()
    changed[0, :8] = (changed[0, :8] + 1) % 3
    wrong = pixel_errors(buffer, dark, replace(right, kind=changed), camera)
    assert wrong["kind"].value == pytest.approx(kept["kind"].value + 100.0 * 8 / 4800, abs=1e-6)
    # Depth is told in mm along the view axis: one mm farther away is one mm of error.
    near, far = camera.near, camera.far
    distance = far * near / (far - right.depth * (far - near))
    farther = (far - far * near / (distance + 1e-3)) / (far - near)
    moved = pixel_errors(buffer, dark, replace(right, depth=farther), camera)
    assert moved["depth"].value == pytest.approx(1e-3, rel=0.02)
    darker = pixel_errors(buffer, dark + np.float32(0.25), right, camera)
    assert darker["mean"].value == pytest.approx(kept["mean"].value + 25.0, abs=0.1)
    strips.release()


def test_halos_of_fiblets_are_those_of_the_same_lines(gl):
    scene = next(halos.scenes(little(points=1500)))
    fiblets = compress(scene.tractogram.streamlines)
    shown = []
    for drawing in (FibletHalos(gl, fiblets, 2), Strips(gl, scene.drawn, 2)):
        camera = scene.path[1]
        shown.append(drawing.read(drawing.render(camera, replace(scene.look, smooth=False))))
        assert 0 < drawing.nbytes < 200 * fiblets.n_points
        drawing.release()
    assert shown[1].mean() > 0.01
    assert np.abs(shown[0] - shown[1]).mean() < 0.35 * shown[1].mean()
    assert shown[0].mean() == pytest.approx(shown[1].mean(), rel=0.15)


def across(size=(64, 48)):
    """Return one line across a picture, its look and a camera that shows it 64 x 16 pixels wide."""
    camera = Camera(size, np.array([0.0, -100.0, 0.0]), np.zeros(3), 50.0, 150.0)
    k = camera.pixels / 100.0
    line = HaloLines([[-80.0, 0.0, 0.0], [80.0, 0.0, 0.0]], [0, 2])
    return line, HaloStyle(16.0 / k, 24.0 / k, 1.0, n_tapered=0, smooth=False, min_width=0.0), camera


@pytest.mark.parametrize("times", [1, 2, 3])
def test_a_picture_is_as_dark_as_its_line_is_wide(gl, times):
    line, look, camera = across()
    renderer = HaloRenderer(gl, line)
    shown = picture(renderer, camera, look, times)
    assert shown.shape == (48, 64)
    np.testing.assert_array_equal(np.flatnonzero(shown.mean(axis=1) == 1.0), np.arange(16, 32))
    assert shown.sum() == 64 * 16
    renderer.release()


def test_tiles_make_the_whole_picture(gl):
    lines = helices(6)
    camera = orbit(lines, 1, 1, (64, 48))[0][0]
    look = look_of(lines)
    renderer = HaloRenderer(gl, lines)
    whole = picture(renderer, camera, look, 4)
    tiled = picture(renderer, camera, look, 4, most=64 * 48)
    assert whole.mean() > 0.02
    # Coordinates are rounded otherwise, so that samples on an edge may turn out otherwise.
    assert abs(tiled - whole).max() <= 1.0 / 16.0 + 1e-6
    assert abs(tiled - whole).mean() < 1e-3
    with pytest.raises(ValueError, match="a picture of 64 x 49 pixels, 4x4 samples each, has no tiles of 100 samples"):
        picture(renderer, SimpleNamespace(size=(64, 49)), look, 4, most=100)
    renderer.release()


# ------------------------------------------------------------------------------------------------------------- windows


def test_windows_show_the_engines_halos_and_count_bytes(gl):
    lines = helices(30)
    look, camera = look_of(lines), orbit(lines, 1, 1, (160, 120))[0][0]
    strips = Strips(gl, lines)
    dark = strips.read(strips.render(camera, look)).mean()
    strips.release()
    window = HaloWindow(lines, look, camera)
    window.draw(camera)
    # One look, whoever draws it; a picture of black lines on white differs by rounding to bytes alone.
    assert 1.0 - window.colours().mean() == pytest.approx(dark, abs=2e-3)
    assert 0 < window.nbytes - (12 + 2 + 12) * 1200 < 1000  # places, masks and, of what is not culled, indices
    window.release()
    points = HaloPoints(lines.points)
    for drawn, nbytes in ((lines, 12 * 1200 + 8 * 30 * 39), (points, 16 * 1200)):
        window = PlainWindow(drawn, look_of(drawn), camera)
        window.draw(camera)
        assert window.nbytes == nbytes
        assert 0.0 < 1.0 - window.colours().mean() < 0.5
        window.release()


@pytest.mark.parametrize("size", [(400, 100), (100, 400)])
def test_data_fill_the_window_at_every_place(size):
    lines = helices(5)
    extents = []
    cameras = orbit(lines, 4, 2, size)
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


def test_windows_show_all_sets_of_the_paper():
    assert set(SETS) == set(HALO_SETS)
