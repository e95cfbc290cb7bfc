"""The study of a card's first minutes: its plan is run on very little, and what is left out or differs is told."""

import subprocess
from pathlib import Path

import pytest

from pvfiblets.engine.fiblets.pipelines.compute import CARD_FORMS
from pvfiblets.report import machine
from pvfiblets.report.process import CellProcess
from pvfiblets.report.record import CaseResult
from pvfiblets.report.studies.card import study as card
from pvfiblets.report.studies.card.findings import DIFFERS, MISSING, WORKS, Finding
from pvfiblets.report.studies.speed.cells import measure_cell
from pvfiblets.report.studies.speed.constants import replaced
from pvfiblets.report.study import Budget

from .little import little

ROOT = Path(__file__).parents[2]
CHANGING = "cl", "work", "calls", *CARD_FORMS
BRAIN = {"kind": "fiblets", "pipeline": "compute", "culling": "two-phase", "segments": 3e5, "step": 0.1, "view": "far",
         "size": [160, 90], "frames": 2, "limit": 0.1, "warm": 0.01}  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return str(tmp_path_factory.mktemp("brains"))


def found(*verdicts):
    """Stand in for the check of one part."""

    def findings(part, folder, process, patience=0.0):
        for verdict in verdicts:
            yield Finding(part, f"it {verdict}", verdict, "why", {"lost, radii": 0.5}, {"lost, radii": 0.25}), []

    return findings


@pytest.mark.more
def test_a_quick_plan_runs_and_saves_record_by_record(gl, monkeypatch, tmp_path):
    monkeypatch.setenv(card.BRAINS, str(tmp_path))
    monkeypatch.setattr(card, "QUICK_SEGMENTS", (2e4, 3e4))
    monkeypatch.setattr(card, "QUICK_CHANGED", (2e4,))
    monkeypatch.setattr(card, "QUICK_STRIPS", (1e4,))
    monkeypatch.setattr(card, "QUICK_SIZES", ((96, 72),))
    monkeypatch.setattr(card, "findings_of", found(WORKS, MISSING, DIFFERS))
    small = {"kind": "volume", "voxels": 16, "mode": "mip", "size": [96, 72]}
    feature = {**BRAIN, "kind": "feature", "feature": "cut sphere", "segments": 2e4, "size": [96, 72]}
    monkeypatch.setattr(card, "sections", lambda quick, pipelines: [[], [], [feature], [small]])
    left = []
    told = list(card.STUDY.run(little(left_out=left)))
    cases = [one for one in told if isinstance(one, CaseResult)]
    records = [one for one in told if not isinstance(one, CaseResult)]
    assert cases[0].system == "OpenGL"
    assert cases[0].held
    checked = [case for case in cases if case.note == "why"]
    assert {case.system for case in checked} >= {"fiblets compute", "fiblets geometry", "halos", "volumes"}
    assert [case.held for case in checked[:2]] == [True, False]
    assert checked[0].measured.unit == "radii"
    assert any(item.what == "fiblets compute: it missing" for item in left)
    alternatives = [record for record in records if record.data.startswith("0.02 M") and not record.default]
    alternatives = [record for record in alternatives if record.method == "compute"]
    refused = [item for item in left if "buffers are limited" in item.reason]
    assert len(alternatives) + len(refused) == len(card.alternatives(True))
    same = [case for case in cases if case.system == "compute"]
    assert len(same) == len(alternatives)
    assert all(case.held for case in same)
    rest = [record.method for record in records if record not in alternatives]
    assert sorted(rest) == ["compute", "compute", "compute", "cut sphere", "line strips", "volume"]
    for record in records:
        waited = record.method == "cut sphere"
        assert record.times.keys() == ({"draw"} if waited else {"draw", "in flight"})
    assert {"pass cull", "pass depth", "pass resolve_owner"} <= alternatives[-1].costs.keys()


def test_without_time_everything_is_left_out(gl, monkeypatch, tmp_path):
    monkeypatch.setenv(card.BRAINS, str(tmp_path))
    monkeypatch.setattr(card, "_Brains", lambda cells, folder: Absent())
    left = []
    told = list(card.STUDY.run(little(budget=Budget(0.0), left_out=left)))
    assert [one.system for one in told] == ["OpenGL"]
    assert sum(item.reason == "the time given was used up" for item in left) > 30


def test_while_data_is_made_other_things_are_checked(gl, monkeypatch, tmp_path):
    """Of a cell whose data comes late: nobody waits for it as long as there is a check to be made."""
    monkeypatch.setenv(card.BRAINS, str(tmp_path))
    order = []

    class Late(Absent):
        def has(self, cell):
            return "halos" in order

    def findings(part, folder, process, patience=0.0):
        order.append(part)
        yield Finding(part, "a feature", WORKS), []

    def measured(cell, process, hopeless, options):
        order.append(cell["kind"])

    monkeypatch.setattr(card, "_Brains", lambda cells, folder: Late())
    monkeypatch.setattr(card, "findings_of", findings)
    monkeypatch.setattr(card, "measured", measured)
    monkeypatch.setattr(card, "plan", lambda *_: [{"kind": "cell"}])
    list(card.STUDY.run(little()))
    assert order.index("fiblets compute") < order.index("halos") < order.index("cell") < order.index("features")


class Absent:
    """Data that never comes."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def has(self, cell):
        return False


def test_the_plan_is_in_the_order_of_value():
    cells = card.plan(False, "compute", [card.MESH_EXT, card.MESH])
    first = [(cell["segments"], cell["pipeline"], cell.get("but", "")) for cell in cells[:8]]
    assert first == [
        (60e6, "compute", ""),
        *((60e6, name, f", {form}") for form in (card.MESH_EXT, card.MESH) for name in ("mesh", "mesh-serial")),
        (434e6, "compute", ""), (1e9, "compute", ""), (5.4e9, "compute", ""),
    ]  # fmt: skip
    kinds = list(dict.fromkeys(cell["kind"] for cell in cells))
    assert kinds == ["fiblets", "line strips", "feature", "tubes", "halos", "volume"]
    assert all(cell["warm"] == card.WARM for cell in cells)
    assert {cell["segments"] for cell in cells if "but" in cell} == {60e6, *card.CHANGED}


@pytest.mark.more
@pytest.mark.parametrize("name", [name for name in card.alternatives(True) if name.startswith(CHANGING)])
def test_steps_done_otherwise_draw_the_same(gl, folder, name):
    """Of a set with clusters and classes, whose lists take several calls."""
    base = {**BRAIN, "folder": folder, "constants": {"fiblets.data.chunks:CLUSTERED": 0}}
    other = card.alternatives(True)[name]
    constants = {**base["constants"], **other["constants"]}
    if name.startswith("calls"):
        constants = {key: {"listed": 1 << 9} if isinstance(of, dict) else of for key, of in constants.items()}
    usual, changed = measure_cell(base), measure_cell({**base, **other, "constants": constants})
    assert usual["digest"] == changed["digest"]
    assert measure_cell({**base, "view": "close"})["digest"] != usual["digest"]


@pytest.mark.more
def test_clusters_are_made_once_for_cells_of_the_same_set(gl, folder, monkeypatch):
    from pvfiblets.engine.fiblets.data import clusters

    made, usual = [], clusters.cluster_words
    monkeypatch.setattr(clusters, "cluster_words", lambda *of: made.append(of[1:]) or usual(*of))
    base = {**BRAIN, "folder": folder, "segments": 1e5, "constants": {"fiblets.data.chunks:CLUSTERED": 0}}
    first, again = measure_cell(base), measure_cell(base)
    assert first["digest"] == again["digest"]
    assert len(made) == 1
    measure_cell({**base, "segments": 5e4})
    measure_cell(base)
    assert len(made) == 3


def test_constants_are_replaced_wherever_the_engine_holds_them_and_put_back():
    from pvfiblets.engine.fiblets.pipelines import compute, constants
    from pvfiblets.engine.gl import passes, work_limits

    with replaced({"gl.passes:GROUP_SIZE": 128, "gl.work_limits:DISCRETE": {"listed": 7}}):
        assert passes.GROUP_SIZE == compute.GROUP_SIZE == constants.CONSTANTS["group_size"] == 128
        assert work_limits.DISCRETE.listed == 7
        assert work_limits.DISCRETE.fiblets == 1 << 23
    assert passes.GROUP_SIZE == compute.GROUP_SIZE == constants.CONSTANTS["group_size"] == 64
    assert work_limits.DISCRETE.listed == 1 << 23


def test_the_state_of_a_card_is_read_where_it_is_told(monkeypatch):
    def told(answer):
        def run(command, **_):
            assert command[0] == "nvidia-smi"
            if answer is None:
                raise FileNotFoundError
            return subprocess.CompletedProcess(command, 0, answer)

        monkeypatch.setattr(machine.subprocess, "run", run)
        return machine.card_state()

    assert told(None) == {}
    assert told("1980, 2619, 312.5, 41, 0x0000000000000004\n") == {
        "clocks.sm": 1980.0, "clocks.mem": 2619.0, "power.draw": 312.5, "temperature.gpu": 41.0,
        "clocks_throttle_reasons.active": 4.0,
    }  # fmt: skip
    assert told("1980, [N/A], [N/A], 41, Not Active\n") == {"clocks.sm": 1980.0, "temperature.gpu": 41.0}


def test_the_script_gives_a_card_eight_minutes_unless_told_otherwise(tmp_path):
    python = tmp_path / "python"
    python.write_text('#!/bin/sh\nif [ "$1" = - ]; then cat >/dev/null; else echo "$@"; fi\n')
    python.chmod(0o755)
    done = subprocess.run(
        [ROOT / "scripts/card.sh", "--first", str(tmp_path / "out"), "--quick"], capture_output=True, text=True,
        env={"PYTHON": str(python), "PATH": "/usr/bin:/bin"}, check=True,
    )  # fmt: skip
    assert done.stdout == f"-m pvfiblets report --only card -o {tmp_path / 'out'} --minutes 8 --quick\n"


def test_a_refused_form_is_reported(gl, monkeypatch):
    """The pipeline falls back by itself: a record must not show one extension's time for another's."""
    cell = {**BRAIN, "pipeline": "mesh", "but": f", {card.MESH_EXT}"}
    row = {"passes": {}, "steady": True, "before": {}, "after": {"clocks.sm": 1980.0}, "in_flight": 0.1,
           "clock": "wall", "gpu": [0.1, 0.2], "digest": "", "seconds": [0.1], "gpu_bytes": 1,
           "first": 0.1}  # fmt: skip
    monkeypatch.setattr(CellProcess, "measure", lambda self, cell, seconds: row)
    monkeypatch.setattr("pvfiblets.report.studies.speed.study.stored_brain", lambda *_: None)
    for features, setting in ((["MESH_EXT"], ""), (["PER_PRIMITIVE"], f" refused, drawn by {card.MESH}")):
        row["features"] = features
        done = card.measured({**cell, "folder": ""}, CellProcess([]), set(), little())
        (record,) = card._completed(*done, cell, {})
        assert record.setting == f"culling two-phase, {card.MESH_EXT}{setting}"
        assert record.costs["clocks.sm"].value == 1980.0
        assert record.times["GPU"].median == pytest.approx(0.15)
