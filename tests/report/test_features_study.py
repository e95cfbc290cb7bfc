"""The study of features on very little data."""

from __future__ import annotations

import math

import numpy as np
import pytest

from pvfiblets import regions
from pvfiblets.engine import standalone
from pvfiblets.engine.errors import EngineError
from pvfiblets.report import features
from pvfiblets.report.features_scenes import PLAIN, torus
from pvfiblets.report.study import Budget, Unavailable

from .little import little

SIZE = (96, 64)
PIXELS = SIZE[0] * SIZE[1]


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(features, "QUICK_SEGMENTS", 10_000)
    monkeypatch.setattr(features, "QUICK_TUBES", 6)
    monkeypatch.setattr(features, "QUICK_VOXELS", 12)
    monkeypatch.setattr(features, "QUICK_SIZE", SIZE)


@pytest.fixture(scope="module")
def measured(_headless, request):
    """What is found on very little data, by subject and feature."""
    with pytest.MonkeyPatch.context() as patch, _headless.context(request.module):
        for name, value in {"SEGMENTS": 10_000, "TUBES": 6, "VOXELS": 12, "SIZE": SIZE}.items():
            patch.setattr(features, f"QUICK_{name}", value)
        left = []
        records = list(features.STUDY.run(little(), left))
    assert not left
    return {(record.group, record.way, record.setting): record for record in records}


def more(found, *name):
    """Bytes that a feature adds."""
    return 1e6 * found[name].costs["more memory"].value


def test_every_subject_is_beside_its_plain_self(measured):
    plain = {key: record for key, record in measured.items() if record.default}
    assert {key[0] for key in plain} == {"streamlines", "spline-tubes", "lines-with-halos", "volume"}
    assert all(key[1] == PLAIN for key in plain)
    for record in plain.values():
        assert record.costs["more memory"].value == record.costs["more time"].value == 0.0
        assert record.costs["memory"].value > PIXELS * 24 / 1e6  # the G-buffer alone


def test_figures_are_finite(measured):
    for record in measured.values():
        assert all(math.isfinite(figure.value) for figure in record.costs.values())
        assert record.value("times/draw") > 0.0
        assert record.times["draw"].item == "frame"
        assert record.errors == {}


def test_bytes_are_those_that_a_feature_asks_for(measured):
    """By the formats of textures: what is said of a pixel, how often."""
    assert more(measured, "streamlines", "lines", "3 pixels wide") == 0
    assert more(measured, "streamlines", "lines", "3 pixels wide, shaded") == pytest.approx(2 * PIXELS)
    assert more(measured, "streamlines", "cut", "plane") == pytest.approx(272)  # eight planes and how many, std140
    # Two textures of a byte for each pixel.
    assert more(measured, "streamlines", "effects", "ambient occlusion") == pytest.approx(2 * PIXELS)
    assert more(measured, "streamlines", "culling", "none") < 0
    assert more(measured, "volume", "mode", "surface") == pytest.approx(4 * PIXELS)  # normals
    assert more(measured, "volume", "rays", "tricubic") == 0
    assert more(measured, "lines-with-halos", "look", "thinner far away") == 0


def test_time_that_is_used_up_is_told(gl, small):
    left = []
    assert list(features.STUDY.run(little(budget=Budget(0.0)), left)) == []
    assert [item.what for item in left] == [
        f"{name}: everything" for name in ("streamlines", "spline tubes", "lines with halos", "volume")
    ]


def test_without_opengl_it_is_unavailable(small, monkeypatch):
    def none():
        raise EngineError("no OpenGL 3.2 or later could be started")

    monkeypatch.setattr(standalone, "bare_context", none)
    with pytest.raises(Unavailable, match=r"no OpenGL 3\.2"):
        list(features.STUDY.run(little(), []))


def test_the_torus_is_one():
    """By its volume, 2 pi^2 R r^2, of which a mesh of so many triangles lacks little."""
    ring = torus(np.array([1.0, 2.0, 3.0]), 10.0, 96, 48)
    assert isinstance(ring, regions.Surface)
    points, triangles = ring.mesh.points, ring.mesh.triangles
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0
    assert volume == pytest.approx(2.0 * np.pi**2 * 10.0 * 4.0**2, rel=0.01)
    assert not ring.contains([(1.0, 2.0, 3.0)])[0]
    assert ring.contains([(11.0, 2.0, 3.0)])[0]
