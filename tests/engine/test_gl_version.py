"""Contexts that say they are old, of a vendor whose old contexts have all of later versions."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
DRAW = """
import sys
import moderngl, numpy as np
from pvfiblets import Streamlines, compress
from pvfiblets.engine import FibletRenderer, View
from pvfiblets.engine.gl import capabilities, gl_version
from pvfiblets.report.studies.stability import render_checks

ctx = moderngl.create_standalone_context(require=320, backend="egl")
if sys.argv[1] == "generous":
    gl_version.GENEROUS = (ctx.info["GL_VENDOR"],)
rng = np.random.default_rng(0)
points = np.cumsum(rng.normal(0.0, 1.0, (40, 50, 3)), axis=1).reshape(-1, 3)
fiblets = compress(Streamlines(points, np.arange(0, 2001, 50)))
print(ctx.version_code, gl_version.version_of(ctx))
renderer = FibletRenderer(ctx, fiblets)
print(renderer.pipeline, capabilities.Capabilities.from_context(ctx).version)
buffer = renderer.render(View((160, 120), render_checks.camera((160, 120), eye=(0, -90, 30))))
np.save(sys.argv[2], np.frombuffer(buffer.depth.read(), "u4"))
assert ctx.error == "GL_NO_ERROR"
renderer.release()
"""


def drawn(path, kind, **environment):
    done = subprocess.run(
        [sys.executable, "-c", DRAW, kind, str(path)], cwd=ROOT, capture_output=True, text=True, check=False,
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])} | environment,
    )  # fmt: skip
    return done.stdout.split(), done.stderr, np.load(path) if path.exists() else None


@pytest.mark.usefixtures("older_opengl")  # which skips where OpenGL cannot be told to be older
def test_an_old_context_with_all_of_later_versions_draws_as_a_new_one(tmp_path):
    plain, _, right = drawn(tmp_path / "new.npy", "plain")
    assert int(plain[0]) == int(plain[1]) >= 430
    told, _, found = drawn(tmp_path / "old.npy", "generous", MESA_GL_VERSION_OVERRIDE="3.2")
    assert told[0] == "320"
    assert int(told[1]) >= 430
    assert told[2] == plain[2] == "compute"
    assert np.array_equal(found, right)
    assert (right != 0xFFFFFFFF).any()


def test_an_old_context_of_others_is_as_old_as_it_says(tmp_path, older_opengl):
    for kind, environment in (("plain", {"MESA_GL_VERSION_OVERRIDE": "3.2"}), ("generous", older_opengl("3.2"))):
        told, said, found = drawn(tmp_path / f"{kind}.npy", kind, **environment)
        assert told[:2] == ["320", "320"]
        assert found is None
        assert "no pipeline can draw fiblets on OpenGL 3.2" in said


def test_a_vendor_keeps_the_features_that_it_compiles(tmp_path, older_opengl):
    """Extensions that are listed, but a language that is not compiled."""
    told, _, _ = drawn(tmp_path / "a.npy", "generous", **older_opengl("3.2") | {"MESA_GLSL_VERSION_OVERRIDE": "330"})
    assert told[:2] == ["320", "330"]
    assert told[2] == "geometry"
