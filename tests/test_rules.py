"""The rules about skips on continuous integration and about what `make test` leaves out hold."""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections import Counter
from graphlib import CycleError, TopologicalSorter
from importlib.metadata import entry_points
from itertools import combinations
from pathlib import Path

import grimp
import numpy as np
import pytest
from PIL import Image

from tests.conftest import NO_FIREFOX
from tests.web.firefox import launched_firefox

CONFTEST = Path(__file__).with_name("conftest.py")


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("body", "on_ci", "passes"),
    [
        ("def test_a(): pytest.skip('no OpenGL')", True, False),
        ("def test_a(): pytest.skip('no OpenGL')", False, True),
        ("nothing = pytest.importorskip('no_such_module')\ndef test_a(): pass\n", True, False),
        ("@pytest.mark.parametrize('n', [1, 2])\ndef test_a(n):\n    if n == 2: pytest.skip('no meaning')", True, True),
        ("def test_a(shared_data): pass", True, True),
        ("def test_a(): pytest.skip('Firefox is not to be had on this machine')", True, True),
    ],
)
def test_a_check_cannot_vanish_on_ci(tmp_path, body, on_ci, passes):
    shutil.copy(CONFTEST, tmp_path / "conftest.py")
    (tmp_path / "test_it.py").write_text(f"import pytest\n{body}\n")
    (tmp_path / "test_other.py").write_text("def test_other(): pass\n")
    environment = {**os.environ, "PVFIBLETS_DATA": str(tmp_path / "none"), "PVFIBLETS_CI": "1" if on_ci else ""}
    command = [sys.executable, "-m", "pytest", "-q", "--rootdir", str(tmp_path), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment, cwd=tmp_path)
    assert (done.returncode == 0) is passes, done.stdout


def test_a_failure_says_how_to_run_it_and_where_its_pictures_are(tmp_path):
    shutil.copy(CONFTEST, tmp_path / "conftest.py")
    body = "import numpy\ndef test_a(): drawn = numpy.full((9, 8, 3), 7, 'uint8'); assert not drawn.any()\n"
    (tmp_path / "test_it.py").write_text(body)
    command = [sys.executable, "-m", "pytest", "-q", "--rootdir", str(tmp_path), "test_it.py"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert "-m pytest -m '' 'test_it.py::test_a'" in done.stdout
    (picture,) = (Path(line.split(": ")[1]) for line in done.stdout.splitlines() if line.startswith("picture 'drawn'"))
    assert (np.asarray(Image.open(picture)) == 7).all()


@pytest.mark.more
@pytest.mark.parametrize(
    ("answer", "may_miss"), [("Candidate: 153.7.0esr", False), ("Candidate: (none)", True), ("", True), (None, True)]
)
def test_firefox_may_be_missing_only_where_apt_has_none(tmp_path, monkeypatch, answer, may_miss):
    if answer is not None:
        program = tmp_path / "apt-cache"
        program.write_text(f"#!/bin/sh\necho '{answer}'\n")
        program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("FIREFOX", raising=False)
    with pytest.raises(pytest.skip.Exception) as skipped, launched_firefox(tmp_path):
        pass
    assert (NO_FIREFOX in str(skipped.value)) is may_miss


PRODUCT = """
import json, pathlib, pytest
@pytest.mark.every("pair")
@pytest.mark.parametrize("a", range(3))
@pytest.mark.parametrize("b", range(4))
@pytest.mark.parametrize(("c", "d"), [(0, 1), (1, 0)])
def test_it(a, b, c, d):
    with pathlib.Path("kept").open("a") as file:
        print(json.dumps([a, b, c]), file=file)
@pytest.mark.exhaustive
def test_other():
    pathlib.Path("other").touch()
@pytest.mark.few(2)
@pytest.mark.parametrize("e", range(5))
def test_list(e):
    pathlib.Path(f"list{e}").touch()
"""


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("arguments", "fewest", "most", "few"),
    [([], 12, 15, [0, 2]), (["-m", ""], 24, 24, [*range(5)])],
    ids=["some", "all"],
)
def test_products_are_thinned_but_every_pair_is_there(tmp_path, arguments, fewest, most, few):
    shutil.copy(CONFTEST, tmp_path / "conftest.py")
    shutil.copy(CONFTEST.parents[1] / "pyproject.toml", tmp_path)
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_it.py").write_text(PRODUCT)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *arguments]
    environment = {**os.environ, "PVFIBLETS_CI": "1"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment, cwd=tmp_path)
    assert done.returncode == 0, done.stdout
    rows = [json.loads(line) for line in (tmp_path / "kept").read_text().splitlines()]
    assert fewest <= len(rows) <= most
    for i, j in combinations(range(3), 2):
        assert len({(row[i], row[j]) for row in rows}) == (3, 4, 2)[i] * (3, 4, 2)[j]
    assert (tmp_path / "other").exists() == bool(arguments)
    assert sorted(tmp_path.glob("list*")) == [tmp_path / f"list{e}" for e in few]


@pytest.mark.skipif(shutil.which("make") is None, reason="make is not installed")
@pytest.mark.parametrize(
    "goal", ["demo", "test", "test-more", "test-all", "check-wheel", "drivers-part", "client", "docs"]
)
def test_commands_of_the_makefile_can_be_read(goal):
    read = subprocess.run(["make", "--dry-run", goal], cwd=CONFTEST.parents[1], capture_output=True, text=True)
    assert read.returncode == 0, read.stderr


ROOT = Path(__file__).resolve().parents[1]
HEAVY = ("vtkmodules", "vtk", "pyvista", "numba", "moderngl", "trame", "matplotlib", "nibabel")


def modules_after(statement: str) -> set[str]:
    code = f"{statement}\nimport sys, json\nprint(json.dumps(sorted(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(json.loads(done.stdout.splitlines()[-1]))


def test_each_room_needs_nothing_heavier():
    loaded = modules_after("import pvfiblets")
    assert not loaded & set(HEAVY)
    loaded = modules_after("import pvfiblets.formats, pvfiblets.streamlines")
    assert not loaded & set(HEAVY)
    loaded = modules_after("import pvfiblets.codec")
    assert not loaded & {"vtkmodules", "vtk", "pyvista", "moderngl"}
    loaded = modules_after("import pvfiblets.engine")
    assert not loaded & {"vtkmodules", "vtk", "pyvista"}
    assert "pyvista" not in modules_after("import pvfiblets.mappers")


def test_one_machine_pays_nothing_for_clusters(tmp_path):
    """Neither the commands nor a file that is written and read load anything of them."""
    loaded = modules_after(
        "import pvfiblets, pvfiblets.cli.command, pvfiblets.cluster, numpy\n"
        "pvfiblets.cli.command.make_parser()\n"
        f"path = {str(tmp_path / 'a.fiblets')!r}\n"
        "pvfiblets.write(path, pvfiblets.Streamlines.from_list([numpy.eye(3)]))\n"
        "pvfiblets.cli.command.main(['info', path])\n"
        "pvfiblets.read(path)"
    )
    assert not loaded & {"dask", "distributed", "pyarrow", "fsspec", "pandas", "pvfiblets.cluster.cohort"}


FLUENT = ("pvfiblets.codec.fibletset", "pvfiblets.streamlines")
"""Their classes have methods that call functions which take and make these classes."""

OWNERS = {
    "pvfiblets.mappers.engine_mapper",
    "pvfiblets.plotting.slices.stack",
    "pvfiblets.plotting.slices.workspace",
    "pvfiblets.web.app",
    "pvfiblets.web.scene.scene",
}
"""Their classes are made of parts, which name them in annotations."""


def test_imports_follow_the_flow_in_no_circle():
    program = Path(sys.executable).with_name("lint-imports")
    # Its cache may be that of another state of the tree.
    done = subprocess.run([program, "--no-cache"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}})
    assert not circles({"a": {"b", "c"}, "b": {"c"}, "d": {"a"}})
    # Imports within functions and those for type checkers count.
    typed = grimp.build_graph("pvfiblets", exclude_type_checking_imports=False, cache_dir=None)
    run = grimp.build_graph("pvfiblets", exclude_type_checking_imports=True, cache_dir=None)
    assert len(typed.modules) > 300
    imported = {name: set(typed.find_modules_directly_imported_by(name)) for name in typed.modules}
    for name, used in imported.items():
        used -= OWNERS - set(run.find_modules_directly_imported_by(name))
    for name in FLUENT:
        imported[name] = {other for other in imported[name] if at_once(typed, name, other)}
    found = circles(imported)
    assert not found, " imports ".join(reversed(found[0]))


def at_once(graph: grimp.ImportGraph, name: str, other: str) -> bool:
    """Whether a module imports another when it is imported itself, not in a function or for type checkers."""
    lines = (ROOT / name.replace(".", "/")).with_suffix(".py").read_text().splitlines()
    found = graph.get_import_details(importer=name, imported=other)
    return any(not lines[one["line_number"] - 1].startswith(" ") for one in found)


def circles(imports: dict[str, set[str]]) -> list[list[str]]:
    """Modules that import each other, straight or by way of others, as far as they cannot be put in an order."""
    sorter = TopologicalSorter(imports)
    try:
        sorter.prepare()
    except CycleError as error:
        return [error.args[1]]
    return []


@pytest.mark.parametrize(
    "group", ["pyvista.plotter_components", "pyvista.accessors", "pyvista.readers", "pyvista.writers"]
)
def test_every_entry_point_resolves(group):
    ours = [point for point in entry_points(group=group) if point.value.startswith("pvfiblets")]
    assert ours
    for point in ours:
        assert point.load() is not None


@pytest.mark.parametrize("room", sorted(path.stem for path in (ROOT / "tests" / "mutants").glob("*.toml")))
def test_faults_made_by_hand_fit_the_code_and_name_tests_that_exist(room):
    for fault in tomllib.loads((ROOT / "tests" / "mutants" / f"{room}.toml").read_text())["mutant"]:
        assert (ROOT / fault["file"]).read_text().count(fault["was"]) == 1, fault["fault"]
        assert fault["now"] != fault["was"]
        assert fault["tests"]
        for name in fault["tests"]:
            file, *inner = name.split("::")
            assert (ROOT / file).exists(), name
            if inner:
                assert f"def {inner[-1].partition('[')[0]}(" in (ROOT / file).read_text(), name


def test_files_and_folders_that_the_guide_names_exist():
    text = (ROOT / "CONTRIBUTING.md").read_text()
    names = set(re.findall(r"`((?:[\w.-]+/)+[\w.-]*)`", text))
    names -= {"codec/layout.glsl", "shaders/resolve/emission.glsl"}  # one is made in memory, one is an example
    names -= {".failed/", "docs/_build/html"}  # made by commands
    names = {name for name in names if not re.search("[A-Z]{4}", name)}
    homes = [ROOT / room for room in ("", "pvfiblets", "pvfiblets/engine/fiblets", "shaders")]
    assert len(names) > 60
    assert [name for name in sorted(names) if not any((home / name).exists() for home in homes)] == []


def test_folders_can_be_read_at_a_glance():
    files = [path for path in (ROOT / "pvfiblets").rglob("*.py") if "__pycache__" not in path.parts]
    full = {str(home): count for home, count in Counter(path.parent for path in files).items() if count > 20}
    assert not full, "more than 20 modules in a folder"
