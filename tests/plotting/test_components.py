"""Plotters know all components without an import of what draws them, and import each when it is first asked for."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from pvfiblets.plotting.components import HOMES

ROOT = Path(__file__).parents[2]

SCRIPT = """
import inspect, sys
import pyvista as pv
import pvfiblets.plotting
from pvfiblets.plotting.components import HOMES

class Interactor(pv.plotting.plotter.BasePlotter):
    def __getattr__(self, name):  # as that of a window's toolkit, which knows nothing of entry points
        raise AttributeError(name)

assert not any(name.endswith("component") for name in sys.modules if name.startswith("pvfiblets"))
plotter = Interactor.__new__(Interactor)
name = sys.argv[1]
if sys.argv[2] == "class":
    assert inspect.isclass(getattr(pv.Plotter, name)) or callable(getattr(pv.Plotter, name))
found = getattr(plotter, name)
assert getattr(plotter, name) is found
loaded = {module for module in sys.modules if module.startswith("pvfiblets.plotting") and module.endswith("component")}
assert loaded == {"pvfiblets.plotting." + HOMES[name]} | loaded & {"pvfiblets.plotting.picture_component"}, loaded
if name.startswith("add_"):
    assert len(inspect.signature(found).parameters) > 10
    assert found.__doc__
"""


def test_homes_are_the_entry_points():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    told = project["entry-points"]["pyvista.plotter_components"]
    assert {name: f"pvfiblets.plotting.{home}" for name, home in HOMES.items()} == told


@pytest.mark.few(2)
@pytest.mark.parametrize(("name", "how"), [("add_fiblets", "class"), *((name, "plotter") for name in HOMES)])
def test_a_component_is_imported_when_it_is_asked_for(name, how):
    done = subprocess.run([sys.executable, "-c", SCRIPT, name, how], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


ADDED = """
import sys
import numpy as np
import pyvista as pv

line = np.stack([np.linspace(0.0, 9.0, 12), np.zeros(12), np.sin(np.arange(12.0))], axis=1)
cube = np.arange(125.0).reshape(5, 5, 5)
given = {"add_halo_points": [line], "add_raycast_volume": [cube], "add_slices": [cube],
         "add_connectome": [np.ones((12, 12)), line]}
plotter = pv.Plotter(off_screen=True)
actor = getattr(plotter, sys.argv[1])(*given.get(sys.argv[1], [[line, line + 1.0]]))
plotter.show(auto_close=False)
plotter.close()
"""


@pytest.mark.parametrize("name", [name for name in HOMES if name.startswith("add_")])
def test_each_kind_of_actor_needs_no_other(name):
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", ADDED, name], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
