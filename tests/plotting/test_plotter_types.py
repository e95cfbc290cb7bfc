"""Type checkers and editors know what PyVista finds by entry points."""

from __future__ import annotations

import ast
import inspect
import subprocess
import sys
import tomllib
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest
import pyvista as pv

from pvfiblets.plotting import plotter

ROOT = Path(__file__).resolve().parents[2]
STUB = Path(plotter.__file__).with_suffix(".pyi")

USE = """
from pvfiblets.plotting.plotter import Plotter

plotter = Plotter(off_screen=True)
reveal_type(plotter.add_fiblets("brain.trk"))
reveal_type(plotter.raycast_volumes.add("t1.nii"))
plotter.add_halo_lines("brain.trk", line_widht=2)
reveal_type(plotter.add_spline_tubes("vessel.vtp", min_width=2).min_width)
plotter.add_mesh("brain.vtp")
"""


def test_the_stub_names_every_component_and_its_class():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    named = project["entry-points"]["pyvista.plotter_components"]
    kinds = {node.name: node for node in ast.parse(STUB.read_text()).body if isinstance(node, ast.ClassDef)}
    told = {method.name: method.returns.id for method in kinds["Plotter"].body}
    assert list(told) == list(named)
    for name, module in named.items():
        import_module(module)
        kind = getattr(pv.Plotter, name)
        assert kind is getattr(import_module(module), kind.__name__)
        assert told[name].removeprefix("_") == kind.__name__


@pytest.mark.parametrize("name", ["add_fiblets", "add_spline_tubes", "add_halo_lines", "add_halo_points",
                                  "add_raycast_volume", "add_connectome"])  # fmt: skip
def test_the_stub_has_the_arguments_and_defaults_of_the_calls(name):
    kinds = {node.name: node for node in ast.parse(STUB.read_text()).body if isinstance(node, ast.ClassDef)}
    method = getattr(pv.Plotter(off_screen=True), name)
    (call,) = kinds[f"_{getattr(pv.Plotter, name).__name__}"].body
    told = {one.arg: ast.literal_eval(default) for one, default in zip(call.args.kwonlyargs, call.args.kw_defaults,
                                                                       strict=True)}  # fmt: skip
    takes = inspect.signature(method).parameters
    assert told == {one.name: one.default for one in takes.values() if one.kind is one.KEYWORD_ONLY}


def test_the_stub_is_as_its_script_writes_it():
    found = spec_from_file_location("plotter_stub", ROOT / "scripts" / "plotter_stub.py")
    script = module_from_spec(found)
    found.loader.exec_module(script)
    assert STUB.read_text() == script.stub(), "run: python scripts/plotter_stub.py"


@pytest.mark.more
def test_a_checker_knows_what_comes_back(tmp_path):
    script = tmp_path / "use.py"
    script.write_text(USE)
    command = [sys.executable, "-m", "mypy", "--ignore-missing-imports", "--follow-imports=silent", str(script)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    said = done.stdout
    assert 'Revealed type is "pvfiblets.plotting.fiblets.actor.FibletActor"' in said
    assert 'Revealed type is "pvfiblets.plotting.volumes.actor.VolumeActor"' in said
    assert 'Revealed type is "float"' in said.replace("builtins.", "")
    assert 'Unexpected keyword argument "line_widht"' in said
    assert "Found 1 error" in said
