"""The list of bundles: what is changed there, in sets, files and pictures."""

import nibabel
import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets import FibletSet, Streamlines, bundles, compress, regions
from pvfiblets.query.bundles.colours import as_colour, distinct_colour, distinct_colours, hex_colour


@pytest.fixture
def fiblets():
    rng = np.random.default_rng(0)
    lines = [np.cumsum(rng.normal(size=(20, 3)), axis=0) + [10 * (i % 4), 0, 0] for i in range(40)]
    made = compress(Streamlines.from_list(lines))
    made.groups = {"a": np.arange(0, 10), "b": np.arange(5, 20), "c": np.array([30, 31])}
    return made


def test_edits_are_those_of_sets_of_numbers(fiblets):
    listed, calls = bundles.Bundles(fiblets, lambda: calls.append(1)), []
    listed.rename("a", "left")
    assert listed.names == ["left", "b", "c"]
    listed.subtract("left", "b")
    assert set(listed["left"].ids) == set(range(5))
    listed.subtract("b", ["c", "left"], into="b only")
    assert listed.names[-1] == "b only"
    listed.merge(["b", "c"], "both")
    assert listed.names == ["left", "both", "b only"]
    assert set(listed["both"].ids) == set(range(5, 20)) | {30, 31}
    listed.merge(["left", "both"], "all", keep=True)
    assert listed.names == ["left", "both", "b only", "all"]
    listed.reorder(["all", "b only"])
    assert listed.names == ["all", "b only", "left", "both"]
    listed.remove("all")
    assert set(listed.rest) == set(range(40)) - set(range(20)) - {30, 31}
    listed.set_ids("left", np.arange(40) < 3)
    assert listed[1].count == len(listed["left"]) == 3
    assert len(calls) == 8
    assert len(fiblets[listed["left"]]) == 3


def test_what_is_found_becomes_a_bundle(fiblets):
    listed = fiblets.bundles
    sphere = regions.passes(regions.Sphere((0.0, 0.0, 0.0), 4.0))
    assert set(listed.add("near", sphere).ids) == set(np.flatnonzero(fiblets.select(sphere)))
    like = fiblets.similar([3], 8.0)
    assert set(listed.add("like 3", like, color="#ff8000").ids) == set(like.ids)
    assert listed["like 3"].color == pytest.approx((1.0, 128 / 255, 0.0))
    clusters = fiblets.clusters(8.0)
    assert set(listed.add("first", clusters[0]).ids) == set(clusters[0].ids)
    listed.add_all(clusters.groups("k{}", at_least=2))
    assert listed["k1"].count == clusters.counts.max()


def test_colours_and_visibility_are_kept_in_files(fiblets, tmp_path):
    listed = fiblets.bundles
    listed["a"].color = "red"
    listed["b"].visible = False
    listed["c"].name = "third"
    for name in ("all.fiblets", "all.trx"):
        listed.export(tmp_path / name)
        back = FibletSet.open(tmp_path / name) if name.endswith("fiblets") else pvfiblets.read(tmp_path / name)
        again = bundles.Bundles(back)
        assert again.names == ["a", "b", "third"] or sorted(again.names) == ["a", "b", "third"]
        assert again["a"].color == (1.0, 0.0, 0.0)
        assert [again[n].visible for n in ("a", "b", "third")] == [True, False, True]
        assert [again[n].count for n in ("a", "b", "third")] == [10, 15, 2]
        assert len(back) == 22
    files = listed.export(tmp_path / "each", hidden=False)
    assert [file.name for file in files] == ["a.tck", "third.tck"]
    assert len(nibabel.streamlines.load(files[0]).streamlines) == 10
    same = bundles.Bundles(Streamlines.from_list([np.eye(3)] * 2, groups={"x/y": [0], "x y": [1]}))
    assert sorted(file.name for file in same.export(tmp_path / "odd", suffix=".trk")) == ["x_y.trk", "x_y_2.trk"]


def test_the_picture_follows_the_list(fiblets):
    plotter = pv.Plotter(window_size=(160, 120), off_screen=True)
    plotter.background_color = "black"
    actor = plotter.add_fiblets(fiblets, scalars="group", line_width=3, show_scalar_bar=False)
    for name, colour in zip("abc", ("red", "lime", "blue"), strict=True):
        actor.bundles[name].color = colour
    plotter.camera_position = "xy"
    pictures = [plotter.screenshot(return_img=True)]
    actor.bundles["a"].visible = False
    assert actor.shown.sum() == 40 - 5  # the other five are in b as well
    plotter.render()
    pictures.append(plotter.screenshot(return_img=True))
    actor.bundles.show_only("c")
    assert actor.shown.sum() == 2 + 40 - 22
    plotter.render()
    pictures.append(plotter.screenshot(return_img=True))
    plotter.close()

    def has(picture, channel):
        others = [k for k in range(3) if k != channel]
        return bool(((picture[..., channel] > 120) & (picture[..., others] < 60).all(axis=-1)).any())

    assert [[has(p, k) for k in range(3)] for p in pictures] == [
        [True, True, True], [False, True, True], [False, False, True],
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("edit", "error", "says"),
    [
        (lambda b: b["z"], KeyError, "there are: 'a', 'b', 'c'"),
        (lambda b: b.add("a", [1]), ValueError, "there is a bundle 'a' already"),
        (lambda b: b.add("", [1]), ValueError, "some text"),
        (lambda b: b.add("z", [99]), IndexError, "99"),
        (lambda b: b.add("z", [1], color=(2, 3)), ValueError, "no colour"),
        (lambda b: b.add("z", [1], color="blurple"), ValueError, "^'blurple' is no colour; give '#rrggbb'"),
        (lambda b: b.rename("a", "b"), ValueError, "already"),
        (lambda b: b.merge([], "x"), ValueError, "no bundles to merge"),
        (lambda b: b.merge(["a", "b"], "c"), ValueError, "already"),
        (lambda b: b.reorder(["a", "a"]), ValueError, "twice"),
        (lambda b: b.export("bundles.tck"), ValueError, "keep no groups"),
    ],
)
def test_what_cannot_be_done_is_told_and_changes_nothing(fiblets, edit, error, says):
    before = {name: ids.tolist() for name, ids in fiblets.groups.items()}
    with pytest.raises(error, match=says):
        edit(fiblets.bundles)
    assert {name: ids.tolist() for name, ids in fiblets.groups.items()} == before
    assert fiblets.per_group == {}


def test_colours_are_taken_as_people_write_them():
    assert as_colour("#ff0080") == pytest.approx((1.0, 0.0, 128 / 255))
    assert as_colour("red") == (1.0, 0.0, 0.0)
    assert as_colour((0.5, 0.25, 0.0)) == (0.5, 0.25, 0.0)
    assert as_colour([255, 0, 51]) == pytest.approx((1.0, 0.0, 0.2))


def test_models_recognise_their_bundles(tmp_path):
    rng = np.random.default_rng(3)
    t = np.linspace(0, 1, 30)[:, None]
    courses = [
        np.hstack([80 * t, 30 * np.sin(3 * t), 10 * t]),
        np.hstack([20 * np.cos(4 * t), 60 * t + 40, 40 - 50 * t]),
        np.hstack([10 * t - 60, 70 * t, 30 * np.cos(2 * t)]),
    ]
    lines = [c + rng.normal(0, 1.0, 3) for c in courses for _ in range(40)]
    brain = compress(Streamlines.from_list([*lines, np.zeros((0, 3))]))
    models = tmp_path / "models"
    models.mkdir()
    for name, c in zip(("one", "two"), courses, strict=False):
        pvfiblets.write(models / f"{name}.trk", Streamlines.from_list([c + rng.normal(0, 1.0, 3) for _ in range(25)]))
    (models / "readme.md").write_text("not a tractogram")
    told = []
    found = brain.recognise(models, seed=1, progress=lambda what, share: told.append((what, share)))
    assert [share for _, share in told] == sorted(share for _, share in told)
    assert all(any(name in what for what, _ in told) for name in found)
    assert list(found) == ["one", "two"]
    for k, name in enumerate(found):
        mine = set(range(40 * k, 40 * k + 40))
        assert set(found[name]) <= mine
        assert len(found[name]) >= 30
    brain.bundles.add_all(found)
    assert brain.bundles.names == ["one", "two"]
    with pytest.raises(FileNotFoundError, match="no folder"):
        brain.recognise(tmp_path / "none")
    with pytest.raises(ValueError, match="at least 5"):
        brain.recognise({"few": lines[:2]})


def test_without_dipy_there_is_one_clear_error(fiblets, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "dipy.segment.bundles", None)
    with pytest.raises(ImportError, match="pip install dipy"):
        fiblets.recognise({"a": []})


def test_colours_of_numbers_are_the_same_alone_and_take_no_memory():
    np.testing.assert_array_equal([distinct_colour(number) for number in range(50)], distinct_colours(50))
    assert all(0.0 <= part <= 1.0 for part in distinct_colour(10**15))


@pytest.mark.parametrize("text", ["#000000", "#ff8001", "#ffffff"])
def test_hexadecimal_comes_back(text):
    assert hex_colour(as_colour(text)) == text
