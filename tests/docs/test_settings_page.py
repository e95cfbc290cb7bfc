"""The table of settings is that of the declarations, and of the methods and actors that a user meets."""

import inspect
import re
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "reference" / "settings.md").read_text(encoding="utf-8")
HEADS, _, *ROWS = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in PAGE.splitlines()
                   if line.startswith("|")]  # fmt: skip
LINE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 1.0, 0.0]])

METHODS = {
    "lines": ("add_fiblets", [LINE]),
    "tubes": ("add_spline_tubes", [LINE]),
    "halo lines": ("add_halo_lines", [LINE]),
    "halo points": ("add_halo_points", LINE),
    "volumes": ("add_raycast_volume", np.arange(64.0).reshape(4, 4, 4)),
    "slices": ("add_slices", np.arange(64.0).reshape(4, 4, 4)),
}


def marked(drawable, letter):
    """Return {setting: its default as text} of the rows that a drawable has a letter in."""
    column = HEADS.index(drawable)
    return {row[0].strip("`"): row[1].strip("`") for row in ROWS if letter in row[column].split()}


def test_the_page_is_that_of_the_declarations():
    spec = spec_from_file_location("settings_table", ROOT / "scripts" / "settings_table.py")
    script = module_from_spec(spec)
    spec.loader.exec_module(script)
    assert script.table() == PAGE, "run `python scripts/settings_table.py`"


@pytest.mark.parametrize("drawable", METHODS)
def test_arguments_and_defaults_are_those_of_the_method(drawable):
    method, _ = METHODS[drawable]
    taken = inspect.signature(getattr(pv.Plotter(off_screen=True), method)).parameters
    listed = marked(drawable, "A")
    assert listed == {name: repr(taken[name].default) for name in listed}
    assert len(listed) >= 9
    head = PAGE.partition("All of them also take")[2].partition(", as")[0]
    of_all = set(re.findall(r"`(\w+)`", head))
    assert len(of_all) == 7
    assert of_all <= set(taken)


@pytest.mark.parametrize("drawable", METHODS)
def test_properties_are_live_ones_of_the_actor(drawable):
    method, source = METHODS[drawable]
    plotter = pv.Plotter(off_screen=True)
    actor = getattr(plotter, method)(source)
    if drawable == "slices":
        (actor,) = actor.layers
    listed = marked(drawable, "P")
    assert len(listed) >= 9
    for name in listed:
        setattr(actor, name, getattr(actor, name))


def test_columns_are_all_drawables():
    assert set(METHODS) <= set(HEADS)
    assert all(set(row[HEADS.index(name)].split()) <= {"A", "P"} for row in ROWS for name in METHODS)
