"""The study of ray-cast volumes: what it measures, what it leaves out, and where it cannot be done."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest

from pvfiblets.report import volumes, volumes_fields, volumes_integrators, volumes_occlusion, volumes_scene
from pvfiblets.report.study import Budget, Unavailable
from pvfiblets.volumes.raycast_options import INTEGRATORS, RaycastOptions

from .little import little


@pytest.fixture
def small(monkeypatch):
    """Have the study measure hardly anything."""
    monkeypatch.setattr(volumes_integrators, "SIDE", 16)
    monkeypatch.setattr(volumes_integrators, "LIGHT_SIZE", (40, 30))
    monkeypatch.setattr(volumes_integrators, "QUICK_DENSITIES", (0.1, 1e3))
    for module in (volumes, volumes_occlusion):
        monkeypatch.setattr(module, "QUICK_SIZE", 48)
    monkeypatch.setattr(volumes, "QUICK_VESSELS", 24)
    monkeypatch.setattr(volumes_occlusion, "QUICK_VOXELS", 32)
    monkeypatch.setattr(volumes_occlusion, "QUICK_PIXELS", 12)
    monkeypatch.setattr(volumes_occlusion, "QUICK_SAMPLES", (4, 256))


@pytest.mark.exhaustive
def test_all_parts_are_measured_and_what_converges_is_right(gl, small):
    left = []
    options = little()
    records = list(volumes.STUDY.run(options, left))
    assert not left
    assert options.driver.startswith(gl.info["GL_RENDERER"])
    bounded = [record for record in records if record.data != "bare formulae"]  # unstable ones leave all bounds
    assert all(math.isfinite(figure.value) for record in bounded for figure in record.errors.values())
    assert all(record.machine == "m" for record in records)
    assert all(timing.item == "frame" and timing.median > 0.0 for record in records for timing in record.times.values())

    light = {(record.data, record.method): record for record in records if "light rms" in record.errors}
    bare = {record.method: record.errors for record in records if record.data == "bare formulae"}
    assert bare["riemann"]["leaves 0 to 1"].value > 0.0 == bare["preintegrated"]["leaves 0 to 1"].value
    assert bare["preintegrated"]["max at κΔ 1000"].value < 0.1 < 1e3 < bare["riemann"]["max at κΔ 1000"].value
    assert {method for _, method in light} == set(INTEGRATORS)
    for data in dict.fromkeys(data for data, _ in light):
        assert light[data, "adaptive"].default
        assert light[data, "adaptive"].errors["light max"].value < 0.01  # 8 bits of colours make up 0.003
    assert light["peaks, κΔ 1000", "riemann"].errors["light max"].value > 0.5  # an entry that a step passes over
    stiff = {(record.data, record.method): record.errors for record in records if record.group == "stiff"}
    assert stiff["peaks", "riemann"]["max at κΔ 1000"] == light["peaks, κΔ 1000", "riemann"].errors["light max"]

    shown = {
        (record.data, record.method, record.setting): record.errors for record in records if record.group == "pictures"
    }
    of_step = {
        mode: [shown[f"24³ vessels, {mode}", "step", f"{step} voxels"]["colour rms"].value for step in (0.25, 1)]
        for mode in ("composite", "mip")
    }
    assert of_step["mip"][0] < 0.5 * of_step["mip"][1]
    # Light takes long steps in parts where they are wrong: all that is left is what 8 bits of colours make up.
    assert of_step["composite"][0] < of_step["composite"][1] < 1e-3
    plain = shown["24³ vessels, composite", "default", ""]["colour rms"].value
    unlike = {key[1]: errors["unlike the default"].value for key, errors in shown.items() if "isosurface" in key[0]}
    assert unlike["default"] == unlike["no octree"] == 0.0 < unlike["step"]
    assert shown["24³ vessels, composite", "no octree", ""]["colour rms"].value == pytest.approx(plain, rel=1e-6)
    surface = "24³ vessels, isosurface"
    place = {method: shown[surface, method, ""]["place"].value for method in ("default", "no refinement")}
    assert place["default"] < place["no refinement"]

    openness = {(record.data, record.method, record.setting): record.errors["openness rms"].value
                for record in records if record.group == "occlusion"}  # fmt: skip
    for name in ("vessels", "head"):
        few, many = (openness[f"32³ {name}, occlusion", "rays", f"{n} rays"] for n in (4, 256))
        chance = [openness[f"32³ {name}, occlusion", "independent rays, by chance", f"{n} rays"] for n in (4, 256)]
        assert chance[0] == pytest.approx(8.0 * chance[1])
        assert many < 0.7 * few
        assert many < 0.1


def test_what_there_was_no_time_for_is_told(gl, small):
    left = []
    assert not list(volumes.STUDY.run(little(budget=Budget(0.0)), left))
    assert {item.reason for item in left} == {"the time given was used up"}
    told = " ".join(item.what for item in left)
    assert all(name in told for name in ("ramp, κΔ 0.1", "24³ vessels, mip", "32³ head, occlusion"))


def test_without_opengl_it_is_unavailable(monkeypatch):
    monkeypatch.setitem(sys.modules, "moderngl", None)
    with pytest.raises(Unavailable, match="moderngl"):
        next(volumes.STUDY.run(little(), []))


@pytest.mark.parametrize("quick", [False, True])
@pytest.mark.parametrize("mode", ["composite", "mip", "isosurface"])
def test_settings_can_be_cast_and_are_told_apart(mode, quick):
    look = volumes_scene.look_of(volumes_fields.field("ball", 8), mode)
    found = list(volumes.settings(mode, quick, 1.0))
    casts = [look.casting(**fields) for _, _, fields in found]
    assert casts[0] == look.casting()
    assert len({(method, how) for method, how, _ in found}) == len(found)
    # The refinement's own default is among what it is compared with under another name.
    assert all(cast != casts[0] for cast in casts[1:])
    assert {method for method, _, _ in volumes.settings(mode, True, 1.0)} <= {method for method, _, _ in found}


def test_fields_and_tables_are_what_they_are_called():
    ball, slope = (volumes_fields.field(name, 17).values for name in ("ball", "slope"))
    assert ball[8, 8, 8] == ball.max() == 1.0
    assert ball[0, 0, 0] == 0.0
    assert np.allclose(np.diff(slope, axis=0), 0.6 / 16.0, atol=1e-6)
    alpha = {name: table[:, 3] for name, table in volumes_fields.tables().items()}
    assert (np.diff(alpha["ramp"]) > 0.0).all()
    assert (np.diff(alpha["edge"]) != 0.0).sum() == 1
    assert (alpha["peak"] > 0.0).sum() == 1
    assert (alpha["peaks"] > 0.0).sum() == 16
    assert all(values.max() == volumes_fields.DENSE for values in alpha.values())
    assert RaycastOptions.integrator == "adaptive"
