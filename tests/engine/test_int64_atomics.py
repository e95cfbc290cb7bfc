"""Depth and owner in one 64-bit word, on a machine whose OpenGL has 64-bit integers but no atomics of them.

Here they draw (test_strict_shaders.py compiles them): Mesa's software OpenGL on one thread stands in for the
atomic, by a plain write; where lanes of one instruction overwrote each other, drawing again mends it, because a word
only ever falls.
"""

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from pvfiblets.engine.fiblets.pipelines import CONSTANTS
from pvfiblets.engine.fiblets.pipelines.compute import _has_int64_atomics
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.shaders import EXTENDED, assemble

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("stage", ["clear", "depth", "split"])
def test_depth_and_owner_are_taken_at_once(stage):
    source = assemble(f"fiblets/compute/{stage}.comp", ["INT64_ATOMICS", "DIRECTION"], CONSTANTS, version=EXTENDED)
    assert ("atomicMin(nearest" in source) == (stage == "depth")


@pytest.mark.parametrize(
    ("extensions", "bindings", "expected"),
    [
        (["GL_NV_shader_atomic_int64", "GL_ARB_gpu_shader_int64"], 96, True),
        (["GL_NV_shader_atomic_int64", "GL_ARB_gpu_shader_int64"], 8, False),
        (["GL_NV_shader_atomic_int64"], 96, False),
        (["GL_EXT_shader_image_int64", "GL_ARB_gpu_shader_int64"], 96, False),
    ],
)
def test_used_where_storage_buffers_have_them(extensions, bindings, expected, monkeypatch):
    limits = "GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS", "GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS"
    asked = dict.fromkeys(limits, bindings)
    monkeypatch.setattr(GLExtras, "get_integer", lambda self, name: asked[name])
    ctx = SimpleNamespace(extensions=set(extensions), info={"GL_VENDOR": "somebody"}, version_code=460)
    assert _has_int64_atomics(ctx) is expected
    ctx.version_code = 440
    assert not _has_int64_atomics(ctx)


DRAW = """
import sys
import moderngl
import numpy as np
from pvfiblets import compress, synthetic
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.gbuffer import GBuffer
from pvfiblets.engine.gl import shaders
from pvfiblets.engine.fiblets.pipelines import compute
from pvfiblets.report.studies.stability.render_checks import camera

ctx = moderngl.create_context(standalone=True, backend="egl")
if "GL_ARB_gpu_shader_int64" not in ctx.extensions:
    sys.exit("no 64-bit integers")
lines = synthetic.brain_streamlines(120, 0.5, seed=3)
offsets = np.concatenate([lines.offsets, lines.offsets[1:] + lines.n_points])
fiblets = compress(type(lines)(np.concatenate([lines.points] * 2), offsets))  # every streamline has a twin
honest, once = shaders.read_shader, compute.ComputePipeline._run_listed


def plain(name):
    text = honest(name).replace("atomicMin(nearest[at], word)", "nearest[at] = word")
    return text.replace("#extension GL_NV_shader_atomic_int64 : require", "")


def again(self, stage, parts, number, *rest, **uniforms):
    for _ in range(8 if number in (compute.SEEN, compute.PREDICTED, compute.REST) else 1):
        yield from once(self, stage, parts, number, *rest, **uniforms)
        self._barrier()


def others(culling):
    moved = type(lines)(lines.points + [3.0, 1.0, 2.0], lines.offsets)
    return FibletRenderer(ctx, compress(moved), pipeline="compute", culling=culling)


def pictures(culling):
    renderer = FibletRenderer(ctx, fiblets, pipeline="compute", culling=culling)
    cut = [[1.0, 0.2, 0.1, 5.0]]
    for turn, width, planes in ((0, 1.0, ()), (0.3, 1.0, ()), (60, 1.0, ()), (61, 4.0, ()), (61, 2.0, cut)):
        side = np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn)), 0.3]) / np.hypot(1.0, 0.3)
        matrix = camera((200, 150), eye=np.array([0, -18, 8]) + 300 * side, target=(0, -18, 8), near=100.0, far=500.0)
        gbuffer = renderer.render(View((200, 150), matrix, planes), FibletStyle(width, values="arc_length"))
        yield [t.read() for t in (gbuffer.depth, gbuffer.owner)], [t.read() for t in (gbuffer.ids, gbuffer.position)]
    view, style, other = View((200, 150), matrix), FibletStyle(4.0, values="arc_length"), others(culling)
    target = GBuffer(ctx, (200, 150))
    for adds, drawn in enumerate((renderer, other)):
        for lines in drawn.sampled(view, style, (0, 0, 200, 150)):
            for _ in lines.draw(view, style, target, bool(adds)):
                pass
    yield [t.read() for t in (target.depth, target.owner)], [t.read() for t in (target.ids, target.position)]
    target.release()
    other.release()
    names = [p["name"] for p in renderer.explain()["passes"]]
    print(*names)
    buffers = {b["name"]: b["bytes"] for b in renderer.explain()["buffers"]}
    print(buffers.get("nearest"))
    renderer.release()


for culling in (None, "two-phase", "coverage"):
    expected = list(pictures(culling))
    with_words, compute._has_int64_atomics = compute._has_int64_atomics, lambda ctx: True
    shaders.read_shader, compute.ComputePipeline._run_listed = plain, again
    found = list(pictures(culling))
    compute._has_int64_atomics, shaders.read_shader, compute.ComputePipeline._run_listed = with_words, honest, once
    for (same, some), (same_too, some_too) in zip(expected, found, strict=True):
        assert same == same_too
        drawn = np.frombuffer(same[0], "<u4") != 0xFFFFFFFF
        assert drawn.sum() > 500
        for a, b in zip(some, some_too, strict=True):
            a, b = (np.frombuffer(t, "<u4").reshape(-1, 2)[drawn] for t in (a, b))
            assert (a == b).all()
assert ctx.error == "GL_NO_ERROR"
"""


@pytest.mark.more
def test_pictures_are_the_same_bit_by_bit(tmp_path):
    script = tmp_path / "draw.py"
    script.write_text(DRAW)
    environment = {**os.environ, "LP_NUM_THREADS": "0", "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
    done = subprocess.run([sys.executable, script], env=environment, capture_output=True, text=True, check=False)
    if done.stderr.strip() == "no 64-bit integers":
        pytest.skip("this OpenGL has no 64-bit integers")
    assert done.returncode == 0, done.stderr[-4000:]
    lines = done.stdout.splitlines()
    for plain, words in zip(lines[0::4], lines[2::4], strict=True):
        assert "resolve_ties" in plain
        assert "owners" not in plain
        assert "owners" in words
        assert "resolve_ties" not in words
    assert "split" in lines[6]
    assert lines[1] == "None"
    assert lines[3] == str(8 * 200 * 150)
