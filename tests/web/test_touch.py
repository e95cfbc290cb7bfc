"""Two fingers and the camera, without a browser: what lies under them stays under them."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.web.touch import Fingers

CENTRE = np.array([100.0, 80.0])  # of the plotter's 200 by 160 pixels


def send(fingers, kind, *places):
    positions = {str(k): {"x": float(x), "y": float(y), "z": 0} for k, (x, y) in enumerate(places)}
    return fingers.take({"type": kind, "positions": positions})


def gesture(fingers, kind, begin, end):
    """Send a gesture of two fingers in four steps."""
    begin, end = np.array(begin, float), np.array(end, float)
    assert send(fingers, f"Start{kind}", *begin)
    for share in (0.25, 0.5, 0.75, 1.0):
        assert send(fingers, kind, *((1 - share) * begin + share * end))
    assert send(fingers, f"End{kind}", *end)


def seen(plotter, point):
    """Return the pixel that shows a point."""
    renderer = plotter.renderer
    renderer.SetWorldPoint(*point, 1.0)
    renderer.WorldToDisplay()
    return np.array(renderer.GetDisplayPoint()[:2])


@pytest.fixture(params=[False, True], ids=["perspective", "parallel"])
def looking(request, plotter):
    plotter.add_mesh(pv.Sphere())
    plotter.camera.parallel_projection = request.param
    plotter.show(auto_close=False, interactive=False)
    return plotter, Fingers(plotter)


def test_fingers_that_part_magnify_as_far_as_they_part(looking):
    plotter, fingers = looking
    camera = plotter.camera
    focus = np.array(camera.focal_point)
    right = np.cross(np.subtract(focus, camera.position), camera.up)
    point = focus + 0.1 * right / np.linalg.norm(right)
    before = seen(plotter, point) - seen(plotter, focus)
    gesture(fingers, "Pinch", [CENTRE - (20, 0), CENTRE + (20, 0)], [CENTRE - (50, 0), CENTRE + (50, 0)])
    assert np.allclose(seen(plotter, point) - seen(plotter, focus), 2.5 * before, atol=1e-3)
    assert np.allclose(seen(plotter, focus), CENTRE, atol=0.6)


def test_what_lies_between_the_fingers_goes_with_them(looking):
    plotter, fingers = looking
    focus = plotter.camera.focal_point
    before = seen(plotter, focus)
    gesture(fingers, "Pan", [(60, 60), (80, 60)], [(90, 40), (110, 40)])
    assert np.allclose(seen(plotter, focus) - before, (30, -20), atol=1e-3)


def test_a_turn_of_the_fingers_turns_the_picture(looking):
    plotter, fingers = looking
    above = np.add(plotter.camera.focal_point, 0.1 * np.array(plotter.camera.up))
    turned = np.array([[0.0, -40.0], [0.0, 40.0]])
    straight = np.array([[-40.0, 0.0], [40.0, 0.0]])
    begin = seen(plotter, above) - CENTRE
    steps = [straight * np.cos(a) + turned * np.sin(a) for a in np.linspace(0.0, np.pi / 2, 9)]
    send(fingers, "StartRotate", *(CENTRE + steps[0]))
    for step in steps[1:]:
        send(fingers, "Rotate", *(CENTRE + step))
    send(fingers, "EndRotate", *(CENTRE + steps[-1]))
    end = seen(plotter, above) - CENTRE
    assert np.allclose(end, [-begin[1], begin[0]], atol=0.7)  # a quarter turn to the left, as the fingers made


def test_a_gesture_begins_where_the_fingers_come_down(looking):
    plotter, fingers = looking
    gesture(fingers, "Pan", [(60, 60), (80, 60)], [(60, 60), (80, 60)])
    before = seen(plotter, plotter.camera.focal_point)
    gesture(fingers, "Pinch", [(10, 10), (150, 150)], [(10, 10), (150, 150)])
    assert np.allclose(seen(plotter, plotter.camera.focal_point), before, atol=1e-3)


def test_other_events_and_odd_fingers_move_nothing(looking):
    plotter, fingers = looking
    before = plotter.camera.position
    assert not fingers.take({"type": "MouseMove", "x": 3, "y": 4})
    assert send(fingers, "StartPinch", (10, 10))
    assert send(fingers, "Pinch", (90, 90))
    assert fingers.take({"type": "Pinch"})
    assert send(fingers, "StartPinch", (50, 50), (50, 50))
    assert send(fingers, "Pinch", (50, 50), (51, 50))
    assert np.allclose(plotter.camera.position, before, atol=0.02)
    assert np.isfinite(plotter.camera.position).all()
