"""What pictures of volumes should show, by cameras, lamps and depths, and how far one is off."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from pvfiblets.engine import View
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
from pvfiblets.report import volumes_pictures, volumes_scene
from pvfiblets.volumes import RaycastVolume, reference

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
        # By default light takes long steps in parts where they are wrong.
        style = VolumeStyle(casting=look.casting(step=step, integrator="preintegrated"))
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


def test_normals_are_turned_towards_the_eye():
    away = np.array([[0.0, 0.0, 2.0], [0.0, 3.0, -3.0], [np.nan] * 3])
    shine = volumes_scene.lit(away, np.array([[0.0, 0.0, 1.0]] * 3), np.array([0.0, 0.0, -1.0]))
    np.testing.assert_allclose(shine[:, 0], [1.0, math.sqrt(0.5), 0.0])


def test_directions_are_those_that_were_packed():
    from pvfiblets.codec.reference import pack_direction

    ways = np.concatenate([np.random.default_rng(0).normal(size=(256, 3)), np.eye(3), -np.eye(3)])
    found = volumes_pictures.directions_of(np.array([pack_direction(way) for way in ways], np.uint32))
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
