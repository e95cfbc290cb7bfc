"""Exports: into the served folder, or to be fetched, and where they are is said."""

import asyncio
import csv
import io
import re
import threading
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from aiohttp import web

import pvfiblets
from pvfiblets.formats import attachments
from pvfiblets.streamlines import Streamlines
from pvfiblets.web.panels import csv_tables
from pvfiblets.web.panels.csv_tables import profile_csv, selection_csv
from pvfiblets.web.panels.files import exporting
from pvfiblets.web.panels.files.exporting import ExportActions
from pvfiblets.web.panels.files.writing import EXPORTS, write
from pvfiblets.web.panels.tabs.selection_tab import SelectionActions
from pvfiblets.web.scene.files.loading import Cancelled
from tests.web.desk import Desk


@pytest.fixture
def desk(scene, folder):
    layer = scene.open("lines.fiblets")
    scene.selection.select(layer.id, [3, 4, 30])
    scene.filters.set_filter(layer.id, "length", 40.25)
    desk = Desk(scene, folder)
    desk.page.chosen = layer.id
    desk.exports = ExportActions(desk)
    yield desk
    desk.exports.close()


def export(desk, suffix, what="selected", to="folder"):
    """Export, and return the file that is offered then."""
    desk.page.export_what, desk.page.export_to = what, to

    async def test():
        desk.exports.export(suffix)
        await desk.done()

    asyncio.run(test())
    return fetched(desk)


def fetched(desk, url=None):
    """Return what a browser gets: path, and the name that it is given."""
    number = (url or desk.page.download["url"]).removeprefix("/download/")
    answer = asyncio.run(desk.exports.send(SimpleNamespace(match_info={"number": number})))
    return Path(answer._path), answer.headers["Content-Disposition"]


@pytest.mark.parametrize("suffix", EXPORTS)
def test_a_fetched_file_holds_the_streamlines_and_lies_in_no_served_folder(desk, folder, lines, suffix):
    before = sorted(folder.iterdir())
    path, shown = export(desk, suffix, to="computer")
    assert sorted(folder.iterdir()) == before
    assert shown == f'attachment; filename="lines_selected{suffix}"'
    found = pvfiblets.FibletSet.open(path).decompress() if suffix == ".fiblets" else pvfiblets.read(path)
    np.testing.assert_allclose(found.lengths(), lines.lengths()[[3, 4, 30]], atol=0.05)
    kind, said = desk.said[-1]
    assert kind == "success"
    assert f"3 streamlines ready for download as lines_selected{suffix}" in said
    desk.exports.close()
    assert not path.exists()


def test_the_served_folder_keeps_every_export_under_a_name_of_its_own(desk, folder):
    first, _ = export(desk, ".trk")
    second, _ = export(desk, ".trk")
    assert (first.name, second.name) == ("lines_selected.trk", "lines_selected_2.trk")
    assert first.parent == second.parent == folder
    assert "saved in the served folder as lines_selected_2.trk" in desk.said[-1][1]
    shown, _ = export(desk, ".tck", "shown")
    assert (shown.name, len(pvfiblets.read(shown))) == ("lines_shown.tck", 29)
    whole, _ = export(desk, ".tck", "all")
    assert (whole.name, len(pvfiblets.read(whole))) == ("lines.tck", 60)
    desk.exports.close()
    assert first.exists()


def test_old_files_cannot_be_fetched_and_take_no_space(desk):
    offered = []
    for _ in range(exporting.KEPT + 1):
        path, _ = export(desk, ".tck", to="computer")
        offered.append((path, desk.page.download["url"]))
    assert [path.exists() for path, _ in offered] == [False] + exporting.KEPT * [True]
    assert len({url for _, url in offered}) == exporting.KEPT + 1
    for number in (offered[0][1], "/download/..", "/download/"):
        with pytest.raises(web.HTTPNotFound):
            fetched(desk, number)


def test_what_is_too_large_to_fetch_is_not_kept(desk, monkeypatch):
    monkeypatch.setattr(exporting, "LARGEST", 1000)
    with pytest.raises(ValueError, match="save the file in the served folder"):
        export(desk, ".trk", to="computer")
    with pytest.raises(ValueError, match="too many to download"):
        export(desk, ".fiblets", to="computer")
    assert list(Path(desk.exports._folder.name).iterdir()) == []
    assert desk.page.download == {}
    assert export(desk, ".trk")[0].exists()


@pytest.mark.parametrize(
    ("suffix", "what", "to", "says"),
    [
        (".exe", "selected", "folder", "none of .trk"),
        (".trk", "everything", "folder", "choose one of selected"),
        (".trk", "selected", "../elsewhere", "none of folder"),
    ],
)
def test_other_requests_are_refused(desk, folder, suffix, what, to, says):
    before = sorted(folder.iterdir())
    with pytest.raises(ValueError, match=says):
        export(desk, suffix, what, to)
    assert sorted(folder.iterdir()) == before


def test_nothing_selected_or_no_tractogram_is_said(desk, scene):
    scene.selection.deselect()
    with pytest.raises(ValueError, match="nothing is selected"):
        export(desk, ".trk")
    desk.page.chosen = scene.open("ball.ply").id
    with pytest.raises(ValueError, match="choose a tractogram"):
        export(desk, ".trk", "all")


def test_files_are_written_beside_the_page(desk, monkeypatch):
    threads = []
    assert exporting.write is write
    monkeypatch.setattr(exporting, "write", lambda *a: threads.append(threading.current_thread()) or write(*a))
    export(desk, ".trx")
    assert threads[0] is not threading.main_thread()
    assert desk.page.job == {}


@pytest.mark.parametrize("to", ["folder", "computer"])
@pytest.mark.parametrize("suffix", EXPORTS)
async def test_a_cancelled_export_leaves_nothing(desk, folder, monkeypatch, suffix, to):
    before = sorted(folder.iterdir())
    jobs = []

    def cancelled(fiblets, ids, target, progress, cancel, original):
        desk.files.cancel()  # as from the page while the file is written
        jobs.append(dict(desk.page.job))
        return write(fiblets, ids, target, progress, cancel, original)

    monkeypatch.setattr(exporting, "write", cancelled)
    desk.page.export_what, desk.page.export_to = "shown", to
    desk.exports.export(suffix)
    await desk.done()
    assert jobs == [{"text": f"lines_shown{suffix}: stopping", "share": -1.0, "cancellable": False, "then": ""}]
    assert desk.said == [("info", f"lines_shown{suffix} was not written: cancelled.")]
    assert (desk.page.download, desk.page.job) == ({}, {})
    assert sorted(folder.iterdir()) == before
    if to == "computer":
        assert list(Path(desk.exports._folder.name).iterdir()) == []


@pytest.mark.few(3)
@pytest.mark.parametrize("suffix", EXPORTS)
def test_whenever_writing_is_stopped_no_file_is_left(desk, tmp_path, suffix):
    home = tmp_path / "apart"
    home.mkdir()
    fiblets, ids = desk.scene.selection.chosen(desk.page.chosen, "shown")
    asked = []
    write(fiblets, ids, home / f"whole{suffix}", None, lambda: asked.append(1))
    (whole,) = home.iterdir()
    size = whole.stat().st_size
    whole.unlink()
    assert len(asked) >= 3
    for last in range(len(asked)):
        answers = iter([False] * last + [True])
        with pytest.raises(Cancelled):
            write(fiblets, ids, home / f"part{suffix}", None, lambda answers=answers: next(answers))
        assert list(home.iterdir()) == []
    assert write(fiblets, ids, home / f"again{suffix}")["bytes"] == size


@pytest.mark.parametrize("suffix", [".trk", ".fiblets"])
def test_an_export_says_how_far_its_points_are_from_those_of_the_source(desk, lines, suffix):
    path, _ = export(desk, suffix)
    found = pvfiblets.FibletSet.open(path).decompress() if suffix == ".fiblets" else pvfiblets.read(path)
    said = re.search(r"points are coded, within ([\d.e-]+) mm of the source's", desk.said[-1][1])
    assert said is not None
    farthest = 0.0
    for mine, true in zip(found, [lines[i] for i in (3, 4, 30)], strict=True):
        starts, ends = np.asarray(true[:-1], float), np.asarray(true[1:], float)
        along = ends - starts
        for point in np.asarray(mine, float):  # to the nearest place on the source's poly-line
            share = np.clip(((point - starts) * along).sum(1) / (along**2).sum(1), 0, 1)
            farthest = max(farthest, np.linalg.norm(starts + share[:, None] * along - point, axis=1).min())
    assert 0 < farthest <= 1.005 * float(said[1])  # which is rounded to three digits


@pytest.fixture
def many(scene, folder):
    """Return a desk with a tractogram that is coded with loss, its points, and values of another file."""
    rng = np.random.default_rng(5)
    steps = rng.normal(size=(200, 400, 3)) * 0.05 + (0.5, 0, 0)
    walks = Streamlines.from_list(list(np.cumsum(steps, axis=1).astype(np.float32)))
    walks.per_streamline["weight"] = np.arange(200, dtype=np.float32)
    pvfiblets.write(folder / "walks.trk", walks)
    walks = pvfiblets.read(folder / "walks.trk")
    walks.per_point["odd"] = rng.random(walks.n_points).astype(np.float32)
    attachments.write_scalars(folder / "odd.tsf", walks, "odd")
    layer = scene.open("walks.trk")
    assert scene.actor(layer.id).fiblets.exact is None
    scene.selection.select(layer.id, [7, 8, 150])
    desk = Desk(scene, folder)
    desk.page.chosen = layer.id
    desk.exports = ExportActions(desk)
    yield desk, walks
    desk.exports.close()


@pytest.mark.parametrize("suffix", [".trk", ".tck", ".trx", ".vtp", ".vtk"])
def test_points_are_those_of_the_source_where_it_is_there(many, suffix):
    desk, walks = many
    path, _ = export(desk, suffix)
    found = pvfiblets.read(path)
    true = walks[[7, 8, 150]]
    np.testing.assert_allclose(found.points, true.points, rtol=0, atol=2e-5)  # trk and tck store them in other units
    if found.per_streamline:
        np.testing.assert_array_equal(found.per_streamline["weight"].ravel(), [7, 8, 150])
    assert "points are exactly the source's" in desk.said[-1][1]


def test_a_part_of_a_part_is_that_of_the_source(many):
    desk, walks = many
    scene = desk.scene
    part = scene.keep_selection(desk.page.chosen)
    scene.selection.select(part.id, [1, 2])
    desk.page.chosen = part.id
    path, _ = export(desk, ".trx")
    np.testing.assert_array_equal(pvfiblets.read(path).points, walks[[8, 150]].points)


def test_values_of_other_files_go_with_the_points_of_the_source(many, folder):
    desk, walks = many
    scene = desk.scene
    scene.attach(desk.page.chosen, scene.load_values(desk.page.chosen, "odd.tsf"))
    path, _ = export(desk, ".trx")
    found = pvfiblets.read(path)
    numbers = np.concatenate([np.arange(walks.offsets[i], walks.offsets[i + 1]) for i in (7, 8, 150)])
    np.testing.assert_array_equal(found.per_point["odd"].ravel(), walks.per_point["odd"][numbers])


@pytest.mark.parametrize("change", ["gone", "other"])
def test_a_replaced_source_is_reported_and_not_read(many, folder, change):
    desk, walks = many
    if change == "gone":
        (folder / "walks.trk").unlink()
    else:
        pvfiblets.write(folder / "walks.trk", walks[:151])
    path, _ = export(desk, ".trk")
    said = desk.said[-1][1]
    assert ("walks.trk is not there any more" if change == "gone" else "walks.trk has changed since") in said
    error = float(re.search(r"within ([\d.e-]+) mm", said)[1])
    assert 0 < np.abs(pvfiblets.read(path).points - walks[[7, 8, 150]].points).max() < 3 * error


def test_opening_an_export_again_does_not_code_it_twice(scene, folder, many):
    """Of coded points: those of a ``.fiblets`` file have no others."""
    desk, walks = many
    pvfiblets.compress(walks).save(folder / "coded.fiblets")
    layer = scene.open("coded.fiblets")
    desk.page.chosen = layer.id
    path, _ = export(desk, ".trk", "all")
    assert "points are coded, within" in desk.said[-1][1]
    coded = scene.actor(layer.id).fiblets.decompress().points
    again = scene.open(path.name)
    np.testing.assert_array_equal(scene.actor(again.id).fiblets.decompress().points, coded)
    scene.remove(again.id)
    pvfiblets.write(path, walks[1:])  # another file of that name is coded as any other
    other = scene.open(path.name)
    assert scene.actor(other.id).fiblets.n_streamlines == 199


@pytest.mark.parametrize(
    ("given", "file", "header"),
    [
        ("arcuate left", "arcuate left.tck", 'attachment; filename="arcuate left.tck"'),
        ("arcuate.trk", "arcuate.tck", 'attachment; filename="arcuate.tck"'),
        ("faisceau arqué", "faisceau arqué.tck",
         "attachment; filename=\"faisceau arqu_.tck\"; filename*=UTF-8''faisceau%20arqu%C3%A9.tck"),
    ],
)  # fmt: skip
def test_an_export_has_the_name_that_it_is_given(desk, folder, given, file, header):
    desk.page.export_name = given
    path, shown = export(desk, ".tck")
    assert (path.name, shown) == (file, header)
    path, _ = export(desk, ".tck")
    assert path.name == file.replace(".tck", "_2.tck")


@pytest.mark.parametrize("given", ["../up", "a/b", ".hidden", "CON", "x" * 300, "a\u202eb", "a\nb", 'a"b'])
def test_names_that_no_file_should_have_are_refused(desk, folder, given):
    before = sorted(folder.iterdir())
    desk.page.export_name = given
    with pytest.raises(ValueError, match="file's name"):
        export(desk, ".tck")
    assert sorted(folder.iterdir()) == before


def rows(text):
    return list(csv.DictReader(io.StringIO(text, newline="")))


def test_the_table_has_every_selected_streamline_in_full(scene, folder, lines, monkeypatch):
    monkeypatch.setattr(csv_tables, "PIECE", 4)
    layer = scene.open("lines.fiblets")
    scene.rename(layer.id, 'tracts, "all"')
    scene.set(layer.id, "scalars", "fa")
    with pytest.raises(ValueError, match="nothing is selected"):
        selection_csv(scene)
    chosen = [1, 2, 3, 29, 30, 40, 59]
    scene.selection.select(layer.id, chosen)
    found = rows(selection_csv(scene))
    assert [int(row["streamline"]) for row in found] == chosen
    assert {row["layer"] for row in found} == {'tracts, "all"'}
    assert [row["groups"] for row in found] == 4 * ["near"] + 3 * ["far"]
    np.testing.assert_allclose([float(row["length_mm"]) for row in found], lines.lengths()[chosen], rtol=1e-4)
    assert {row["value_of"] for row in found} == {"mean of fa"}
    np.testing.assert_allclose([float(row["value"]) for row in found], 0.5, atol=0.01)
    monkeypatch.setattr(csv_tables, "MOST_ROWS", 6)
    with pytest.raises(ValueError, match="7 streamlines are selected, and a table takes 6"):
        selection_csv(scene)


def test_the_profile_is_the_one_that_is_shown(scene, folder):
    layer = scene.open("lines.fiblets")
    desk = Desk(scene, folder)
    desk.selecting = SelectionActions(desk)
    scene.selection.select(layer.id, [3, 4])
    desk.selecting.set_profile("fa")
    found = rows(desk.selecting.profile_csv())
    assert list(found[0]) == ["share_of_length", "mean of fa", "standard deviation of fa"]
    along = [float(row["share_of_length"]) for row in found]
    np.testing.assert_allclose(along, np.linspace(0, 1, 100))
    np.testing.assert_allclose([float(row["mean of fa"]) for row in found], along, atol=0.01)
    desk.selecting.set_profile("curvature")
    assert "mean of curvature [1/mm]" in rows(desk.selecting.profile_csv())[0]


@pytest.mark.parametrize("name", ["=cmd|' /C calc'!A0", "+1+1", "-2", "@SUM(A1)", "\t=1"])
def test_names_are_no_formulas(scene, name):
    layer = scene.open("lines.fiblets")
    scene.become(type(scene.state)((__import__("dataclasses").replace(scene.layer(layer.id), name=name),)))
    scene.selection.select(layer.id, [3])
    (row,) = rows(selection_csv(scene))
    assert row["layer"] == f"'{name}"
    text = profile_csv({"position": [0.0], "mean": [-1.5], "std": [None]}, name)
    head, values = list(csv.reader(io.StringIO(text, newline="")))
    assert not any(cell.startswith(("=", "+", "-", "@", "\t")) for cell in head)
    assert values == ["0.0", "-1.5", ""]  # numbers are numbers
