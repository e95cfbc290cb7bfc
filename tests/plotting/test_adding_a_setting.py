"""A setting is added by one declaration and its shader, and is everywhere: a made-up one is put into a copy of all."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

DECLARATION = """
    from pvfiblets.plotting.settings.places import Uniform

    emission: Setting[float] = Setting(
        0.0,
        "Share of its colour that the surface gives off itself, whatever light falls on it.",
        kind="float",
        low=0.0,
        high=1.0,
        where=Uniform("emission", "fibletEmission"),
        row=Row("Emission", group="Shading"),
    )
"""

SHADER = """// Surfaces give off a share of their colour themselves.

//@ fragment after //VTK::CustomUniforms::Dec
uniform float fibletEmission;

//@ fragment after //VTK::Light::Impl
  gl_FragData[0].rgb = mix(gl_FragData[0].rgb, diffuseColor, fibletEmission);
"""

IN_THE_COPY = """
import inspect, json, sys
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.plotting import {actor}
from pvfiblets.web.scene import layers
from pvfiblets.web.scene.scene import Scene
from pvfiblets.web.session.script import as_script
from pvfiblets.web.session.files import from_dict, to_dict

root = Path(sys.argv[1])
assert Path(pvfiblets.__file__).is_relative_to(root)
SAID = "Share of its colour that the surface gives off itself, whatever light falls on it."

# The property and the argument: signature, doc, check.
plotter = pv.Plotter(off_screen=True, window_size=(80, 80))
plotter.set_background("black")
plotter.disable_anti_aliasing()
told = inspect.signature(plotter.{add}).parameters["emission"]
assert (told.default, told.annotation, told.kind) == (0.0, "float", told.KEYWORD_ONLY)
doc = inspect.getdoc(plotter.{add})
assert f"\\nemission : float, default: 0.0\\n    {{SAID}}\\n" in doc
assert inspect.getdoc({actor}.emission) == SAID
refused = pytest.raises(ValueError, match="emission is 2; give a number from 0 to 1")
{data}
with refused:
    plotter.{add}(data, emission=2, **more)
assert not plotter.actors
actor = plotter.{add}(data, emission=1.0, color="red", **more)
with refused:
    actor.emission = 2
assert (actor.emission, actor.copy().emission) == (1.0, 1.0)

# The shader: a surface that gives off all its colour is nothing but red; without, light falls on it.
def reds():
    plotter.render()
    picture = plotter.screenshot(None)
    return np.unique(picture[picture.any(axis=2)], axis=0).tolist()

plotter.show(auto_close=False)
assert reds() == [[255, 0, 0]]
assert "emission" in actor.mapper.effects
actor.emission = 0.0
assert len(reds()) > 3
assert "emission" not in actor.mapper.effects
plotter.close()

# The stub for type checkers.
sys.path.insert(0, str(root / "scripts"))
import plotter_stub
adders = plotter_stub.stub().split("class ")
assert [part.split("(")[0] for part in adders if "emission: float = 0.0," in part] == ["{adder}"]

# The page, sessions, and scripts.
(row,) = (prop for prop in layers.TABLES["{kind}"] if prop.name == "emission")
assert (row.type, row.label, row.help, row.group, row.default) == ("number", "Emission", SAID, "Shading", 0.0)
data.{save}
plotter = pv.Plotter(off_screen=True, window_size=(80, 80))
scene = Scene(plotter, root)
layer = scene.open("{file}", kind="{kind}")
(shown,) = (item for item in scene.queries.properties(layer.id) if item["name"] == "emission")
assert (shown["value"], shown["limits"]) == (0.0, [0.0, 1.0])
assert "emission" not in as_script(scene)
with pytest.raises(ValueError, match="emission is 2"):
    scene.set(layer.id, "emission", 2)
scene.set(layer.id, "emission", 0.5)
assert scene.actor(layer.id).emission == 0.5
assert "emission=0.5" in as_script(scene)
saved = json.loads(json.dumps(to_dict(scene)))
assert saved["layers"][0]["settings"]["emission"] == 0.5
scene.set(layer.id, "emission", 0.25)
from_dict(scene, saved)
assert scene.actor(layer.id).emission == 0.5
scene.close()
plotter.close()
print("everywhere")
"""

SPLINE = """
data = pv.Spline([(0, 0, 0), (5, 1, 0), (10, 0, 0)], 9)
more = {"radius": 2.0}
"""


@pytest.mark.more
@pytest.mark.parametrize(
    ("drawable", "names"),
    [
        ("tubes", {"actor": "TubeActor", "add": "add_spline_tubes", "adder": "_AddSplineTubes", "kind": "tubes",
                   "data": SPLINE, "file": "line.vtp", "save": "save(root / 'line.vtp')"}),
    ],
)  # fmt: skip
def test_one_declaration_and_a_shader_are_enough(drawable, names, tmp_path):
    ignored = shutil.ignore_patterns("__pycache__", "static")
    for folder in ("pvfiblets", "shaders", "scripts"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=ignored)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    (tmp_path / "shaders" / "resolve" / "emission.glsl").write_text(SHADER)
    settings = tmp_path / "pvfiblets" / "plotting" / drawable / "settings.py"
    before, line, after = settings.read_text().partition("    depth_cue = shared.DEPTH_CUE\n")
    settings.write_text(before + line + DECLARATION + after)
    path = os.pathsep.join([str(tmp_path), *filter(None, [os.environ.get("PYTHONPATH")])])
    done = subprocess.run(
        [sys.executable, "-c", IN_THE_COPY.format(**names), str(tmp_path)],
        capture_output=True, text=True, check=False, env={**os.environ, "PYTHONPATH": path}, cwd=tmp_path,
    )  # fmt: skip
    assert done.stdout.strip().endswith("everywhere"), done.stderr
