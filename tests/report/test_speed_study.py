"""The study of speed: each of its cells draws, what a driver dies of is told, and a bare machine can run it."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from pvfiblets.report.process import CellProcess
from pvfiblets.report.studies.speed import lines, reading
from pvfiblets.report.studies.speed import study as speed
from pvfiblets.report.studies.speed.cells import measure_cell
from pvfiblets.report.study import Budget

from .little import little

ROOT = Path(__file__).parents[2]
SMALL = {"size": [96, 72], "frames": 1, "limit": 0.1}
BRAIN = {**SMALL, "step": 1.0, "segments": 2e4, "view": "far"}
CELLS = [
    {"kind": "fiblets", "pipeline": "auto", "culling": "two-phase", **BRAIN},
    {"kind": "line strips", **BRAIN},
    {"kind": "feature", "feature": "cut sphere", **BRAIN},
    {"kind": "volume", "voxels": 16, "mode": "mip", **SMALL},
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return str(tmp_path_factory.mktemp("brains"))


@pytest.mark.parametrize("cell", CELLS, ids=lambda cell: cell["kind"])
def test_a_cell_draws(folder, cell):
    row = measure_cell({**cell, "folder": folder})
    assert len(row["seconds"]) >= 1
    assert min(row["seconds"]) > 0.0
    if cell["kind"] == "line strips":
        assert row["gpu_bytes"] >= 16 * 19_000


@pytest.mark.more
def test_cells_are_records_by_size_and_what_is_not_there_is_told(gl, monkeypatch, folder):
    monkeypatch.setenv(speed.BRAINS, folder)
    monkeypatch.setattr(speed, "QUICK_SEGMENTS", (1e4, 2e4))
    fiblets = {"kind": "fiblets", "step": 1.0, "view": "far", "size": [96, 72]}
    cells = [{**fiblets, "segments": count, "pipeline": pipeline, "culling": "two-phase"}
             for count in (1e4, 2e4) for pipeline in ("compute", "none")]  # fmt: skip
    monkeypatch.setattr(speed, "sections", lambda *_: [cells])
    left = []
    records = list(speed.STUDY.run(little(left_out=left)))
    assert [record.data for record in records] == [
        "0.01 M segments, 96×72", "0.02 M segments, 96×72", "by segments, 96×72",
    ]  # fmt: skip
    assert [record.default for record in records] == [True, True, False]
    for record, number in zip(records, ("0.01", "0.02"), strict=False):
        assert records[2].errors[f"ms at M segments {number}"].value == pytest.approx(1e3 * record.value("times/draw"))
    reasons = [item.reason for item in left if item.what.endswith("none, culling two-phase")]
    assert len(reasons) == 2
    assert reasons[0].startswith("ended with 1: ValueError: pipeline is 'none'")
    assert reasons[1] == "far too slow at fewer segments"


def test_what_there_was_no_time_for_is_told(gl):
    left = []
    assert not list(speed.STUDY.run(little(budget=Budget(0.0), left_out=left)))
    late = [item for item in left if item.reason == "the time given was used up"]
    assert len(late) > 20
    assert any(item.what == "halos: shape-small, 320×180, halos" for item in late)


def test_a_whole_run_has_the_papers_tables():
    first, strips, figures, others, larger = speed.sections(False, ["compute", "geometry"])
    assert len(first) == len(larger) == 6 * 2 * 3
    assert {cell["segments"] for cell in strips} == set(speed.STRIPS)
    assert len(figures) == len(speed.FEATURES) + 2
    assert len(others) == 5 * 2 + 3 + 2 * 3


def test_what_a_process_dies_of_is_a_row_and_the_next_cell_has_another(tmp_path):
    script = tmp_path / "draws.py"
    script.write_text(
        "import sys, json, time, os\n"
        "for number, line in enumerate(sys.stdin):\n"
        "    wanted = json.loads(line)['wanted']\n"
        "    if wanted == 'die': sys.exit('no such card')\n"
        "    if wanted == 'crash': os.abort()\n"
        "    if wanted == 'sleep': time.sleep(600)\n"
        "    print(json.dumps({'number': number}), flush=True)\n"
    )
    process = CellProcess([sys.executable, str(script)])
    rows = [process.measure({"wanted": one}, 5.0) for one in ("", "", "die", "", "crash", "")]
    rows += [process.measure({"wanted": "sleep"}, 0.5), process.measure({"wanted": ""}, 5.0)]
    process.close()
    assert rows == [
        {"number": 0}, {"number": 1}, {"unmeasured": "ended with 1: no such card"}, {"number": 0},
        {"unmeasured": "ended by SIGABRT"}, {"number": 0}, {"unmeasured": "takes more than 0.5 s here"},
        {"number": 0},
    ]  # fmt: skip


def test_impossible_data_is_reported(tmp_path):
    (tmp_path / "a file").write_text("")
    left = []
    cell = {**CELLS[0], "folder": str(tmp_path / "a file")}
    assert speed.measured(cell, CellProcess([]), set(), little(left_out=left)) is None
    assert left[0].reason.startswith("its data was not made: ")


@pytest.mark.more
def test_lines_in_windows_are_measured_beside_vtks(monkeypatch):
    monkeypatch.setattr(lines, "QUICK_SIZE", (64, 48))
    left = []
    records = list(lines.STUDY.run(little(left_out=left)))
    assert not left
    found = {record.label: record for record in records}
    assert list(found) == ["fiblets", "VTK's polylines", "VTK's polylines (without multi-sampling)", "VTK's tubes"]
    memory = {label: record.costs["memory"].value for label, record in found.items()}
    assert memory["fiblets"] < 4.0
    # 12 bytes of place, 4 of colour, 8 of the two indices of a segment; six sides of tubes have normals as well.
    assert 23.5 < memory["VTK's polylines"] < 24.0
    assert memory["VTK's tubes"] > 6 * (12 + 4 + 12 + 24)
    for record in records:
        assert record.costs["peak"].value > 50.0
        assert record.costs["load"].value > 0.0
        assert len(record.data.split(" M segments")) == 2


def test_reading_is_measured_beside_nibabel():
    left = []
    records = list(reading.STUDY.run(little(left_out=left)))
    assert not left
    assert [record.label for record in records] == 2 * ["pvfiblets", "pvfiblets (in pieces)", "nibabel"] + [
        "pvfiblets", "pvfiblets (in pieces)",
    ]  # fmt: skip
    assert all(record.costs["size"].value >= 12.0 for record in records)
    assert all(record.times["read"].items > 50_000 for record in records)


@pytest.mark.more
def test_a_bare_machine_draws_cells_without_what_users_have(tmp_path):
    """Libraries beside moderngl, NumPy and numba are missing: a cell is drawn, and the command writes its page."""
    missing = ("vtk", "vtkmodules", "pyvista", "matplotlib", "nibabel", "tqdm", "platformdirs", "PIL", "scipy", "dipy")
    bare = f"import json, sys; sys.modules.update(dict.fromkeys({missing}))\n"

    def run(code, *arguments):
        done = subprocess.run([sys.executable, "-c", bare + code, *arguments], cwd=ROOT, capture_output=True, text=True,
                              check=False)  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    code = (
        "from pvfiblets.report.studies.speed.cells import measure_cell\n"
        "print(json.dumps(measure_cell(json.loads(sys.argv[1]))))"
    )
    row = json.loads(run(code, json.dumps({**CELLS[0], "folder": str(tmp_path)})).splitlines()[-1])
    assert min(row["seconds"]) > 0.0
    code = "from pvfiblets.cli.command import main; sys.exit(main(sys.argv[1:]))"
    run(code, "report", "--only", "speed", "--minutes", "1e-6", "-o", str(tmp_path / "report"))
    assert "the time given was used up" in (tmp_path / "report" / "report.md").read_text()


def test_the_script_names_what_a_bare_machine_lacks(tmp_path):
    python = tmp_path / "python"
    python.write_text("#!/bin/sh\necho moderngl numba\n")
    python.chmod(0o755)
    done = subprocess.run(
        [ROOT / "scripts/card.sh", str(tmp_path)], env={"PYTHON": str(python), "PATH": "/usr/bin:/bin"},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 1
    assert done.stderr == f"missing: moderngl numba. Install them: {python} -m pip install moderngl numba\n"
