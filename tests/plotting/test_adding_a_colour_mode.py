"""A colour mode is added by one declaration and its shader, and is everywhere: one is put into a copy of all."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.reference_compiler import complaints

ROOT = Path(__file__).resolve().parents[2]

DECLARATION = """    ColourMode(
        "octants", "the axes that a line mostly follows", of_directions=lambda d: (np.abs(d) >= 0.5).astype(float)
    ),
"""

SHADER = """// The axes that a line mostly follows.

vec4 line_colour(uint streamline, vec3 tangent, float value) {
    return vec4(step(0.5, abs(tangent)), 1.0);
}
"""

IN_THE_COPY = """
import sys
from pathlib import Path

import numpy as np
import pyvista as pv

import pvfiblets
from pvfiblets.mappers.drawn_lines import fiblet_lines, halo_lines, tube_lines
from pvfiblets.mappers.line_data import COLOURS
from pvfiblets.plotting.page.page_scene import page_of

root = Path(sys.argv[1])
assert Path(pvfiblets.__file__).is_relative_to(root)
t = np.linspace(0.0, 10.0, 41)
lines = [np.stack([t, t, 0 * t], 1)]  # half in x, half in y: yellow, and orientation would be darker


def drawn(add, **more):
    plotter = pv.Plotter(off_screen=True, window_size=(80, 80))
    plotter.set_background("black")
    plotter.picture.antialias = "off"
    actor = getattr(plotter, add)(lines, scalars="octants", **more)
    plotter.view_xy()
    picture = plotter.screenshot(return_img=True)
    found = picture[picture.any(axis=2)]
    assert len(found) > 20
    return plotter, actor, np.unique(found, axis=0).astype(int)


wide = {"line_width": 4, "lighting": False}
plotter, actor, colours = drawn("add_fiblets", **wide)
assert colours.tolist() == [[255, 255, 0]]
written = fiblet_lines(actor.mapper.fiblets, actor.mapper.colouring, None, np.arange(1))
assert np.unique(written.columns[COLOURS], axis=0).tolist() == [[255, 255, 0, 255]]
assert page_of(plotter).layers[0]["colours"] == {"mode": "octants"}
for pipeline in [found.name for found in plotter.fiblets.pipelines() if found.available]:
    _, _, colours = drawn("add_fiblets", opacity=0.5, pipeline=pipeline, **wide)
    assert (abs(colours - [[128, 128, 0]]) <= 1).all(), pipeline
_, _, colours = drawn("add_fiblets", style="density")
assert (colours[:, 0] == colours[:, 1]).all() and (colours[:, 2] == 0).all() and colours.max() == 255
for add, more, lines_of in (
    ("add_spline_tubes", {"radius": 0.5, "lighting": False},
     lambda a: tube_lines(a.mapper.tubes, a.mapper.colouring, 1000)),
    ("add_halo_lines", {"line_width": 0.5, "halo_color": "white"},
     lambda a: halo_lines(a.mapper.drawn, a.mapper.look, a.mapper.colouring, np.arange(1), None, (1, 1, 1))),
):
    _, actor, colours = drawn(add, **more)
    written = lines_of(actor).columns[COLOURS]
    assert np.unique(written, axis=0).tolist() == [[255, 255, 0, 255]]
    assert [255, 255, 0] in colours.tolist(), (add, colours)  # halos are white

sys.path.insert(0, str(root / "scripts"))
from page_shaders import page_shader, STAGES

for name in ("page/resolve.frag", "page/through.frag"):
    (root / Path(name).name).write_text(page_shader(name, STAGES[name]))
print("everywhere")
"""


@pytest.mark.more
def test_one_declaration_and_a_shader_are_enough(tmp_path):
    ignored = shutil.ignore_patterns("__pycache__", "static")
    for folder in ("pvfiblets", "shaders", "scripts", "client"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=ignored)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    (tmp_path / "shaders" / "colour" / "octants.glsl").write_text(SHADER)
    modes = tmp_path / "pvfiblets" / "colour_modes.py"
    before, line, after = modes.read_text().partition("_ALL = (\n")
    modes.write_text(before + line + DECLARATION + after)
    path = os.pathsep.join([str(tmp_path), *filter(None, [os.environ.get("PYTHONPATH")])])
    done = subprocess.run(
        [sys.executable, "-c", IN_THE_COPY, str(tmp_path)],
        capture_output=True, text=True, check=False, env={**os.environ, "PYTHONPATH": path}, cwd=tmp_path,
    )  # fmt: skip
    assert done.stdout.strip().endswith("everywhere"), done.stderr
    pages = [tmp_path / "resolve.frag", tmp_path / "through.frag"]
    for page in pages:
        text = page.read_text()
        assert "#define FEATURE_COLOUR_OCTANTS " in text
        page.write_text(re.sub(r"#define FEATURE_(\w+) [01]", _octants, text))
    if shutil.which("glslangValidator"):
        assert not complaints(pages)


def _octants(found: re.Match[str]) -> str:
    return f"#define FEATURE_{found[1]} {int(found[1] == 'COLOUR_OCTANTS')}"
