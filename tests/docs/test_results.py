"""The frames, memory and load times on the page of results are the figures of the records that it links."""

import json
import re
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "benchmarks"
PAGE = (FOLDER / "README.md").read_text(encoding="utf-8")
WAYS = ("polylines", "polylines-aliased", "tubes", "fiblets")


def rows(title):
    """Return the cells of the table whose first column has a title."""
    table = PAGE[PAGE.index(f"| {title}") :].split("\n\n", 1)[0]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()[2:]]


def figures(text):
    return [float(number.replace(",", "")) for number in re.findall(r"\d[\d,]*\.?\d*", text)]


@pytest.fixture(scope="module")
def lines():
    results = json.loads((FOLDER / "lines-llvmpipe.json").read_text())["results"]
    return {(one["way"], one["segments"]): one for one in results}


def test_frames_in_software_are_those_of_the_record(lines):
    table = rows("segments | VTK lines, as `add_mesh` draws them")
    assert len(table) == 5
    for cells in table:
        segments = int(figures(cells[0])[0])
        for way, cell in zip(WAYS, cells[1:], strict=True):
            recorded = lines.get((way, segments))
            assert (recorded is None) == (cell == "")
            if recorded is not None:
                assert figures(cell) == [pytest.approx(1000.0 / recorded["ms_per_frame"], rel=0.03)]


def test_frames_on_the_card_are_those_of_the_record():
    results = json.loads((FOLDER / "card-nvidia-h100-80gb-hbm3.json").read_text())["results"]
    drawn = [one for one in results if one.get("pipeline") == "compute" and one.get("culling") == "two-phase"]
    times = [one["ms"] for one in drawn if one.get("size") == [1920, 1080] and one.get("ms")]
    for cells in rows("segments | ms a frame")[:4]:
        (ms,), (rate,) = figures(cells[1]), figures(cells[2])
        assert any(ms == pytest.approx(one, abs=0.06) for one in times)
        assert rate == pytest.approx(1000.0 / ms, rel=0.02)


def test_memory_and_load_times_are_those_of_the_record(lines):
    table = {cells[0]: cells[1:] for cells in rows("| fiblets | VTK lines")}
    ten = {way: lines[way, 10_038_457] for way in ("fiblets", "polylines", "polylines-aliased")}
    gpu = [ten[way]["gpu_bytes_per_point"] for way in ("fiblets", "polylines")]
    memory = [ten[way]["peak_memory_bytes"] / 1e6 for way in ("fiblets", "polylines", "polylines-aliased")]
    load = [ten[way]["load_seconds"] for way in ("fiblets", "polylines", "polylines-aliased")]
    for name, recorded in (
        ("GPU bytes a point", gpu),
        ("process memory at 10 million segments, MB", memory),
        ("load 10 million segments, s", load),
    ):
        written = [number for cell in table[name] for number in figures(cell)]
        assert written == [pytest.approx(one, rel=0.03) for one in recorded]
