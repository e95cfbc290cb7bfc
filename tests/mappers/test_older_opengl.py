"""Everything but the engine's own pipelines asks for no more than OpenGL 3.3, so that macOS (4.1) runs it.

Each test is a process of its own: Mesa reads how old it has to be when it is loaded.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent

COMPILE = """
import moderngl
ctx = moderngl.create_standalone_context(require=330, backend="egl")
for stage, source in (
    ("compute", "#version 430\\nlayout(local_size_x = 1) in; void main() {}"),
    ("storage", "#version 330\\n#extension GL_ARB_shader_storage_buffer_object : require\\n"
                "buffer B { uint b[]; }; void main() { gl_Position = vec4(b[0]); }"),
    ("plain", "#version 330\\nvoid main() { gl_Position = vec4(0); }"),
):
    try:
        if stage == "compute":
            ctx.compute_shader(source)
        else:
            ctx.program(vertex_shader=source, varyings=["gl_Position"])
        print(stage)
    except moderngl.Error:
        pass
"""

SCENE = """
import sys
import numpy as np
import pyvista as pv
plotter = pv.Plotter(off_screen=True, window_size=(240, 200))
plotter.set_background("black")
line = np.c_[np.linspace(-10, 10, 61), np.zeros(61), np.zeros(61)]
actor = plotter.add_fiblets([line], color="red", lighting=False, line_width=5, pipeline=sys.argv[1])
plotter.view_xy()
plotter.show(auto_close=False)
picture = plotter.screenshot(None)
assert (picture[100, 60:180] == (255, 0, 0)).all(), picture[100, 120]
streamline, along = actor.pick_at(120, 100)
assert streamline == 0 and abs(along - 30) < 1.5, along
print("drawn")
"""


def run(environment, *arguments):
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, check=False, env=environment, timeout=280
    )


@pytest.mark.parametrize("version", ["4.1", "3.3"])
def test_the_older_opengl_of_these_tests_really_lacks_what_is_newer(older_opengl, version):
    result = run(older_opengl(version), "-c", COMPILE)
    assert result.stdout.split() == ["plain"], result.stderr


@pytest.mark.more
@pytest.mark.parametrize("version", [pytest.param("4.1", marks=pytest.mark.exhaustive), "3.3"])
def test_mapper_windows_and_picking_run_there(older_opengl, version):
    """The mapper's own tests, by the pipeline that is left."""
    files = [str(HERE / f"test_{name}.py") for name in ("picture", "picking", "passes", "windows")]
    chosen = ("-k", "picked or pick_at or polylines or window or translucent_mesh", "-p", "no:cacheprovider", "-q")
    result = run(older_opengl(version), "-m", "pytest", *files, *chosen)
    assert result.returncode == 0, result.stdout[-3000:]
    assert int(result.stdout.rsplit(" passed", 1)[0].split()[-1]) > 20


# The pipeline is forced: that the picture is right shows that it drew, for compute shaders do not compile here.
@pytest.mark.more
@pytest.mark.parametrize(
    ("version", "pipeline"),
    [
        (None, "auto"), ("4.1", "auto"), ("4.1", "tessellation"), ("3.3", "auto"),
        *(pytest.param(version, "geometry", marks=pytest.mark.exhaustive) for version in ("4.1", "3.3")),
    ],
)  # fmt: skip
def test_a_plotter_draws_and_picks_there(older_opengl, version, pipeline):
    """And by this OpenGL: without that, a mistake in the scene would look like a missing pipeline."""
    result = run(older_opengl(version) if version else None, "-c", SCENE, pipeline)
    assert result.stdout.split()[-1:] == ["drawn"], result.stderr[-2000:]
