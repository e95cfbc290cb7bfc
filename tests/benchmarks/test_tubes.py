"""The benchmark of spline tubes runs from one command, and what it measures by is right."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from pvfiblets.report.cameras import ELEVATION, orbit
from pvfiblets.report.studies.codec.baselines import tessellated

from .scripts import imported, run

SIZE = (160, 90)


@pytest.fixture
def bench():
    """Return the benchmark's modules."""
    with imported(reference="tubes_reference", methods="tubes_methods", command="tubes") as modules:
        yield modules


@pytest.fixture
def ball(bench):
    """Return a sphere of 2 mm at (10, 0, 0) and a camera that has it in the middle."""
    from pvfiblets import SplineTubes

    tubes = SplineTubes(points=[[10, 0, 0]], segments=[[0, 0]], radius=[2.0], tangents=[[0, 0, 0]],
                        radius_slopes=[0.0], scaled=True, tubes=[0], n_tubes=1)  # fmt: skip
    near = orbit(tubes, "far", 4, SIZE)[1]
    return tubes, dataclasses.replace(near, eye=1.5 * near.eye - 0.5 * near.centre, far=2.0 * near.far)


@pytest.mark.more
def test_one_command_measures_and_says_what_it_left_out(tmp_path):
    command = ["--sets", "helices-3", "--size", *SIZE, "--frames", "3", "--views", "far"]
    command += ["--methods", "tube-6", "tube-90x40", "tessellated", "--limit", "60", "0.71"]
    path, found = run(tmp_path, "tubes", *command)
    rows = {row["method"]: row for row in found["results"]}
    assert rows["tube-6"]["primitives"] == 3 * (24 * 6 * 2 + 2 * 4)  # walls of quads, two flat caps of six corners
    assert 0.0 < rows["tube-6"]["ms"]
    assert 0.0 < rows["tessellated"]["empty_ms"]
    assert rows["tessellated"]["off_pixels"] < rows["tube-6"]["off_pixels"]
    assert "0.71 allowed" in rows["tube-90x40"]["unmeasured"]
    assert rows["tube-90x40"]["unmeasured"] in path.with_suffix(".md").read_text()


def test_the_reference_covers_what_a_sphere_does(bench, ball):
    tubes, camera = ball
    reference = bench.reference.fine_coverage(tubes, camera, 4)
    same_size, shares = reference.same_size, reference.shares
    # A sphere covers the directions within asin(r / distance) of its own: a circle, as it is in the middle.
    radius = camera.pixels * np.tan(np.arcsin(2.0 / np.linalg.norm(camera.eye - tubes.points[0])))
    y, x = np.indices(same_size.shape) + 0.5
    away = np.hypot(x - SIZE[0] / 2, y - SIZE[1] / 2)
    np.testing.assert_array_equal(same_size[abs(away - radius) > 0.02], (away < radius)[abs(away - radius) > 0.02])
    assert shares.sum() == pytest.approx(np.pi * radius**2, rel=1e-3)
    assert reference.length == pytest.approx(2.0 * np.pi * radius, rel=0.02)


def test_distances_and_lengths_of_outlines(bench):
    y, x = np.indices((400, 400)) + 0.5
    away = np.hypot(x - 200.0, y - 200.0)
    fine = (np.indices((1600, 1600)) + 0.5) / 4.0
    reference = bench.reference.supersampled(away < 150.0, np.hypot(*(fine - 200.0)) < 150.0)
    assert reference.length == pytest.approx(2.0 * np.pi * 150.0, rel=0.01)
    exact, wider = reference.compare(away < 150.0), reference.compare(away < 152.0)
    assert exact["differing"] == exact["gross"] == 0
    assert wider["off_pixels"] == pytest.approx(2.0, rel=0.02)
    assert 0.0 < wider["gross"] < wider["off_pixels"]
    y, x = np.indices((1000, 1000))
    for degrees in (0.0, 20.0, 45.0, 70.0):
        turn = np.radians(degrees)
        u = (x - 500.0) * np.cos(turn) + (y - 500.0) * np.sin(turn)
        v = (y - 500.0) * np.cos(turn) - (x - 500.0) * np.sin(turn)
        square = np.maximum(abs(u), abs(v)) < 300.2
        # The formula is exact as a mean of all directions.
        assert bench.reference.outline(square) == pytest.approx(4 * 600.4, rel=0.06)


def test_a_tessellated_tube_is_as_wide_as_it_should_be(bench):
    from pvfiblets import SplineTubes

    tubes = SplineTubes(points=[[0, 0, -5], [0, 0, 5]], segments=[[0, 1]], radius=[1, 1], tangents=[[0, 0, 1]] * 2,
                        radius_slopes=[0, 0], scaled=True, tubes=[0], n_tubes=1)  # fmt: skip
    camera = orbit(tubes, "far", 4, (1600, 900))[0]
    options = SimpleNamespace(size=(1600, 900))
    drawn = bench.methods._Tessellated("tessellated", tubes, options)
    drawn.draw(camera)
    shown = drawn.covered()
    sides = tessellated.MOST_SIDES
    assert drawn.facts([camera])["primitives"] == 4 * sides - 2  # straight: one step along, of which OpenGL makes two
    drawn.close()
    distance = np.hypot(*(camera.eye - camera.centre)[:2])  # the tube stands upright, the camera looks down on it
    tilt = np.cos(np.radians(ELEVATION))
    expected = 2.0 * np.tan(np.arcsin(1.0 / distance)) * camera.pixels * tilt
    assert shown[450].sum() == pytest.approx(expected, abs=2.0)
