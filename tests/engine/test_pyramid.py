"""The depth pyramid, made by compute shaders and by drawing, beside NumPy's."""

import moderngl
import numpy as np
import pytest

from pvfiblets import compress
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.culling import DepthPyramid, pyramid
from pvfiblets.engine.fiblets.pipelines import CONSTANTS
from pvfiblets.engine.gbuffer import GBuffer
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.shaders import Programs
from pvfiblets.report.studies.culling.pictures import views
from pvfiblets.synthetic import brain_streamlines

from .pictures import assert_same, read


def farthest(keys, levels):
    """Greatest keys of squares of 2, 4, ... pixels; what lies outside counts as nearest."""
    for _ in range(levels):
        keys = np.pad(keys, [(0, side % 2) for side in keys.shape])
        keys = keys.reshape(keys.shape[0] // 2, 2, keys.shape[1] // 2, 2).max(axis=(1, 3))
        yield keys


@pytest.mark.parametrize("size", [(1, 1), (64, 64), (130, 65), (1000, 7), (5, 300), (4500, 70)])
@pytest.mark.parametrize("outside", [False, True])
@pytest.mark.parametrize("drawn", [False, True])
def test_levels_are_the_farthest_of_squares(gl, monkeypatch, size, outside, drawn):
    monkeypatch.setattr(pyramid, "is_software", lambda _: drawn)
    rng, extras = np.random.default_rng(size[0]), GLExtras(gl)
    keys, scene = rng.integers(0, 2**32, (2, size[1], size[0]), dtype=np.uint32)
    target = GBuffer(gl, size)
    target.depth.write(keys.tobytes())
    made = DepthPyramid(gl, extras, Programs(gl, CONSTANTS))
    if outside:
        made.outside = gl.texture(size, 1, scene.tobytes(), dtype="u4")
        made.outside.filter = moderngl.NEAREST, moderngl.NEAREST
    made.before(target, View(size, np.eye(4)), FibletStyle())
    made.build(target)
    gl.memory_barrier()
    framebuffer = gl.framebuffer([made.texture])
    wanted = farthest(np.minimum(keys, scene) if outside else keys, made.levels)
    for level, expected in enumerate(wanted):
        rows, columns = expected.shape
        extras.attach_level(framebuffer, made.texture, level)
        found = np.frombuffer(framebuffer.read((0, 0, columns, rows), 1, dtype="u4"), np.uint32)
        np.testing.assert_array_equal(found.reshape(rows, columns), expected)
    assert made.levels >= 1
    for thing in (framebuffer, made, target, *([made.outside] if outside else [])):
        thing.release()


@pytest.mark.parametrize("pipeline", ["compute", "geometry"])
def test_frames_are_the_same_by_a_pyramid_of_compute_shaders(gl, monkeypatch, pipeline):
    """It takes image units, which the frame needs for its own again."""
    monkeypatch.setattr(pyramid, "is_software", lambda _: False)
    fiblets = compress(brain_streamlines(500, step=0.5))
    culled, whole = (FibletRenderer(gl, fiblets, pipeline=pipeline, culling=c) for c in ("two-phase", None))
    for view in views(fiblets.bounds, "far", 20.0, 3, (160, 120)):
        assert_same(read(culled.render(view)), read(whole.render(view)))
    for renderer in (culled, whole):
        renderer.release()
