"""The benchmark of ambient occlusion by rays runs from one command, and what it measures by is right."""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from pvfiblets.engine.volumes.occlusion import LIFT
from pvfiblets.report.volume_openness import exact_openness, seen_from
from pvfiblets.volumes import RaycastVolume, reference

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture
def bench(monkeypatch):
    """Return the benchmark's module, which is in no package."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    yield importlib.import_module("volume_occlusion")
    for name in ("volume_occlusion", "orbit"):
        sys.modules.pop(name, None)


def test_one_command_tells_error_and_time(tmp_path):
    command = "benchmarks/volume_occlusion.py --sets vessels --voxels 48 --size 60 60 --many 1 256 --samples 4 64"
    whole = [sys.executable, *command.split(), "--pixels", "10", "--output", str(tmp_path)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg"}
    done = subprocess.run(whole, capture_output=True, text=True, check=False, cwd=ROOT, env=environment)
    assert done.returncode == 0, done.stderr
    (path,) = tmp_path.glob("volume-occlusion-*.json")
    assert path.with_suffix(".png").stat().st_size > 0
    rows = json.loads(path.read_text())["results"][1:]
    few, fewer_smooth, many, _ = rows
    assert [(row["samples"], row["smooth"]) for row in rows] == [(4, False), (4, True), (64, False), (64, True)]
    assert fewer_smooth["rms"] < few["rms"]
    assert many["rms"] < 0.5 * few["rms"]
    assert few["rms_by_chance"] == pytest.approx(4.0 * many["rms_by_chance"])
    for row in rows:
        assert row["ms_spread"][0] <= row["ms"] <= row["ms_spread"][1]
        assert row["mean"] <= row["rms"] <= row["max"]
    table = path.with_suffix(".md").read_text()
    assert table.count("| vessels |") == 5
    assert f"| {many['rms']:.4f} |" in table


def test_the_reference_is_that_of_a_ball():
    """Chords in a ball of radius r, from a little off its wall, that are shorter than R."""
    x = np.arange(33) - 16.0
    field = np.sqrt(x[:, None, None] ** 2 + x[:, None] ** 2 + x**2).astype(np.float32)
    affine = np.eye(4)
    affine[:3, 3] = -16.0
    volume = RaycastVolume(field, affine)
    matrix = seen_from(volume, (8, 8), (0.3, -1.0, 0.2))
    ways = np.random.default_rng(0).normal(size=(6, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    through = reference.Rays(np.zeros((6, 3)), ways, np.zeros(6), np.full(6, 16.0), matrix)
    hits = reference.isosurface(volume, 12.0, through)
    found = exact_openness(volume, 12.0, through, hits.gradient, hits.t, 9.0)
    start = 12.0 - LIFT
    least = (9.0**2 - 12.0**2 + start**2) / (2 * 9.0 * start)
    assert found == pytest.approx(1.0 - least**2, abs=0.01)


def test_errors_are_told_as_parts_of_one(bench):
    off = np.array([0.0, 0.0, 0.0, 0.4])
    assert bench.errors(off) == pytest.approx({"mean": 0.1, "rms": 0.2, "p99": 0.388, "max": 0.4})
