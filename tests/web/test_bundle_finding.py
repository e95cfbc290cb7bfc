"""Bundles that are found on the page: more like this, clusters, models."""

import asyncio
import threading

import numpy as np
import pytest

import pvfiblets
from pvfiblets import Streamlines
from pvfiblets.query.bundles import clusters as clustering
from pvfiblets.web.panels.tabs import bundle_finding
from tests.web.desk import Desk


@pytest.fixture
def desk(scene, folder):
    made = Desk(scene, folder)
    made.choose(scene.open("lines.fiblets"))
    return made


def names(desk):
    return [one.name for one in desk.scene.bundles.of_layer(desk.page.chosen)]


def selected(desk):
    return desk.scene.layer(desk.page.chosen).selected.array().tolist()


def near(lines, like, distance):
    """Streamlines within a distance, mm, of some others: of twelve points each, by NumPy."""
    few = []
    for line in lines.to_list():
        arc = np.linalg.norm(line - line[0], axis=1)  # they are straight
        few.append([[np.interp(t, arc, line[:, k]) for k in range(3)] for t in np.linspace(0, arc[-1], 12)])
    few = np.array(few)
    apart = [
        min(np.linalg.norm(one - few[k], axis=1).mean() for k in like for one in (line, line[::-1])) for line in few
    ]
    return np.flatnonzero(np.array(apart) <= distance).tolist()


def test_more_like_this_selects_what_runs_near(desk, lines):
    layer = desk.page.chosen
    desk.scene.selection.select(layer, [14])
    desk.run(lambda: desk.finding.similar("6,5"))
    wanted = near(lines, [14], 6.5)
    assert 1 < len(wanted) < 20
    assert selected(desk) == wanted
    assert "within 6.5 mm of 1" in desk.said[-1][1]
    # Another distance asks about the same one, not about what was found.
    desk.run(lambda: desk.finding.similar("9"))
    assert selected(desk) == near(lines, [14], 9.0)
    assert desk.history.undo() == "select"
    assert selected(desk) == wanted
    # What somebody else selected is asked about as it is.
    desk.scene.selection.select(layer, [1, 50])
    desk.run(lambda: desk.finding.similar("5"))
    assert selected(desk) == near(lines, [1, 50], 5.0)
    # Without a selection, chosen bundles are.
    desk.scene.selection.deselect()
    desk.bundles.check("near", True)
    desk.run(lambda: desk.finding.similar("4.5"))
    assert selected(desk) == near(lines, range(30), 4.5)


def test_of_many_an_even_share_is_asked_about_and_said(desk, monkeypatch):
    monkeypatch.setattr(bundle_finding, "COMPARED", 3)
    desk.scene.selection.select(desk.page.chosen, np.arange(21))
    desk.run(lambda: desk.finding.similar("0.5"))
    assert selected(desk) == [0, 10, 20]
    assert "an even 3 of the 21" in desk.said[-1][1]


def test_clusters_become_bundles_in_one_step(desk, monkeypatch):
    monkeypatch.setattr(bundle_finding, "LISTED", 5)
    found = desk.scene.actor(desk.page.chosen).fiblets.clusters(threshold=9.0).by_size()
    assert len(found) > 5
    desk.run(lambda: desk.finding.cluster("9 mm"))
    assert names(desk) == ["near", "far", *(f"cluster {k}" for k in range(1, 6))]
    bundles = desk.scene.bundles.of_layer(desk.page.chosen)
    assert [one.ids.array().tolist() for one in bundles[2:]] == [found[k].ids.tolist() for k in range(5)]
    assert len({one.color for one in bundles}) == 7
    assert f"{len(found)} clusters; the 5 largest" in desk.said[-1][1]
    assert desk.history.undo() == "5 clusters"
    assert names(desk) == ["near", "far"]


def test_work_tells_how_far_it_is_and_is_cancelled(desk, monkeypatch):
    began, go_on = threading.Event(), threading.Event()
    whole = clustering.iter_resampled

    def slow(data, n_points, ids, progress, what):
        for part in whole(data, n_points, ids, progress, what):
            began.set()
            go_on.wait(30)
            yield part
            progress(what, 0.5)  # as before a second part

    monkeypatch.setattr(clustering, "iter_resampled", slow)

    async def doing():
        desk.finding.cluster("9")
        await asyncio.to_thread(began.wait, 30)
        assert desk.page.job["cancellable"]
        assert desk.page.job["text"].startswith("lines.fiblets: clustering")
        desk.files.cancel()
        go_on.set()
        await desk.done()

    asyncio.run(doing())
    assert names(desk) == ["near", "far"]
    assert "cancelled" in desk.said[-1][1]
    assert desk.page.job == {}


@pytest.fixture
def brain(folder):
    """Three bundles of forty lines, and a folder of models of two of them and of one that is elsewhere."""
    rng = np.random.default_rng(3)
    t = np.linspace(0, 1, 30)[:, None]
    courses = [
        np.hstack([80 * t, 30 * np.sin(3 * t), 10 * t]),
        np.hstack([20 * np.cos(4 * t), 60 * t + 40, 40 - 50 * t]),
        np.hstack([10 * t - 60, 70 * t, 30 * np.cos(2 * t)]),
    ]
    lines = [c + rng.normal(0, 1.0, 3) for c in courses for _ in range(40)]
    pvfiblets.compress(Streamlines.from_list(lines)).save(folder / "brain.fiblets")
    models = folder / "atlas" / "models"
    models.mkdir(parents=True)
    shifted = [*courses[:2], np.hstack([200 + 60 * t, 10 * t, 300 - 50 * t])]
    for name, c in zip(("one.trk", "two.fiblets", "none.trk"), shifted, strict=True):
        model = Streamlines.from_list([c + rng.normal(0, 1.0, 3) for _ in range(25)])
        if name.endswith(".trk"):
            pvfiblets.write(models / name, model)
        else:
            pvfiblets.compress(model).save(models / name)
    (models / "readme.md").write_text("not a tractogram")
    return folder


@pytest.mark.more
def test_models_of_a_folder_are_recognised(desk, brain):
    pytest.importorskip("dipy")
    desk.choose(desk.scene.open("brain.fiblets"))
    desk.finding.fold(True)
    assert desk.page.finding == {"open": True, "folders": ["atlas/models"], "dipy": True}
    desk.run(lambda: desk.finding.recognise("atlas/models"))
    found = {one.name: one.ids.array() for one in desk.scene.bundles.of_layer(desk.page.chosen)}
    assert list(found) == ["one", "two"]
    for k, ids in enumerate(found.values()):
        assert len(ids) >= 30
        assert set(ids) <= set(range(40 * k, 40 * k + 40))
    assert "nothing was recognised of none" in desk.said[-1][1]


def test_models_lie_under_the_root(desk, brain, tmp_path):
    pytest.importorskip("dipy")
    outside = tmp_path / "outside"
    outside.mkdir()
    (brain / "atlas" / "models" / "one.trk").rename(outside / "one.trk")
    (brain / "linked").symlink_to(outside)
    (brain / "atlas" / "models" / "one.trk").symlink_to(outside / "one.trk")
    assert bundle_finding.model_folders(desk.confined) == ["atlas/models"]
    for folder in ("linked", "../outside", str(outside)):
        with pytest.raises(ValueError, match="served folder"):
            desk.finding.recognise(folder)


def test_without_dipy_the_page_says_so(desk, monkeypatch):
    monkeypatch.setattr(bundle_finding, "find_spec", lambda name: None)
    desk.finding.fold(True)
    assert desk.page.finding["dipy"] is False
    with pytest.raises(ValueError, match="pip install dipy"):
        desk.finding.recognise("atlas")


@pytest.mark.parametrize(
    ("act", "says"),
    [
        (lambda desk: desk.finding.similar("8"), "pick a streamline"),
        (lambda desk: desk.finding.cluster("wide"), "'wide' is not a number"),
        (lambda desk: desk.finding.cluster("0"), "distance is 0.0; give a finite number of mm from 0.1"),
        (lambda desk: desk.finding.recognise(""), "has no tractograms|dipy"),
        (lambda desk: desk.bundles.move(1), "boxes first"),
        (lambda desk: desk.measuring.fetch("profile", "csv"), "measure first"),
        (lambda desk: desk.measuring.fetch("profile", "exe"), "no 'profile' as 'exe'"),
    ],
)
def test_what_makes_no_sense_is_refused(desk, act, says):
    if says.startswith("has no tractograms"):
        for file in [*desk.confined.root.glob("*.trk"), *desk.confined.root.glob("*.fiblets")]:
            file.unlink()
        for file in [*desk.confined.root.glob("*.vtp")]:
            file.unlink()
    with pytest.raises(ValueError, match=says):
        act(desk)


def test_bundles_move_by_buttons_and_by_dragging(desk):
    scene, layer = desk.scene, desk.page.chosen
    for k in range(3):
        scene.bundles.add_bundle(layer, [k], "abc"[k])
    for name in ("b", "far"):
        desk.bundles.check(name, True)
    desk.bundles.move(-1)
    assert names(desk) == ["far", "b", "near", "a", "c"]
    desk.bundles.move(1)
    assert names(desk) == ["near", "far", "b", "a", "c"]
    for _ in range(3):
        desk.bundles.move(1)
    assert names(desk) == ["near", "a", "c", "far", "b"]
    desk.bundles.drop("far", "near")
    assert names(desk) == ["far", "near", "a", "c", "b"]
    desk.bundles.drop("far", "c")
    assert names(desk) == ["near", "a", "c", "far", "b"]
    desk.bundles.drop("somewhere else's", "c")
    assert names(desk) == ["near", "a", "c", "far", "b"]
    assert list(scene.actor(layer).fiblets.groups) == names(desk)
    assert desk.history.undo() == "order of 1 bundle(s)"
    assert names(desk) == ["far", "near", "a", "c", "b"]
