"""What importing the package costs, and which way its imports point."""

from __future__ import annotations

import json
import subprocess
import sys
from graphlib import CycleError, TopologicalSorter
from importlib.metadata import entry_points
from pathlib import Path

import grimp
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


def test_one_machine_pays_nothing_for_clusters(tmp_path):
    """Neither the commands nor a file that is written and read load anything of them."""
    loaded = modules_after(
        "import pvfiblets, pvfiblets.cli, pvfiblets.cluster, numpy\n"
        "pvfiblets.cli.make_parser()\n"
        f"path = {str(tmp_path / 'a.fiblets')!r}\n"
        "pvfiblets.write(path, pvfiblets.Streamlines.from_list([numpy.eye(3)]))\n"
        "pvfiblets.cli.main(['info', path])\n"
        "pvfiblets.read(path)"
    )
    assert not loaded & {"dask", "distributed", "pyarrow", "fsspec", "pandas", "pvfiblets.cluster.cohort"}


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


def circles(imports: dict[str, set[str]]) -> list[list[str]]:
    """Modules that import each other, straight or by way of others, as far as they cannot be put in an order."""
    sorter = TopologicalSorter(imports)
    try:
        sorter.prepare()
    except CycleError as error:
        return [error.args[1]]
    return []


def test_a_circle_is_seen():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}})
    assert not circles({"a": {"b", "c"}, "b": {"c"}, "d": {"a"}})


def test_no_modules_import_each_other():
    """Imports within functions count; those for type checkers do not."""
    graph = grimp.build_graph("pvfiblets", exclude_type_checking_imports=True, cache_dir=None)
    assert len(graph.modules) > 300
    found = circles({name: graph.find_modules_directly_imported_by(name) for name in graph.modules})
    assert not found, " imports ".join(reversed(found[0]))


@pytest.mark.parametrize(
    "group", ["pyvista.plotter_components", "pyvista.accessors", "pyvista.readers",
              "pyvista.writers"],
)
def test_every_entry_point_resolves(group):
    ours = [point for point in entry_points(group=group) if point.value.startswith("pvfiblets")]
    assert ours
    for point in ours:
        assert point.load() is not None
