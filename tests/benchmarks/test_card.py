"""``benchmarks/card.py``: each of its cells draws, and its page tells what there is and what there is not."""

import io
import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from .scripts import imported

ROOT = Path(__file__).parents[2]
SMALL = {"step": 1.0, "size": [96, 72], "frames": 1, "seconds": 0.1}
BRAIN = {**SMALL, "segments": 2e4}
CELLS = [
    {"kind": "fiblets", "pipeline": "auto", "culling": "two-phase", **BRAIN},
    {"kind": "raw lines", **BRAIN},
    {"kind": "feature", "feature": "cut sphere", **BRAIN},
    {"kind": "volume", "set": "vessels-16", "mode": "mip", **SMALL},
]


@pytest.fixture
def card():
    with imported(card="card") as modules:
        yield modules.card


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("brains")


@pytest.mark.parametrize("cell", CELLS, ids=lambda cell: cell["kind"])
def test_a_cell_draws(card, folder, cell):
    picture = folder / f"others-{cell['kind']}.npy"
    row = card.draw_cell({**cell, "picture": str(picture)}, folder)
    assert row["frames"] >= 1
    assert row["ms"] > 0.0
    if cell["kind"] == "raw lines":
        assert row["gpu_bytes"] >= 16 * row["segments"]
    else:
        shown = np.load(picture)
        assert shown.shape == (270, 480, 3)
        assert shown.any()
        assert not shown.all()


def test_the_page_tells_times_and_what_is_unmeasured(card, tmp_path):
    about = {"card": "A card (of some kind)", "driver": "4.6", "system": "Linux", "cores": 4, "date": "2026-01-01",
             "check_text": "All work."}  # fmt: skip
    row = {"section": "table 2", "kind": "fiblets", "size": [1920, 1080], "pipeline": "compute", "segments": 5.39e9,
           "cell": {"segments": 5.4e9}, "number": 0}  # fmt: skip
    results = [
        {**row, "culling": "two-phase", "ms": 7.891},
        {**row, "culling": "none", "unmeasured": "ended by SIGBUS"},
    ]
    others = {"section": "figures", "kind": "feature", "size": [1920, 1080], "ms": 1.0}
    results += [{**others, "feature": f"the {number}th", "number": number} for number in (2, 10)]
    for number, level in ((2, 200), (10, 50)):
        np.save(tmp_path / f"figures-{number:02d}.npy", np.full((270, 480, 3), level, np.uint8))
    card.write(about, results, tmp_path, tmp_path)
    page = (tmp_path / "card-a-card.md").read_text()
    assert "| compute | two-phase | 7.89 |" in page
    assert "| compute | none | ended by SIGBUS |" in page
    assert "5,390,000,000 segments take 7.9 ms by compute; the goal is 8 ms" in page
    assert "1. feature, the 2th\n2. feature, the 10th\n" in page
    assert "All work." in page
    shown = np.asarray(Image.open(io.BytesIO((tmp_path / "card-a-card.png").read_bytes())))
    assert shown.shape == (270, 4 * 480, 3)
    assert (shown[:, :480] == 200).all()
    assert (shown[:, 480:960] == 50).all()
    assert (shown[:, 960:] == 0).all()


def test_a_run_that_was_cut_short_goes_on_where_it_ended(card, tmp_path, monkeypatch):
    """Cells that were measured, or died, are not tried again; those for which there was no time are."""
    cells = [{"kind": "tubes", "set": name, "size": [64, 48]} for name in ("a", "b", "c")]
    monkeypatch.setattr(card, "sections", lambda *_: [("others", cells)])
    monkeypatch.setattr(card, "checked", lambda _: {**card.machine(), "pipelines": [], "check_text": "All work."})
    tried = []

    def measured(cell, *_):
        tried.append(cell["set"])
        if cell["set"] == "b":
            options.total = -1.0
            monkeypatch.setattr(card.time, "monotonic", lambda: float("inf"))
            return {"unmeasured": "ended by SIGBUS"}
        return {"ms": 1.0}

    monkeypatch.setattr(card, "measured", measured)
    options = SimpleNamespace(folder=tmp_path, output=tmp_path, step=0.1, total=100.0, resume=True)
    card.measure_all(options, tmp_path)
    monkeypatch.setattr(card.time, "monotonic", lambda: 0.0)
    options.total = 100.0
    card.measure_all(options, tmp_path)
    assert tried == ["a", "b", "c"]
    (path,) = tmp_path.glob("card-*.json")
    rows = json.loads(path.read_text())["results"]
    assert [row.get("ms", row.get("unmeasured")) for row in rows] == [1.0, "ended by SIGBUS", 1.0]


def test_what_a_process_dies_of_is_a_row_and_the_next_cell_has_another(card, tmp_path):
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
    drawer = card.Drawer(str(script), tmp_path)
    rows = [drawer.draw({"wanted": one}, 5.0) for one in ("", "", "die", "", "crash", "")]
    rows += [drawer.draw({"wanted": "sleep"}, 0.5), drawer.draw({"wanted": ""}, 5.0)]
    drawer.close()
    assert rows == [
        {"number": 0}, {"number": 1}, {"unmeasured": "failed: no such card"}, {"number": 0},
        {"unmeasured": "failed: ended with -6"}, {"number": 0}, {"unmeasured": "takes more than 0.5 s here"},
        {"number": 0},
    ]  # fmt: skip


def test_data_that_cannot_be_made_is_a_row(card, tmp_path):
    target = tmp_path / "a file"
    target.write_text("")
    row = card.measured(BRAIN, target, tmp_path / "picture.npy", SimpleNamespace(small=True, limit=60.0), None)
    assert row["unmeasured"].startswith("its data was not made: ")


@pytest.mark.more
def test_a_bare_machine_draws_cells_without_what_users_have(tmp_path):
    """Libraries beside moderngl, NumPy and numba are named as missing, and a cell is drawn all the same."""
    missing = ("vtk", "vtkmodules", "pyvista", "matplotlib", "nibabel", "tqdm", "platformdirs", "PIL", "scipy")
    code = (
        f"import sys; sys.modules.update(dict.fromkeys({missing})); sys.path.insert(0, 'benchmarks')\n"
        "import json; from pathlib import Path; from card_cells import draw_cell\n"
        "print(json.dumps(draw_cell(json.loads(sys.argv[1]), Path(sys.argv[2]))))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, json.dumps(CELLS[0]), str(tmp_path)], cwd=ROOT, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1])["ms"] > 0.0


def test_the_script_names_what_a_bare_machine_lacks(tmp_path):
    python = tmp_path / "python"
    python.write_text("#!/bin/sh\necho moderngl numba\n")
    python.chmod(0o755)
    done = subprocess.run(
        [ROOT / "benchmarks/card.sh"], env={"PYTHON": str(python), "PATH": "/usr/bin:/bin"}, capture_output=True,
        text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 1
    assert done.stderr == f"missing: moderngl numba. Install them: {python} -m pip install moderngl numba\n"
