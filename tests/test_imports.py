"""What importing the package costs, and which way its imports point."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
HEAVY = ("vtkmodules", "vtk", "pyvista", "numba", "moderngl", "trame", "matplotlib", "nibabel")


def modules_after(statement: str) -> set[str]:
    code = f"{statement}\nimport sys, json\nprint(json.dumps(sorted(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(json.loads(done.stdout.splitlines()[-1]))


def test_importing_the_package_imports_nothing_heavy():
    loaded = modules_after("import pvfiblets")
    assert not loaded & set(HEAVY)


def test_importing_formats_and_streamlines_imports_nothing_heavy():
    loaded = modules_after("import pvfiblets.formats, pvfiblets.streamlines")
    assert not loaded & set(HEAVY)


def test_the_codec_needs_no_drawing():
    loaded = modules_after("import pvfiblets.codec")
    assert not loaded & {"vtkmodules", "vtk", "pyvista", "moderngl"}


def test_the_engine_needs_no_vtk():
    loaded = modules_after("import pvfiblets.engine")
    assert not loaded & {"vtkmodules", "vtk", "pyvista"}


def test_the_mappers_need_no_pyvista():
    assert "pyvista" not in modules_after("import pvfiblets.mappers")


def test_imports_follow_the_flow():
    program = Path(sys.executable).with_name("lint-imports")
    done = subprocess.run([program], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    "group", ["pyvista.plotter_components", "pyvista.accessors", "pyvista.readers",
              "pyvista.writers"],
)
def test_every_entry_point_resolves(group):
    ours = [point for point in entry_points(group=group) if point.value.startswith("pvfiblets")]
    assert ours
    for point in ours:
        assert point.load() is not None
