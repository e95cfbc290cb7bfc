"""Bundles on the page: what is edited, undone, saved, and shown."""

import csv
import io
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from pvfiblets.web.session import files as session
from pvfiblets.web.session.history import History
from tests.web.desk import Desk, assert_script_draws


@pytest.fixture
def lines_layer(scene):
    return scene.open("lines.fiblets").id


def told(scene, layer):
    return {one.name: (len(one.ids), one.visible) for one in scene.bundles.of_layer(layer)}


def shown(scene, layer):
    return np.flatnonzero(scene.actor(layer).shown).tolist()


def test_groups_selections_and_what_is_shown_are_one_list(scene, lines_layer):
    history = History(scene, together=0.0)
    assert told(scene, lines_layer) == {"near": (30, True), "far": (30, True)}
    scene.selection.select(lines_layer, [1, 2, 40])
    scene.bundles.add_bundle(lines_layer, "selected", "picked <b>ones</b>")
    scene.filters.set_filter(lines_layer, "weight", 10, 14)
    scene.bundles.add_bundle(lines_layer, "shown")
    scene.filters.remove_filter(lines_layer)
    assert told(scene, lines_layer) == {
        "near": (30, True), "far": (30, True), "picked <b>ones</b>": (3, True), "bundle 4": (5, True),
    }  # fmt: skip
    groups = scene.actor(lines_layer).fiblets.groups
    assert list(groups) == ["near", "far", "picked <b>ones</b>", "bundle 4"]
    assert groups["bundle 4"].tolist() == [10, 11, 12, 13, 14]
    scene.bundles.merge_bundles(lines_layer, ["bundle 4", "picked <b>ones</b>"])
    scene.bundles.subtract_bundles(lines_layer, ["near", "bundle 4"])
    assert told(scene, lines_layer) == {"near": (23, True), "far": (30, True), "bundle 4": (8, True)}
    scene.filters.set_groups(lines_layer, ["far", "near"])
    scene.bundles.set_bundle(lines_layer, "far", name="away")
    assert scene.layer(lines_layer).filters.groups == ("away", "near")
    scene.bundles.remove_bundles(lines_layer, ["away"])
    assert scene.layer(lines_layer).filters.groups == ("near",)
    while history.undo() is not None:
        pass
    assert told(scene, lines_layer) == {"near": (30, True), "far": (30, True)}
    assert list(groups) == ["near", "far"]
    assert scene.state.bundles_of(scene.layer(lines_layer).source) is None


def test_hidden_bundles_are_not_drawn_but_what_is_in_none_stays(scene, lines_layer):
    scene.bundles.remove_bundles(lines_layer, ["far"])
    scene.bundles.add_bundle(lines_layer, [25, 35], "mixed")
    scene.bundles.set_bundle(lines_layer, "near", visible=False)
    assert shown(scene, lines_layer) == [25, *range(30, 60)]
    scene.bundles.show_bundles(lines_layer, ["near"])
    assert shown(scene, lines_layer) == [n for n in range(60) if n != 35]
    twin = scene.duplicate(lines_layer).id  # of the same source
    assert told(scene, twin) == told(scene, lines_layer)
    assert shown(scene, twin) == shown(scene, lines_layer)
    scene.bundles.show_bundles(lines_layer, None)
    assert shown(scene, lines_layer) == shown(scene, twin) == list(range(60))


def test_colours_are_those_of_the_list(scene, lines_layer):
    scene.set(lines_layer, "scalars", "group")
    scene.set(lines_layer, "lighting", False)
    scene.set(lines_layer, "line_width", 3)
    scene.cameras.view("coronal")
    listed = {tuple(int(one.color[k : k + 2], 16) for k in (1, 3, 5)) for one in scene.bundles.of_layer(lines_layer)}
    assert len(listed) == 2
    found = scene.cameras.screenshot().reshape(-1, 3)
    lit = found[found.max(axis=1) > 0]
    assert {tuple(one) for one in np.unique(lit, axis=0).tolist()} == listed
    scene.bundles.set_bundle(lines_layer, "near", color="#ff0000")
    scene.bundles.set_bundle(lines_layer, "far", color="#0000ff")
    scene.cameras.view("coronal")
    found = scene.cameras.screenshot().reshape(-1, 3)
    lit = found[found.max(axis=1) > 0]
    assert {tuple(one) for one in np.unique(lit, axis=0).tolist()} == {(255, 0, 0), (0, 0, 255)}
    scene.bundles.remove_bundles(lines_layer, ["near", "far"])
    assert scene.layer(lines_layer).settings["scalars"] == "orientation"


def test_sessions_and_scripts_have_bundles(scene, lines_layer, folder):
    scene.bundles.remove_bundles(lines_layer, ["far"])
    scene.bundles.add_bundle(lines_layer, [3, 4, 5], "a")
    scene.bundles.set_bundle(lines_layer, "near", visible=False)
    scene.filters.set_groups(lines_layer, ["a", "near"])
    scene.set(lines_layer, "scalars", "group")
    scene.set(lines_layer, "line_width", 2)
    scene.filters.set_groups(lines_layer, None)
    scene.cameras.view("coronal")
    state, wanted = session.to_dict(scene), told(scene, lines_layer)
    picture = scene.cameras.screenshot()
    assert_script_draws(scene, folder, picture)
    scene.remove(lines_layer)
    scene.forget_unused()
    session.from_dict(scene, state)
    layer = scene.layers[0].id
    assert told(scene, layer) == wanted
    assert scene.layer(layer).settings["scalars"] == "group"
    assert shown(scene, layer) == [3, 4, 5, *range(30, 60)]
    rows = state["bundles"][0]["bundles"]
    for wrong, said in (
        ([{**rows[0], "ids": [0, 99]}], "streamline 98"), ([rows[0], rows[0]], "two bundles"),
        ([{**rows[0], "color": "nope"}], "colour"), ([{"name": 3}], "bundle"), ("x", "bundles"),
    ):  # fmt: skip
        with pytest.raises(session.SessionError, match=said):
            session.from_dict(scene, {**state, "bundles": [{**state["bundles"][0], "bundles": wrong}]})
    assert told(scene, layer) == wanted


def test_what_makes_no_sense_is_refused(scene, lines_layer):
    for act, said in (
        (lambda: scene.bundles.add_bundle(lines_layer, "selected"), "nothing of"),
        (lambda: scene.bundles.add_bundle(lines_layer, [], "x"), "no streamlines"),
        (lambda: scene.bundles.add_bundle(lines_layer, [60], "x"), "streamline 60"),
        (lambda: scene.bundles.add_bundle(lines_layer, [1], "near"), "already"),
        (lambda: scene.bundles.merge_bundles(lines_layer, ["near"]), "two bundles"),
        (lambda: scene.bundles.subtract_bundles(lines_layer, ["near"]), "taken out"),
        (lambda: scene.bundles.set_bundle(lines_layer, "near", size=3), "size"),
    ):
        with pytest.raises(ValueError, match=said):
            act()
    with pytest.raises(KeyError, match="no bundle 'other'"):
        scene.bundles.select_bundles(lines_layer, ["other"])
    scene.bundles.select_bundles(lines_layer, ["far"])
    assert scene.selection.count() == 30


@pytest.fixture
def desk(scene, folder):
    made = Desk(scene, folder)
    made.choose(scene.open("lines.fiblets"))
    scene.open("head.nii.gz")
    made.measuring.fold(True)
    return made


def rows(text, between=","):
    head, *found = csv.reader(io.StringIO(text), delimiter=between)
    return [dict(zip(head, row, strict=True)) for row in found]


def test_a_profile_is_plotted_and_fetched(desk):
    assert [one["title"] for one in desk.page.measures["values"]] == ["fa", "curvature", "arc_length", "head.nii.gz"]
    desk.run(desk.measuring.profile)
    shown = desk.page.measures["profile"]
    assert [one["name"] for one in shown["legend"]] == ["near", "far"]
    assert ET.fromstring(shown["chart"]).tag.endswith("svg")
    assert len(shown["rows"]) == 100
    found = rows(desk.measuring.fetch("profile", "csv"))
    assert {row["bundle"] for row in found} == {"near", "far"}
    # fa rises from 0 to 1 along each line, which has 8 bits.
    for name in ("near", "far"):
        mean = [float(row["mean"]) for row in found if row["bundle"] == name]
        assert np.allclose(mean, np.linspace(0, 1, 100), atol=1 / 255)
    assert rows(desk.measuring.fetch("profile", "tsv"), "\t") == found


def test_a_profile_of_an_image_is_what_lies_there(desk):
    desk.measuring.set_value("image head.nii.gz")
    desk.bundles.check("near", True)
    desk.run(desk.measuring.profile)
    found = rows(desk.measuring.fetch("profile", "csv"))
    assert {row["bundle"] for row in found} == {"near"}
    # At their beginnings, which voxel centres are, by the formula that made the image.
    i = np.array([[0, line % 10, line // 10] for line in range(30)])
    values = 1.0 - np.linalg.norm(2.0 * i / 15.0 - 1.0, axis=1)
    starts = np.array([[0.0, 4.0 * (line % 10), 4.0 * (line // 10)] for line in range(30)])
    apart = starts - starts.mean(axis=0)
    inverse = np.linalg.pinv(apart.T @ apart / 30)
    weight = 1.0 / np.sqrt(np.einsum("ni,ij,nj->n", apart, inverse, apart))  # near the core more
    assert float(found[0]["mean"]) == pytest.approx((values * weight).sum() / weight.sum(), abs=2e-3)


def test_statistics_are_a_row_for_each_bundle(desk):
    desk.run(desk.measuring.statistics)
    shown = desk.page.measures["table"]
    assert shown["columns"][:3] == ["bundle", "count", "mm"]
    near, far = rows(desk.measuring.fetch("table", "csv"))
    assert (near["bundle"], near["count"], far["bundle"], far["count"]) == ("near", "30", "far", "30")
    assert float(near["length_mean"]) == pytest.approx(np.arange(10, 40).mean(), abs=0.1)
    assert float(far["length_total"]) == pytest.approx(np.arange(40, 70).sum(), abs=3)
    assert float(far["mean_weight"]) == pytest.approx(np.arange(30, 60).mean())
    assert "mean_head.nii.gz" in near
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(io.BytesIO(desk.measuring.fetch("table", "parquet")))
    assert table.column("count").to_pylist() == [30, 30]


def test_what_was_measured_goes_when_its_bundles_change(desk):
    layer = desk.page.chosen
    desk.scene.bundles.add_bundle(layer, [1, 2], "=cmd()")
    desk.run(desk.measuring.statistics)
    assert "'=cmd()" in desk.measuring.fetch("table", "csv")
    desk.scene.bundles.move_bundles(layer, ["far"], 0)
    desk.measuring.refresh()
    assert desk.page.measures["table"]["rows"]  # still of these bundles
    desk.scene.bundles.remove_bundles(layer, ["far"])
    desk.measuring.refresh()
    assert not desk.page.measures["table"]
    with pytest.raises(ValueError, match="measure first"):
        desk.measuring.fetch("table", "csv")


def test_hidden_and_empty_bundles_are_left_out(desk):
    layer = desk.page.chosen
    desk.scene.bundles.set_bundle(layer, "near", visible=False)
    desk.run(desk.measuring.statistics)
    assert [row[0] for row in desk.page.measures["table"]["rows"]] == ["far"]
    desk.scene.bundles.set_bundle(layer, "far", visible=False)
    with pytest.raises(ValueError, match="no bundle"):
        desk.measuring.profile()
