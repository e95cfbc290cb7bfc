"""The study of features on very little data."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pvfiblets import compress
from pvfiblets.report.pareto import mark_fronts
from pvfiblets.report.studies.features import study as features
from pvfiblets.report.studies.features import window as features_window
from pvfiblets.report.studies.features.pictures import PICTURE_EFFECTS, PictureEffect, WholePicture
from pvfiblets.report.studies.features.scenes import PLAIN, Drawn
from pvfiblets.report.studies.features.subjects import brain_subject
from pvfiblets.report.study import Budget
from pvfiblets.synthetic import brain_streamlines

from .little import little

SIZE = (96, 64)
PIXELS = SIZE[0] * SIZE[1]
IN_WINDOW = ("plane", "mesh", "length", "ambient occlusion", "depth cue", "one")  # of all that take half a minute


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(features, "QUICK_SEGMENTS", 10_000)
    monkeypatch.setattr(features, "QUICK_TUBES", 6)
    monkeypatch.setattr(features, "QUICK_VOXELS", 12)
    monkeypatch.setattr(features, "QUICK_SIZE", SIZE)


@pytest.fixture(scope="module")
def measured(_headless, request):
    """What is found on very little data, by subject and feature."""
    every = features_window.window_features
    with pytest.MonkeyPatch.context() as patch, _headless.context(request.module):
        for name, value in {"SEGMENTS": 10_000, "TUBES": 6, "VOXELS": 12, "SIZE": SIZE}.items():
            patch.setattr(features, f"QUICK_{name}", value)
        patch.setattr(features_window, "window_features", lambda made: [f for f in every(made) if f.name in IN_WINDOW])
        left = []
        records = list(features.STUDY.run(little(left_out=left)))
    assert not left
    return {(record.group, record.method, record.setting): record for record in records}


def more(found, *name):
    """Bytes that a feature adds."""
    return 1e6 * found[name].costs["more memory"].value


@pytest.mark.more
def test_every_subject_is_beside_its_plain_self(measured):
    plain = {key: record for key, record in measured.items() if record.default}
    assert {key[0] for key in plain} == {"streamlines", "spline-tubes", "lines-with-halos", "volume", "window"}
    assert all(key[1] == PLAIN for key in plain)
    for record in plain.values():
        assert record.costs["more memory"].value == record.costs["more time"].value == 0.0
        assert record.costs["memory"].value > PIXELS * 24 / 1e6  # the G-buffer alone


@pytest.mark.more
def test_features_in_a_window_cost_frames_and_changes(measured):
    found = {key[1:]: record for key, record in measured.items() if key[0] == "window"}
    assert {group for group, _ in found} == {"cut", "criterion", "effects", "colours", PLAIN}
    assert found["effects", "depth cue"].costs["more memory"].value == 0.0  # VTK's shader alone
    assert found["effects", "ambient occlusion"].costs["more memory"].value == pytest.approx(2 * PIXELS / 1e6)
    assert found["cut", "mesh"].costs["more memory"].value > found["cut", "plane"].costs["more memory"].value
    varied = [name for name, record in found.items() if "change" in record.times]
    assert ("cut", "plane") in varied
    assert ("colours", "one") not in varied


@pytest.mark.more
def test_figures_are_finite_and_no_feature_is_better_for_being_cheaper(measured):
    for record in measured.values():
        assert all(math.isfinite(figure.value) for figure in record.costs.values())
        assert record.value("times/draw") > 0.0
        assert record.times["draw"].item == "frame"
        assert record.errors == {}
    # None is better than another for being cheaper.
    mark_fronts(measured.values(), features.STUDY.axes)
    assert not any(record.front for record in measured.values())


@pytest.mark.more
def test_bytes_are_those_that_a_feature_asks_for(measured):
    """By the formats of textures: what is said of a pixel, how often."""
    assert more(measured, "streamlines", "lines", "3 pixels wide") == 0
    assert more(measured, "streamlines", "lines", "3 pixels wide, shaded") == pytest.approx(2 * PIXELS)
    assert more(measured, "streamlines", "cut", "plane") == pytest.approx(400)  # planes, brushes, how many: std140
    # Two textures of a byte for each pixel.
    assert more(measured, "streamlines", "effects", "ambient occlusion") == pytest.approx(2 * PIXELS)
    # A copy of colours and, for the focus, of depths; of each pixel its disc, and what reaches squares of 8 pixels.
    copy, squares = 4 * PIXELS, (SIZE[0] // 8) * (SIZE[1] // 8)
    for name in ("film tones", "brightness and contrast", "gamma"):
        assert more(measured, "streamlines", "picture", name) == pytest.approx(copy)
    focused = more(measured, "streamlines", "picture", "depth of field")
    assert copy + (4 + 16) * PIXELS + (4 + 4 + 16) * squares <= focused < 1.1 * (copy + 20 * PIXELS + 24 * squares)
    assert more(measured, "streamlines", "picture", "depth of field and film tones") == pytest.approx(focused)
    # Planes alone, or a layer of 16 bytes a pixel, and the shapes.
    for subject in ("streamlines", "volume"):
        assert more(measured, subject, "cut", "box") <= 400
        assert 16 * PIXELS < more(measured, subject, "cut", "outside a box") < 17 * PIXELS + 20_000
    assert more(measured, "streamlines", "culling", "none") < 0
    assert more(measured, "volume", "mode", "surface") == pytest.approx(4 * PIXELS)  # normals
    assert more(measured, "volume", "rays", "tricubic") == 0
    assert more(measured, "lines-with-halos", "look", "thinner far away") == 0


@pytest.mark.few(3)
@pytest.mark.parametrize("wanted", PICTURE_EFFECTS, ids=lambda wanted: wanted.name)
def test_whole_pictures_are_changed(gl, wanted):
    """The plain scene's picture, by each effect; focus spreads light, and loses none."""
    made = brain_streamlines(60, seed=3)
    made.per_point = {"height": made.points[:, 2].copy()}
    subject = brain_subject(compress(made, per_point=("height",)))
    feature = next(item for item in subject.features if item.name == wanted.name)
    drawn = Drawn(gl, subject, feature, subject.path(2, (384, 256)))
    try:
        shown = drawn.passes.pixels()[..., :3].astype(int)
        plain = Drawn(gl, subject, replace(feature, passes=lambda ctx: WholePicture(ctx, PictureEffect("none"))),
                      subject.path(2, (384, 256)))  # fmt: skip
        before = plain.passes.pixels()[..., :3].astype(int)
        plain.release()
        assert (before != 255).any(axis=-1).sum() > 100
        assert (np.abs(shown - before).max(axis=-1) > 3).sum() > 50
        if wanted.focused and not wanted.tone.changes:
            assert np.abs(shown.mean(axis=(0, 1)) - before.mean(axis=(0, 1))).max() < 3.0  # light is spread, not lost
        drawn()
        assert not np.array_equal(drawn.passes.pixels()[..., :3], shown), "the camera has moved"
    finally:
        drawn.release()
        drawn.release()


def test_time_that_is_used_up_is_told(gl, small):
    left = []
    assert list(features.STUDY.run(little(budget=Budget(0.0), left_out=left))) == []
    assert [item.what for item in left] == [
        f"{name}: everything"
        for name in ("streamlines", "spline tubes", "lines with halos", "volume", "streamlines in a window, 96 x 64")
    ]
