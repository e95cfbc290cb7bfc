"""Drivers keep compiled programs on disk by their text: the same picture asks for the same text in every process."""

import os
import subprocess
import sys

import pytest

DRAW = """
import moderngl
from pvfiblets import compress
from pvfiblets.engine import FibletRenderer, FibletStyle
from pvfiblets.engine.gl.shaders import switched_on
from pvfiblets.engine.gl.standalone import bare_context
from pvfiblets.report.studies.culling.pictures import views
from pvfiblets.synthetic import brain_streamlines
import hashlib

texts = []
for name in ("program", "compute_shader"):
    honest = getattr(moderngl.Context, name)
    def noted(ctx, *given, honest=honest, **named):
        texts.append(repr((given, sorted((k, v) for k, v in named.items() if v))))
        return honest(ctx, *given, **named)
    setattr(moderngl.Context, name, noted)
ctx = bare_context()
fiblets = compress(brain_streamlines(8, seed=1))
view = views(fiblets.bounds, "far", 1.0, 1, (64, 48))[0]
for pipeline in ("compute", "geometry"):
    renderer = FibletRenderer(ctx, fiblets, pipeline=pipeline)
    renderer.render(view, FibletStyle(3.0, values="arc_length", tolerance=0.0))
    renderer.release()
ctx.release()
assert len(texts) > 10
print(hashlib.sha256("".join(texts).encode()).hexdigest())
"""


def entries(folder):
    return {path.relative_to(folder): path.stat().st_size for path in folder.rglob("*") if path.is_file()}


@pytest.mark.more
def test_the_second_process_compiles_nothing(gl, tmp_path):
    """Whatever seeds its hashes; Mesa keeps hardly anything beyond what it kept for the first."""
    said, kept = [], []
    for seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": seed, "MESA_SHADER_CACHE_DIR": str(tmp_path)}
        for off in ("MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DISABLE"):
            environment.pop(off, None)
        done = subprocess.run([sys.executable, "-c", DRAW], env=environment, capture_output=True, text=True, check=True)
        said.append(done.stdout)
        kept.append(entries(tmp_path))
    assert said[0] == said[1]
    if "Mesa" not in gl.info["GL_VERSION"] or not kept[0]:
        pytest.skip("this driver does not say what it keeps")
    # Mesa writes in a thread of its own, and may leave out the last one when a process ends.
    assert len(kept[1].keys() - kept[0].keys()) <= len(kept[0]) // 10
