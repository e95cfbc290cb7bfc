"""The study of culling on very little data, and what it measures by."""

import math

import numpy as np
import pytest

from pvfiblets import formats
from pvfiblets.report.record import LeftOut
from pvfiblets.report.studies.codec import data_sets
from pvfiblets.report.studies.culling import study as culling
from pvfiblets.report.studies.culling.flights import Flight
from pvfiblets.report.studies.culling.pictures import Visible, averaged, colours, difference, directions, errors, views
from pvfiblets.report.studies.decode.reference import first_frame
from pvfiblets.report.study import Budget

from .little import little


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(culling, "QUICK_SEGMENTS", 20_000)
    monkeypatch.setattr(culling, "QUICK_SIZE", (96, 64))
    monkeypatch.setattr(culling, "STEP", 0.5)


@pytest.mark.exhaustive
def test_all_variants_are_measured_on_every_scene(gl, small, tmp_path):
    formats.write(tmp_path / "some.tck", data_sets.synthetic_tracking(0.5, False, 2000, 0))
    left = []
    records = list(culling.STUDY.run(little(files=(tmp_path,), left_out=left)))
    assert not left
    scenes = {record.data for record in records}
    assert scenes == {
        "brain, far, 1.14° a frame", "brain, inside, 1.14° a frame", "some.tck",
    }  # fmt: skip
    labels = {f"{method.name} ({method.setting})" for method in culling.variants(True)}
    for scene in scenes:
        found = {record.label: record for record in records if record.data == scene}
        assert set(found) == labels
        assert [record.label for record in found.values() if record.default] == ["auto (every point)"]
        for record in found.values():
            assert all(math.isfinite(figure.value) for figure in record.errors.values())
            assert record.costs["memory"].value > 96 * 64 * 24 / 1e6
            assert 0.0 < record.costs["drawn"].value <= 100.0
            assert record.times["draw"].item == "frame"
            assert record.value("times/draw") > 0.0
        right = found["none (every point)"].errors
        assert {right[name].value for name in ("wrong", "coverage", "colour", "wrong by culling")} == {0.0}
        assert right["fine"].value > 0.0
        # Two-phase culling changes no pixel: its errors are those of the level of detail, to the last digit.
        for setting in ("0.5 px", "every point"):
            plain, culled = (found[f"{name} ({setting})"].errors for name in ("none", "two-phase"))
            assert plain == culled
            assert culled["wrong by culling"].value == 0.0
        fewer = found["fewer streamlines (1 of 2)"]
        assert "wrong by culling" not in fewer.errors
        assert fewer.errors["coverage"].value > found["two-phase (0.5 px)"].errors["coverage"].value
        assert fewer.costs["drawn"].value < 0.7 * found["none (0.5 px)"].costs["drawn"].value


def test_what_time_did_not_suffice_for_is_named(gl, small):
    left = []
    assert list(culling.STUDY.run(little(budget=Budget(0.0), left_out=left))) == []
    late = [item.what for item in left if item.reason == "the time given was used up"]
    assert late == ["brain, far, 1.14° a frame: everything", "brain, inside, 1.14° a frame: everything"]
    assert "real files" in {item.what for item in left}


def test_only_the_largest_files_are_measured_and_the_rest_is_reported(gl, small, tmp_path, monkeypatch):
    monkeypatch.setattr(culling, "QUICK_FLIGHTS", ())
    monkeypatch.setattr(culling, "variants", lambda quick: [])
    for name in ("a", "b"):
        formats.write(tmp_path / f"{name}.tck", data_sets.synthetic_tracking(0.5, False, 800, 0))
    left = []
    assert list(culling.STUDY.run(little(files=(tmp_path,), left_out=left))) == []
    assert left == [LeftOut("smaller files", "the largest are enough to see what culling does")]


# ----------------------------------------------------------------------------------------------------- what it measures


def picture(streamline, tangent=None):
    streamline = np.asarray(streamline, np.int64)
    return Visible(streamline, np.zeros(streamline.shape, np.uint32) if tangent is None else np.asarray(tangent))


def test_what_is_compared_is_right():
    right = picture([[1, 2], [3, 4], [-1, -1]])
    shown = picture([[1, 9], [-1, 4], [5, -1]])
    found = errors([shown, right], [right, right])
    assert found["wrong"].value == pytest.approx(100.0 * 3 / 8)
    assert found["coverage"].value == pytest.approx(100.0 * 2 / 8)
    assert {figure.unit for figure in found.values()} == {"%"}
    nothing = picture([[-1]])
    assert {figure.value for figure in errors([nothing], [nothing]).values()} == {0.0}
    fine = np.arange(4 * 6 * 3, dtype=np.float32).reshape(4, 6, 3)
    found = averaged(fine, 2)
    assert found.shape == (2, 3, 3)
    np.testing.assert_allclose(found[1, 2], fine[2:4, 4:6].reshape(4, 3).mean(axis=0))
    rng = np.random.default_rng(0)
    words = np.array([u & 0xFFFF | (v & 0xFFFF) << 16 for u, v in rng.integers(-32767, 32768, (200, 2)).tolist()])
    w, x, y, z = np.array([first_frame(int(word))[1] for word in words]).T
    forward = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], axis=1)
    np.testing.assert_allclose(directions(words), forward, atol=1e-6)


def test_colours_are_those_of_directions_and_black_elsewhere():
    along_x, along_y = 0, 32767
    found = colours(picture([[7, 7, -1]], np.array([[along_x, along_y, along_y]], np.uint32)))
    np.testing.assert_allclose(found[0], [[1, 0, 0], [0, 1, 0], [0, 0, 0]], atol=1e-6)
    # Of three pixels one shows nothing in both; x for y is two thirds of white apart.
    other = colours(picture([[7, 7, -1]], np.array([[along_y, along_y, along_x]], np.uint32)))
    assert difference([found], [other]).value == pytest.approx(100.0 * (2 / 3) / 2)
    assert difference([found], [found]).value == 0.0


@pytest.mark.parametrize("size", [(160, 90), (90, 160)])
def test_cameras_turn_around_the_middle(size):
    bounds = (10.0, 30.0, -5.0, 5.0, 100.0, 130.0)
    corners = np.array(np.meshgrid(*np.reshape(bounds, (3, 2)), [1.0])).reshape(4, -1).T
    for kind, whole in (("far", True), ("close", False), ("inside", False)):
        path = views(bounds, kind, 20.0, 3, size)
        assert [view.size for view in path] == [size] * 3
        clips = [corners @ view.model_view_projection.T for view in path]
        places = np.array(
            [np.abs(clip[:, :2] / clip[:, 3:]).max() if (clip[:, 3] > 0).all() else 9.0 for clip in clips]
        )
        assert (places < 1.0).all() == whole
        eyes = [np.linalg.svd(view.model_view_projection[[0, 1, 3]])[2][-1] for view in path]
        eyes = [eye[:3] / eye[3] - np.reshape(bounds, (3, 2)).mean(axis=1) for eye in eyes]
        flat = [eye[:2] / np.linalg.norm(eye[:2]) for eye in eyes]
        assert np.degrees(np.arccos(flat[0] @ flat[1])) == pytest.approx(20.0)
        inside = (np.abs(eyes[0]) < [10.0, 5.0, 15.0]).all()
        assert inside == (kind == "inside")


def test_every_picture_of_a_flight_is_one_step_from_the_one_before():
    seen = []

    class Renderer:
        def render(self, view, style):
            seen.append(view)
            return f"{style} {view}"

    class Context:
        def finish(self):
            seen.append("done")

    flight = Flight(Context(), Renderer(), [0, 1, 2], "plain")
    assert len(flight) == 2
    assert flight.pictures(str.upper) == ["PLAIN 1", "PLAIN 2"]
    flight()
    flight()
    assert seen == [0, 1, 2, 1, "done", 0, "done", 1, "done", 2, "done"]
