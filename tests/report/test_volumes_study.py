"""The study of ray-cast volumes: what it measures, what it leaves out, and where it cannot be done."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from pvfiblets.engine import View
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
from pvfiblets.engine.volumes.ray_occlusion import LIFT
from pvfiblets.report.studies.culling.pictures import directions
from pvfiblets.report.studies.volumes import (
    fields as volumes_fields,
)
from pvfiblets.report.studies.volumes import (
    integrators as volumes_integrators,
)
from pvfiblets.report.studies.volumes import (
    occlusion as volumes_occlusion,
)
from pvfiblets.report.studies.volumes import (
    pictures as volumes_pictures,
)
from pvfiblets.report.studies.volumes import reference
from pvfiblets.report.studies.volumes import (
    scene as volumes_scene,
)
from pvfiblets.report.studies.volumes import (
    study as volumes,
)
from pvfiblets.report.studies.volumes import windows as volumes_windows
from pvfiblets.report.studies.volumes.openness import exact_openness, seen_from
from pvfiblets.report.study import Budget
from pvfiblets.volumes import RaycastVolume
from pvfiblets.volumes.raycast_options import INTEGRATORS

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
    monkeypatch.setattr(volumes_windows, "QUICK_SIZE", 48)
    monkeypatch.setattr(volumes_windows, "QUICK_SIDES", (24,))


@pytest.mark.exhaustive
def test_all_parts_are_measured_and_what_converges_is_right(gl, small):
    left = []
    options = little(left_out=left)
    records = list(volumes.STUDY.run(options))
    assert not left
    assert options.driver.startswith(gl.info["GL_RENDERER"])
    assert all(math.isfinite(figure.value) for record in records for figure in record.errors.values())
    assert all(timing.item == "frame" and timing.median > 0.0 for record in records for timing in record.times.values())
    light = {(record.data, record.method): record for record in records if "light rms" in record.errors}
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
    assert unlike["default"] == unlike["no octree"] == 0.0 < unlike["no refinement"]
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
    in_windows = [record for record in records if record.group == "windows"]
    assert len(in_windows) == 3 * 2 * len(volumes_windows.QUICK_STEPS)
    assert sum(record.default for record in in_windows) == 3


def test_what_there_was_no_time_for_is_told(gl, small):
    left = []
    assert not list(volumes.STUDY.run(little(budget=Budget(0.0), left_out=left)))
    assert {item.reason for item in left} == {"the time given was used up"}
    told = " ".join(item.what for item in left)
    assert all(name in told for name in ("ramp, κΔ 0.1", "24³ vessels, mip", "32³ head, occlusion"))


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


SIZE = (48, 48)
MODES = ("composite", "mip", "isosurface")


def ball(n=24):
    """Return a volume whose values fall linearly from 1 at (0, 0, 0), 0 at 1 mm."""
    x = np.linspace(-1.2, 1.2, n)
    affine = np.diag([2.4 / (n - 1)] * 3 + [1.0])
    affine[:3, 3] = -1.2
    away = np.sqrt(x[:, None, None] ** 2 + x[:, None] ** 2 + x**2)
    return RaycastVolume(np.maximum(1.0 - away, 0.0).astype(np.float32), affine)


@pytest.mark.few(1)
@pytest.mark.parametrize("mode", MODES)
def test_the_engine_comes_near_what_is_right(gl, mode):
    volume = ball()
    look, cameras = volumes_scene.look_of(volume, mode), volumes_scene.circle(volume, 2, SIZE)
    of = volumes_scene.truth(volume, look, cameras, 400)
    renderer = VolumeRenderer(gl, volume)

    def error(step):
        # By default light takes long steps in parts where they are wrong, and surfaces take none.
        style = VolumeStyle(casting=look.casting(step=step, integrator="preintegrated", refine="regula-falsi"))
        views = [View(camera.size, camera.model_view_projection) for camera in cameras]
        shown = [
            volumes_pictures.colours_of(renderer.render(view, style), look, camera)
            for view, camera in zip(views, cameras, strict=True)
        ]
        return of.error(shown)

    assert error(0.02) < 3e-3
    assert error(8.0) > 1.5 * error(0.02)
    renderer.release()


def test_a_ball_is_a_disc_as_bright_as_it_faces_the_lamp():
    volume = ball(48)
    look, camera = volumes_scene.look_of(volume, "isosurface"), volumes_scene.circle(volume, 1, SIZE)[0]
    through = reference.rays(camera.model_view_projection, SIZE, volume)
    axis, eye = volumes_scene.ground_truth(volume, look, through, camera)[..., 0]
    radius, distance = 1.0 - look.value, np.linalg.norm(camera.eye)
    # From the eye: cos of the angle at the sphere, by the sine rule.
    sine = np.linalg.norm(np.cross(through.directions, camera.backwards), axis=-1) * distance / radius
    wanted = np.sqrt(np.clip(1.0 - sine**2, 0.0, None))
    inside = sine < 0.9
    np.testing.assert_allclose(eye[inside], wanted[inside], atol=0.02)
    assert not eye[sine > 1.05].any()
    assert axis[inside].max() == pytest.approx(1.0, abs=0.02)
    assert (axis <= 1.0).all()


def test_normals_are_turned_towards_the_eye_and_directions_unpacked():
    away = np.array([[0.0, 0.0, 2.0], [0.0, 3.0, -3.0], [np.nan] * 3])
    shine = volumes_scene.lit(away, np.array([[0.0, 0.0, 1.0]] * 3), np.array([0.0, 0.0, -1.0]))
    np.testing.assert_allclose(shine[:, 0], [1.0, math.sqrt(0.5), 0.0])
    from tests.codec.reference import pack_direction

    ways = np.concatenate([np.random.default_rng(0).normal(size=(256, 3)), np.eye(3), -np.eye(3)])
    found = directions(np.array([pack_direction(way) for way in ways], np.uint32))
    np.testing.assert_allclose(found, ways / np.linalg.norm(ways, axis=1, keepdims=True), atol=1e-4)


def test_depths_say_how_far_along_a_ray():
    volume = ball()
    camera = volumes_scene.circle(volume, 1, SIZE)[0]
    through = reference.rays(camera.model_view_projection, SIZE, volume)
    middle = 0.3 * through.near + 0.7 * through.far
    there = ~np.isnan(middle)
    keys = np.full(there.shape, 0xFFFFFFFF, np.uint32)
    keys[there] = 0xFFFFFFFF - np.round((1.0 - through.depth(middle)[there]) * 2.0**32).astype(np.uint32)
    found = volumes_pictures.along_of(keys, through)
    np.testing.assert_array_equal(np.isnan(found), ~there)
    np.testing.assert_allclose(found[there], middle[there], atol=1e-7)


def test_what_is_missed_counts_as_a_voxel():
    volume = ball()
    camera = volumes_scene.circle(volume, 1, SIZE)[0]
    through = reference.rays(camera.model_view_projection, SIZE, volume)
    rows, columns = np.nonzero(~np.isnan(through.near))
    pixels = np.stack([rows, columns], axis=1)[:4]
    rays = through[pixels[:, 0], pixels[:, 1]]
    spacing = float(volume.spacing.mean())
    wanted = rays.near + np.array([0.0, 0.0, 0.0, np.nan])
    shown = wanted + np.array([0.25, 5.0, np.nan, 0.0]) * spacing
    depths = np.full(SIZE[::-1], 0xFFFFFFFF, np.uint32)
    there = ~np.isnan(shown)
    keys = 0xFFFFFFFF - np.round((1.0 - rays.depth(shown)) * 2.0**32)
    depths[pixels[there, 0], pixels[there, 1]] = keys[there].astype(np.uint32)
    truth = SimpleNamespace(pixels=[pixels])
    told = volumes_pictures.places(volumes_pictures.GroundTruth(truth, [rays], [wanted]), [depths], spacing)
    assert told["position"] == pytest.approx((0.25 + 1.0 + 1.0) / 3.0, abs=1e-6)
    assert told["median"] == pytest.approx(0.25, abs=1e-6)
    assert (told["missed"], told["false"]) == (pytest.approx(2.0 / 3.0), 0.0)


def test_cameras_see_what_is_in_the_box_from_all_around():
    volume = ball()
    inside = np.random.default_rng(0).normal(size=(500, 3))
    inside *= 1.1 / np.linalg.norm(inside, axis=1, keepdims=True)
    extents, turns = [], []
    for camera in volumes_scene.circle(volume, 12, (60, 40)):
        clip = np.column_stack([inside, np.ones(500)]) @ camera.model_view_projection.T
        place = np.abs(clip[:, :3] / clip[:, 3:])
        assert (clip[:, 3] > 0.0).all()
        assert place.max() < 1.0
        extents.append(place[:, 1].max())
        turns.append(math.degrees(math.atan2(camera.eye[1], camera.eye[0])) % 360.0)
    assert min(extents) > 0.75
    # However few there are, they lie all around.
    for count in (3, 5, 12):
        gaps = np.diff(np.sort([*turns[:count], min(turns[:count]) + 360.0]))
        assert gaps.max() < 2.7 * 360.0 / count


def test_the_reference_is_that_of_a_ball():
    """Chords in a ball of radius r, from a little off its wall, that are shorter than R."""
    x = np.arange(33) - 16.0
    field = np.sqrt(x[:, None, None] ** 2 + x[:, None] ** 2 + x**2).astype(np.float32)
    affine = np.eye(4)
    affine[:3, 3] = -16.0
    volume = RaycastVolume(field, affine)
    matrix = seen_from(volume, (8, 8), (0.3, -1.0, 0.2))
    ways = np.random.default_rng(0).normal(size=(6, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    through = reference.Rays(np.zeros((6, 3)), ways, np.zeros(6), np.full(6, 16.0), matrix)
    hits = reference.isosurface(volume, 12.0, through)
    found = exact_openness(volume, 12.0, through, hits.gradient, hits.t, 9.0)
    start = 12.0 - LIFT
    least = (9.0**2 - 12.0**2 + start**2) / (2 * 9.0 * start)
    assert found == pytest.approx(1.0 - least**2, abs=0.01)


# ------------------------------------------------------------------------------------------------------------- windows


def cone(n=24):
    """Return a volume whose values fall linearly from 1 at (0, 0, 0), 0 at 1 mm."""
    x = np.linspace(-1.2, 1.2, n)
    affine = np.diag([2.4 / (n - 1)] * 3 + [1.0])
    affine[:3, 3] = -1.2
    away = np.sqrt(x[:, None, None] ** 2 + x[:, None] ** 2 + x**2)
    return RaycastVolume(np.maximum(1.0 - away, 0.0).astype(np.float32), affine)


@pytest.mark.few(1)
@pytest.mark.parametrize("mode", volumes_windows.MODES)
def test_a_window_shows_the_engines_picture_and_vtk_comes_near_what_is_right(gl, mode):
    volume, size = cone(), (48, 48)
    look, cameras = volumes_scene.look_of(volume, mode), volumes_scene.circle(volume, 1, size)
    renderer = VolumeRenderer(gl, volume)
    view = View(size, cameras[0].model_view_projection)
    buffer = renderer.render(view, VolumeStyle(casting=look.casting()))
    engine = volumes_pictures.colours_of(buffer, look, cameras[0])
    renderer.release()
    ours, vtk = (kind(volume, look, size) for kind in volumes_windows.WINDOWS)
    ours.draw(cameras[0])
    assert engine.max() > 0.2
    # Bytes, twice rounded; peaks have half a step to fall between samples.
    assert np.quantile(np.abs(engine - ours.colours()), 0.99) < 3.0 / 255.0
    assert ours.costs["memory"].value > 1e-6 * volume.nbytes
    right = volumes_scene.truth(volume, look, cameras, 400)
    errors = []
    for step in (6.0, 0.03):
        vtk.step(step)
        vtk.draw(cameras[0])
        errors.append(right.error([vtk.colours()], vtk.lamp))
    assert errors[1] < 0.5 * errors[0]
    # Where a surface begins pixels are white or black: one that VTK misses is worth many that are nearly right.
    assert errors[1] < (0.05 if mode == "isosurface" else 3e-3)
    for window in (ours, vtk):
        window.release()
