"""`View` and `FibletStyle`: what they refuse, and when two are the same."""

import dataclasses

import numpy as np
import pytest

from pvfiblets.engine import FibletStyle, View
from pvfiblets.engine.frame import FRAME_BLOCK, frame_block, reference_anchor


def test_views_compare_by_content():
    a, b = View((4, 3), np.eye(4)), View((4, 3), np.eye(4).tolist())
    assert a == b
    assert hash(a) == hash(b)
    assert a != View((4, 4), np.eye(4))
    assert a != View((4, 3), 2 * np.eye(4))
    with pytest.raises(dataclasses.FrozenInstanceError):
        a.size = (1, 1)
    with pytest.raises(ValueError, match="read-only"):
        a.model_view_projection[0, 0] = 2.0


@pytest.mark.parametrize("size", [(0, 5), (5, -1)])
def test_a_picture_has_pixels(size):
    with pytest.raises(ValueError, match="at least one pixel"):
        View(size, np.eye(4))


@pytest.mark.parametrize("matrix", [np.eye(3), np.full((4, 4), np.nan)])
def test_a_matrix_is_finite_and_square(matrix):
    with pytest.raises(ValueError, match="finite"):
        View((5, 5), matrix)


@pytest.mark.parametrize("width", [0.0, -1.0, np.nan, np.inf])
def test_line_widths(width):
    with pytest.raises(ValueError, match="line_width"):
        FibletStyle(width)


@pytest.mark.parametrize("tolerance", [-0.1, np.nan, np.inf])
def test_tolerances(tolerance):
    with pytest.raises(ValueError, match="tolerance"):
        FibletStyle(tolerance=tolerance)


def test_the_reference_is_what_the_camera_looks_at(camera):
    origin, scale, top = np.array([-100.0, -100.0, -100.0]), np.full(3, 200 / 65535), 65535
    inside = camera((100, 100), eye=(10, 20, 30), target=(50, 60, 70), near=0.01, far=1000.0)
    found = origin + scale * reference_anchor(inside, origin, scale, top)
    assert np.linalg.norm(found - [10, 20, 30]) < 0.1
    outside = camera((100, 100), eye=(0, -500, 0))
    found = origin + scale * reference_anchor(outside, origin, scale, top)
    assert np.allclose(found, [0, -100, 0], atol=0.01)
    flat = np.zeros((4, 4))
    assert (reference_anchor(flat, origin, scale, top) == top // 2).all()


def test_planes_are_signed_distances(camera):
    """Against distances to the frustum's planes built from the camera's own geometry."""
    size = (200, 100)
    matrix = camera(size, eye=(0, 0, 0), target=(0, 1, 0), near=1.0, far=100.0, angle=60.0)
    origin, scale = np.array([-50.0, -50.0, -50.0]), np.full(3, 100 / 65535)
    packed, _ = frame_block(View(size, matrix), FibletStyle(), origin, scale, 65535)
    block = np.frombuffer(packed, FRAME_BLOCK.dtype)[0]
    planes, reference = block["view_planes"], block["reference"]
    point = np.array([3.0, 40.0, -7.0])
    local = point - origin - scale * reference
    found = planes[:, :3] @ local + planes[:, 3]
    half = np.arctan(np.tan(np.radians(30)) * 2)
    expected = [
        (40 * np.tan(half) + 3) * np.cos(half), (40 * np.tan(half) - 3) * np.cos(half),
        (40 * np.tan(np.radians(30)) - 7) * np.cos(np.radians(30)),
        (40 * np.tan(np.radians(30)) + 7) * np.cos(np.radians(30)), 39.0, 60.0,
    ]  # fmt: skip
    assert np.allclose(found, expected, atol=1e-3)
    assert (found >= np.array(expected) - 1e-5).all(), "planes may only stand further out"


def test_what_is_thinner_than_a_pixel_is_widened_unless_pixels_are_to_be_exact():
    assert FibletStyle(line_width=0.5).half_width == FibletStyle(line_width=1.0).half_width == 0.0
    assert FibletStyle(line_width=0.5, exact=True).half_width == 0.25
    assert FibletStyle(line_width=1.0, exact=True).half_width == 0.5
    assert FibletStyle(line_width=3.0, exact=True).half_width == FibletStyle(line_width=3.0).half_width == 1.5
    assert FibletStyle(radius=0.1).half_width == 0.5
    assert 0.0 < FibletStyle(radius=0.1, exact=True).half_width < 1e-3
