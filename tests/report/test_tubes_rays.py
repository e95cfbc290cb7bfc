"""Rays at tubes, cameras and what float64 says of them: what the study of tubes measures by."""

import numpy as np
import pytest

from pvfiblets.report.cameras import orbit
from pvfiblets.report.studies.tubes.pictures import helices
from pvfiblets.report.studies.tubes.rays import Rays, of_class, of_set
from pvfiblets.report.studies.tubes.sweeps import lengthwise


@pytest.fixture
def tubes():
    return helices(4, 9)


def test_the_error_of_a_ray_by_a_sphere():
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


def test_rays_are_aimed_at_their_halves_at_angles_asked_for(tubes):
    for rays in (of_class("bent", 500), of_set(tubes, 500, (320, 180))):
        assert len(rays.controls) == 500
        np.testing.assert_allclose(np.linalg.norm(rays.directions, axis=1), 1.0)
        share = (rays.truth.kind > 0).mean()
        assert 0.7 < share < 1.0  # within 1.15 radii: a quarter of a disc is beyond 1, but another sphere may be there
        np.testing.assert_array_equal(rays.truth.kind > 0, rays.clearance < 0.0)
    rng = np.random.default_rng(0)
    for degrees in (90.0, 10.0, 0.1, 0.0):
        rays = lengthwise(degrees, 50, rng)
        axis = rays.controls[:, 2, :3] - rays.controls[:, 0, :3]
        across = np.linalg.norm(np.cross(axis, rays.directions), axis=1)
        along = np.einsum("ni,ni->n", axis, rays.directions)
        np.testing.assert_allclose(np.degrees(np.arctan2(across, along)), degrees, atol=1e-9)


def test_rays_of_pixels_are_projected_to_them(tubes):
    camera = orbit(tubes, "close", 4, (160, 90))[1]
    pixels = np.array([0, 159, 7250, 160 * 90 - 1])
    directions, forwards = camera.rays(pixels)
    w = np.array([camera.near, 0.5 * (camera.near + camera.far), camera.far, camera.near])
    points = camera.eye + (w / forwards)[:, None] * directions
    clip = np.column_stack([points, np.ones(4)]) @ camera.model_view_projection.T
    ndc = clip[:, :3] / clip[:, 3:]
    np.testing.assert_allclose((ndc[:, 0] + 1.0) * 80.0, pixels % 160 + 0.5, atol=1e-7)
    np.testing.assert_allclose((ndc[:, 1] + 1.0) * 45.0, pixels // 160 + 0.5, atol=1e-7)
    np.testing.assert_allclose(0.5 * (ndc[:, 2] + 1.0), camera.depth(w), atol=1e-12)
    np.testing.assert_allclose(camera.distance(1.0 - camera.depth(w)), w, rtol=1e-9)
