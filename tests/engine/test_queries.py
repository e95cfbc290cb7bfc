"""Queries of time and of samples: what they measure, beyond 32 bits, and that OpenGL has their names back."""

import ctypes

import moderngl
import numpy as np
import pytest

from pvfiblets.engine import FibletRenderer, View
from pvfiblets.engine.gl import passes
from pvfiblets.engine.gl.gl_functions import FUNCTIONS, RETURNS
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.queries import Query, Timers
from pvfiblets.engine.tubes import TubeRenderer
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
from pvfiblets.engine.volumes.ray_occlusion import RayOcclusionPass
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.volume import RaycastVolume

from .pictures import SIZE
from .tubes import bundle


@pytest.fixture
def functions(gl, monkeypatch):
    monkeypatch.setitem(FUNCTIONS, "glIsQuery", ((ctypes.c_uint,), 330))
    monkeypatch.setitem(RETURNS, "glIsQuery", ctypes.c_ubyte)
    return GLExtras(gl)


@pytest.fixture
def made(monkeypatch):
    """List OpenGL's names of the queries that are made."""
    names, make = [], Query.__init__

    def listed(self, *arguments):
        make(self, *arguments)
        names.append(self.glo)

    monkeypatch.setattr(Query, "__init__", listed)
    return names


def test_samples_are_the_pixels_that_are_drawn(gl, functions):
    target = gl.simple_framebuffer((16, 8))
    query = Query(functions, "samples")
    assert query.value() == 0
    program = gl.program(
        vertex_shader="#version 330\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, "
        "gl_VertexID == 2 ? 3 : -1, 0, 1); }",
        fragment_shader="#version 330\nout vec4 c; void main() { c = vec4(1.0); }",
    )
    array = gl.vertex_array(program, [])
    with functions.framebuffers_kept():
        target.use()
        gl.enable_only(moderngl.NOTHING)
        for _ in range(2):
            with query:
                array.render(vertices=3)
            assert query.value() == 16 * 8
    query.release()
    assert query.value() == 0
    for thing in (array, program, target):
        thing.release()


def test_names_are_free_after_release(functions, made):
    timers = Timers(functions)
    for name in ("a", "b", "a"):
        with timers.timed(name):
            pass
    assert timers.names == ["a", "b"]
    assert len(made) == 2
    assert all(functions.function("glIsQuery")(name) for name in made)
    assert timers.ms("a") >= 0.0
    timers.drop("a")
    timers.drop("a")
    assert timers.names == ["b"]
    timers.release()
    timers.release()
    assert not any(functions.function("glIsQuery")(name) for name in made)


def test_times_are_not_cut_to_32_bits(functions, monkeypatch):
    timers = Timers(functions)
    with timers.timed("long"):
        pass
    ask = functions.function

    def patched(name):
        def late(_query, _what, found):
            ctypes.cast(found, ctypes.POINTER(ctypes.c_uint64))[0] = 5_000_000_000

        return late if name == "glGetQueryObjectui64v" else ask(name)

    monkeypatch.setattr(functions, "function", patched)
    assert timers.ms("long") == 5000.0
    monkeypatch.undo()
    timers.release()


def fiblets(gl, fabricate, random_lines):
    return FibletRenderer(gl, fabricate(random_lines(20), kind=2))


def volume(gl, *_):
    values = np.random.default_rng(1).random((9, 9, 9), np.float32)
    return VolumeRenderer(gl, RaycastVolume(values, np.diag([4.0, 4.0, 4.0, 1.0])))


def tubes(gl, *_):
    return TubeRenderer(gl, bundle(3, 3))


SURFACE = RaycastOptions("isosurface", values=(0.5,))


@pytest.mark.parametrize("make", [fiblets, tubes, volume])
def test_a_cards_timers_go_with_their_renderer(gl, functions, made, fabricate, random_lines, camera, monkeypatch, make):
    """Software OpenGL is timed by the clock; here it counts as a card."""
    monkeypatch.setattr(passes, "is_software", lambda ctx: False)
    renderer = make(gl, fabricate, random_lines)
    view = View(SIZE, camera(SIZE))
    buffer = renderer.render(view, *([VolumeStyle(casting=SURFACE)] if make is volume else []))
    effect = RayOcclusionPass(gl) if make is volume else None
    if effect is not None:
        for smooth in (True, False):
            effect.draw(renderer, buffer, SURFACE, view, radius=4.0, samples=2, smooth=smooth)
        assert [one["name"] for one in effect.explain()["passes"]] == ["ray occlusion (effect)"]
    assert all(one["ms"] >= 0.0 for one in renderer.explain()["passes"])
    assert len(made) >= (3 if make is volume else 2)
    for thing in (effect, renderer):
        if thing is not None:
            thing.release()
    assert not any(functions.function("glIsQuery")(name) for name in made)
