"""``pvfiblets gl --check``: what it finds on this driver, and that it finds faults, crashes and silence."""

import io
import json
import re
import subprocess
import sys
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from pvfiblets.cli.command import main
from pvfiblets.report.studies.card import check as card_check
from pvfiblets.report.studies.card import fiblets as card_fiblets
from pvfiblets.report.studies.card import report_file as card_file
from pvfiblets.report.studies.card.counts import counted
from pvfiblets.report.studies.card.findings import DIFFERS, DRAWN, FAILS, MISSING, SLOW, WORKS, Finding, table, totals
from pvfiblets.report.studies.card.lines import LineSamples, Shown
from pvfiblets.report.studies.card.scenes import tried
from pvfiblets.report.studies.culling.pictures import views
from tests.engine.cells import clear_of, line_samples

SIZE = (96, 72)


@pytest.fixture(scope="module")
def polylines():
    """Smooth lines in a box of 60 mm."""
    rng = np.random.default_rng(3)
    t = np.linspace(-25.0, 25.0, 60)[:, None]
    a, b, c = rng.normal(size=(3, 25, 3))
    return [t * x / np.linalg.norm(x) + 0.004 * t**2 * y + 3 * z for x, y, z in zip(a, b, c, strict=True)]


def camera(lines):
    box = np.stack([np.concatenate(lines).min(0), np.concatenate(lines).max(0)], 1)
    return views(box.ravel(), "far", 3.0, 1, SIZE)[0].model_view_projection


def right_picture(samples):
    """The nearest sample of each pixel."""
    order = np.lexsort((samples.depth, samples.cell))
    cell, first = np.unique(samples.cell[order], return_index=True)
    of = order[first]
    shape = SIZE[::-1]
    fields = [np.zeros(shape, bool), np.ones(shape), np.zeros(shape, np.int64), np.zeros((*shape, 3)), np.zeros(shape)]
    at = np.unravel_index(cell, shape)
    for field, values in zip(
        fields, (True, samples.depth[of], samples.streamline[of], samples.direction[of], samples.value[of]), strict=True
    ):
        field[at] = values
    return Shown(*fields)


@pytest.fixture(scope="module")
def sampled(polylines):
    values = [np.arange(len(line), dtype=float) for line in polylines]
    return LineSamples.from_lines(polylines, values, camera(polylines), SIZE)


def test_each_fault_of_a_picture_of_lines_is_found_and_none_in_a_right_one(sampled):
    wrong = sampled.wrong(right_picture(sampled), values=True)
    assert {name: int(mask.sum()) for name, mask in wrong.items()} == dict.fromkeys(wrong, 0)
    picture = right_picture(sampled)
    drawn = picture.there.sum()
    half = np.indices(picture.there.shape).sum(0) % 16 < 8
    faults = {
        "lost": picture._replace(there=picture.there & half),
        "line": picture._replace(streamline=np.where(half, picture.streamline, (picture.streamline + 7) % 25)),
        "direction": picture._replace(direction=np.where(half[..., None], picture.direction, [[[0.0, 0.0, 1.0]]])),
        "value": picture._replace(value=np.where(half, picture.value, picture.value + 12.0)),
    }
    for name, faulty in faults.items():
        wrong = sampled.wrong(faulty, values=True)
        assert wrong[name].sum() > 0.05 * drawn, name
    nearer = picture._replace(depth=picture.depth - 0.05)
    assert sampled.wrong(nearer)["line"].sum() > 0.8 * drawn


def test_samples_lie_where_float64_projects_them(polylines, sampled):
    """Of both ends and the middle of every segment, by the projection alone."""
    matrix = camera(polylines)
    cells = set(sampled.cell.tolist())
    for line in polylines:
        for points in (line, (line[1:] + line[:-1]) / 2.0):
            clip = np.c_[points, np.ones(len(points))] @ matrix.T
            x, y = ((clip[:, axis] / clip[:, 3] + 1.0) / 2.0 * SIZE[axis] for axis in (0, 1))
            away = np.minimum.reduce([x % 1.0, 1.0 - x % 1.0, y % 1.0, 1.0 - y % 1.0])
            for column, row in np.stack([x, y], 1)[away > 0.3].astype(int):
                assert int(row * SIZE[0] + column) in cells


def test_lines_are_counted_by_the_rule(polylines):
    matrix = camera(polylines)
    samples, doubtful = line_samples(polylines, matrix, SIZE)
    rows = np.concatenate(samples)
    expected = np.zeros(SIZE[::-1])
    np.add.at(expected, (rows[:, 1].astype(int), rows[:, 0].astype(int)), 1)
    clear = clear_of(doubtful, SIZE)
    assert clear.mean() > 0.5
    assert (counted(polylines, matrix, SIZE) == expected)[clear].all()
    with pytest.raises(ValueError, match="a point lies outside the view volume"):
        counted([polylines[0] * 100.0], matrix, SIZE)


@pytest.mark.more
def test_lines_that_are_not_where_they_should_be_differ(gl, monkeypatch):
    """The whole way, with a reference that is a millimetre aside."""
    about = card_fiblets.brain()
    moved = about._replace(lines=[line + [1.0, 0.0, 0.0] for line in about.lines])
    monkeypatch.setattr(card_fiblets, "brain", lambda: moved)
    scenes = dict(card_fiblets.fiblets_part(gl, "geometry"))
    finding, pictures = tried(gl, "fiblets geometry", "thin lines", scenes["thin lines, culling none"])
    assert finding.verdict == DIFFERS
    assert set(pictures) == {"drawn", "wrong"}
    assert "line " in finding.words
    monkeypatch.setattr(card_fiblets, "brain", lambda: about)
    finding, pictures = tried(gl, "fiblets geometry", "thin lines", scenes["thin lines, culling none"])
    assert (finding.verdict, dict(pictures)) == (WORKS, {})


CHILD = """
import json, os, signal, sys, time
features = ["a", "dies", "b", "hangs", "c", "raises"]
for line in sys.stdin:
    wanted = json.loads(line)
    name = wanted.get("feature")
    print("a driver's own words")
    if name is None:
        print(json.dumps({"feature": (features + [""])[wanted["number"]]}), flush=True)
        continue
    if name == "dies":
        os.kill(os.getpid(), signal.SIGSEGV)
    if name == "hangs":
        time.sleep(600)
    if name == "raises":
        print("cannot go on", file=sys.stderr)
        sys.exit(7)
    told = {"part": "halos", "feature": name, "verdict": "works"}
    print(json.dumps({"finding": told, "pictures": []}), flush=True)
"""


def test_a_driver_that_dies_or_hangs_takes_one_feature_along(tmp_path):
    found = card_check.run_check(
        tmp_path, (), lambda _: None, ["halos"], 5.0, command=[sys.executable, "-c", CHILD.replace("600", "60")]
    )
    told = [(one.feature, one.verdict, one.note) for one in found.findings if one.part == "halos"]
    assert told == [
        ("a", WORKS, ""),
        ("dies", FAILS, "ended by SIGSEGV"),
        ("b", WORKS, ""),
        ("hangs", FAILS, "takes more than 5 s here"),
        ("c", WORKS, ""),
        ("raises", FAILS, "ended with 7: cannot go on"),
    ]
    assert not found.good


@pytest.mark.parametrize(("extensions", "verdict"), [([], MISSING), (sorted(card_check.COMPUTES), FAILS)])
def test_a_check_without_the_compute_pipeline_fails_where_the_driver_has_it(
    tmp_path, monkeypatch, extensions, verdict
):
    """A context of an old version: on a card of today nothing that matters would have been checked."""
    rows = [
        {"name": "compute", "available": False, "why_not": "OpenGL is 3.3, needed is 4.3"},
        {"name": "mesh", "available": False, "why_not": "OpenGL is 3.3, needed is 4.5"},
    ]
    monkeypatch.setattr(card_check, "_ask", lambda patience: {"pipelines": rows, "extensions": extensions})
    found = card_check.run_check(tmp_path, (), lambda _: None, ["nothing else"])
    assert [one.verdict for one in found.findings] == [verdict, MISSING]
    assert found.findings[0].note.startswith("OpenGL is 3.3, needed is 4.3")
    assert found.good == (verdict == MISSING)


def test_no_opengl_is_one_finding(tmp_path, monkeypatch):
    monkeypatch.setenv("GLCONTEXT_LINUX_LIBEGL", "libnothing.so")
    monkeypatch.setenv("GLCONTEXT_LINUX_LIBGL", "libnothing.so")
    found = card_check.run_check(tmp_path, (), lambda _: None)
    (one,) = found.findings
    assert (one.part, one.verdict) == ("OpenGL", FAILS)
    assert one.note.startswith("no OpenGL 3.2 or later could be started")
    assert "1 of 1 things differ or fail: OpenGL" in card_file.summary(found)


def test_the_file_holds_table_facts_pictures_and_counts(tmp_path):
    picture = np.random.default_rng(0).integers(0, 256, (5, 7, 3)).astype(np.uint8)
    np.save(tmp_path / "one.npy", picture)
    np.save(tmp_path / "two.npy", picture[..., 0] > 99)
    figures, limits = {"x": 0.02, "y, mm": 3.0}, {"x": 0.01, "y, mm": 1.0}
    one = Finding("halos", "lines", DIFFERS, figures=figures, limits=limits, ms=3.21)
    other = replace(one, feature="points", verdict=MISSING, note="no points", limits={})
    check = card_check.CardCheck({"renderer": "A card", "driver": "1.0"}, [one, other])
    check.pictures["halos: lines"] = [tmp_path / "one.npy", tmp_path / "two.npy"]
    card_file.write(check, tmp_path / "check.zip")
    with zipfile.ZipFile(tmp_path / "check.zip") as archive:
        assert archive.testzip() is None
        shown = np.asarray(Image.open(io.BytesIO(archive.read("one.png"))))
        mask = np.asarray(Image.open(io.BytesIO(archive.read("two.png"))))
        told = json.loads(archive.read("check.json"))
        text = archive.read("check.txt").decode()
    np.testing.assert_array_equal(shown[::-1], picture)
    np.testing.assert_array_equal(mask[::-1, :, 1], np.where(picture[..., 0] > 99, 255, 0))
    assert [Finding(**row) for row in told["findings"]] == [one, other]
    assert "y 3 mm (at most 1 mm); x 2 % (at most 1 %)" in text
    assert "1 of 2 things differ or fail: halos: lines." in text
    assert table([one, other]) in text
    found = [Finding("a part", str(number), verdict) for number, verdict in enumerate((WORKS, DRAWN, DRAWN, SLOW))]
    assert totals(found) == "1 works, 2 were drawn and not compared, 1 works slowly"
    assert totals([*found[:1] * 12, replace(found[0], verdict=MISSING)]) == "12 work, 1 is missing in this OpenGL"


@pytest.mark.more
def test_the_command_checks_this_driver(gl, tmp_path, capfd):
    target = tmp_path / "check.zip"
    assert main(["gl", "--check", "--only", "halos", "--segments", "-o", str(target)]) == 0
    text = capfd.readouterr().out
    assert gl.info["GL_RENDERER"] in text
    for name in ("lines", "tapered ends", "bent halos", "points"):
        assert any(line.startswith("halos") and f" {name} " in line and WORKS in line for line in text.splitlines())
    assert re.search(r"\n4 work(, \d are missing in this OpenGL)?; nothing differs or fails\.\n", text)
    assert zipfile.is_zipfile(target)


@pytest.mark.more
@pytest.mark.parametrize(
    "part",
    [
        "spline tubes",
        *(pytest.param(part, marks=pytest.mark.exhaustive) for part in ("fiblets compute", "volumes", "features")),
    ],
)
def test_a_part_works_and_needs_no_vtk(gl, tmp_path, part):
    assert gl.info
    code = (
        "import json, sys\n"
        "sys.modules.update(dict.fromkeys(('vtk', 'vtkmodules', 'pyvista', 'matplotlib', 'nibabel', 'tqdm')))\n"
        "from pvfiblets.report.studies.card.part import Trial\n"
        "trial, number = Trial(), 0\n"
        "while feature := trial({'part': sys.argv[1], 'folder': sys.argv[2], 'number': number})['feature']:\n"
        "    print(json.dumps(trial({'feature': feature})))\n"
        "    number += 1"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, part, str(tmp_path)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    rows = [json.loads(line) for line in done.stdout.splitlines() if line.startswith('{"finding"')]
    assert len(rows) >= 7
    verdict = DRAWN if part == "features" else WORKS
    assert {row["finding"]["verdict"] for row in rows} == {verdict}, [row for row in rows if row["pictures"]]


def test_speed_is_measured_on_brains_of_a_size(gl, tmp_path):
    from pvfiblets.report.studies.card.speed import make_brains, named, speed_part

    make_brains((2e4, 5e4), tmp_path)
    found = [tried(gl, "speed compute", name, make)[0] for name, make in speed_part(gl, "compute", tmp_path)]
    assert [one.feature for one in found] == [named(2e4), named(5e4)]
    assert all(one.verdict == WORKS and one.ms > 0.0 for one in found)
    rate = found[1].figures["M segments a second"]
    assert rate * found[1].ms == pytest.approx(50.0, rel=0.3)
