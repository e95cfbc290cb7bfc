"""``benchmarks/card.py``: each of its cells draws, and its page tells what there is and what there is not."""

from __future__ import annotations

import io
import subprocess
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


def test_a_cell_that_cannot_be_drawn_says_why(card, folder):
    row = card.draw_cell({**CELLS[0], "pipeline": "mesh", "culling": "none"}, folder)
    assert "frames" in row or "GL_EXT_mesh_shader" in row["unmeasured"]


def test_sections_name_every_pipeline_size_and_culling(card):
    options = SimpleNamespace(small=False, step=0.1, segments=[1e6, 5.4e9])
    found = dict(card.sections(options, ["compute", "mesh"]))
    assert list(found) == list(card.TITLES)
    table = found["table 2"]
    assert len(table) == 2 * 2 * 2 * 3
    assert {tuple(row["size"]) for row in table} == {(1920, 1080), (3840, 2160)}
    assert {row["segments"] for row in found["figures"]} == {60e6}
    assert {row["kind"] for row in found["others"]} == {"tubes", "halos", "volume"}


def test_the_page_tells_times_and_what_is_unmeasured(card, tmp_path):
    about = {"card": "A card (of some kind)", "driver": "4.6", "system": "Linux", "cores": 4, "date": "2026-01-01",
             "check_text": "All work."}  # fmt: skip
    row = {"section": "table 2", "kind": "fiblets", "size": [1920, 1080], "pipeline": "compute", "segments": 5.39e9,
           "asked_segments": 5.4e9}  # fmt: skip
    results = [
        {**row, "culling": "two-phase", "ms": 7.891},
        {**row, "culling": "none", "unmeasured": "ended by SIGBUS"},
    ]
    picture = np.zeros((270, 480, 3), np.uint8)
    picture[:135] = 200
    np.save(tmp_path / "others-1.npy", picture)
    card.write(about, results, card.sheet(tmp_path), tmp_path)
    page = (tmp_path / "card-a-card.md").read_text()
    assert "| compute | two-phase | 7.89 |" in page
    assert "| compute | none | ended by SIGBUS |" in page
    assert "5,390,000,000 segments take 7.9 ms by compute; the goal is 8 ms" in page
    assert "All work." in page
    shown = np.asarray(Image.open(io.BytesIO((tmp_path / "card-a-card.png").read_bytes())))
    assert shown.shape == (270, 4 * 480, 3)
    assert (shown[:135, :480] == 0).all()
    assert (shown[135:, :480] == 200).all()


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
