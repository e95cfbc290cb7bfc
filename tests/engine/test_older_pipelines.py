"""Pipelines on an OpenGL that has nothing newer than they say they need: pictures of compute, in other processes."""

import pickle

import pytest

from pvfiblets.engine import FibletRenderer, FibletStyle, View

from .elsewhere import run_elsewhere
from .likeness import assert_like
from .pictures import SIZE, read

BOX = [(1.0, 0, 0, 25), (-1.0, 0, 0, 25), (0, 1.0, 0, 25), (0, -1.0, 0, 25), (0, 0, 1.0, 25), (0, 0, -1.0, 25)]


def scenes():
    """Views and styles, by plain numbers, that a process of its own can draw again."""
    near = {"eye": (0, -60, 10), "near": 25.0, "far": 90.0}
    return [
        ({}, (), FibletStyle()), ({}, (), FibletStyle(5.0)), ({"height": 150.0}, (), FibletStyle(values="arc_length")),
        ({}, BOX, FibletStyle(values="arc_length")), (near, BOX, FibletStyle(5.0, values="arc_length")),
        (near, (), FibletStyle(tolerance=0.0)),
    ]  # fmt: skip


def pictures_of(ctx, fiblets, camera, pipeline):
    """Every scene drawn twice by one renderer, from two places."""
    found = []
    renderer = FibletRenderer(ctx, fiblets, pipeline=pipeline)
    for more, planes, style in scenes():
        for x in (5, 0):
            view = View(SIZE, camera(SIZE, **{"eye": (x, -260, 60), **more}), planes)
            found.append(read(renderer.render(view, style)))
    renderer.release()
    return found


DRAW = """
from tests.engine import test_older_pipelines
fiblets = conftest._module.fabricate(unwrapped(conftest.random_lines)()(60, seed=3), kind=2, low=True)
pictures = test_older_pipelines.pictures_of(ctx, fiblets, camera, arguments[0])
Path(arguments[1]).write_bytes(pickle.dumps([tuple(p) for p in pictures]))
"""


@pytest.mark.more
@pytest.mark.parametrize(
    ("version", "pipeline"),
    [
        ("4.1", "tessellation"), pytest.param("4.1", "geometry", marks=pytest.mark.exhaustive), ("4.1", "auto"),
        ("3.3", "geometry"),
    ],
)  # fmt: skip
def test_older_opengl_draws_the_same(gl, fabricate, random_lines, camera, older_opengl, tmp_path, version, pipeline):
    """In a process whose OpenGL has nothing newer: storage buffers, images and compute do not even compile there."""
    file = tmp_path / "pictures"
    run_elsewhere(older_opengl, version, DRAW, pipeline, file)
    fiblets = fabricate(random_lines(60, seed=3), kind=2, low=True)
    expected = pictures_of(gl, fiblets, camera, "compute")
    found = [type(expected[0])(*arrays) for arrays in pickle.loads(file.read_bytes())]
    assert len(found) == len(expected)
    for picture, reference in zip(found, expected, strict=True):
        assert_like(picture, reference)
