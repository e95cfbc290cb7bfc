"""Scenes: what pixels, boxes and lassos pick, and what becomes of it."""

from __future__ import annotations

import json

import numpy as np
import pytest

import pvfiblets


def test_a_pixel_picks_the_line_that_is_there(flat):
    # From above, line 50 + j lies over those below at y = 4 j; x = 10 mm is 40 columns left of the middle.
    row = 80 + round((4 * 3 - 18) / 0.5)
    found = flat.pick_at(100 + round((55 - 30) / 0.5), row)
    assert found["streamline"] == 53
    assert found["position"][0] == pytest.approx(55.0, abs=0.6)
    assert flat.layers[0].selected.array().tolist() == [53]
    other = 80 + round((4 * 7 - 18) / 0.5)
    assert flat.pick_at(100, other, mode="add")["streamline"] == 57
    assert flat.layers[0].selected.array().tolist() == [53, 57]
    flat.pick_at(100, row, mode="toggle")
    assert flat.layers[0].selected.array().tolist() == [57]
    assert flat.pick_at(2, 2) is None
    assert flat.count() == 0


def test_boxes_and_lassos_select_what_they_hold(flat, lines):
    (layer,) = flat.layers
    x0 = 100 + round((50 - 30) / 0.5)
    reach = np.array([line[-1, 0] for line in lines])
    flat.select_box(x0, 0, 199, 159, through=True)
    beyond = set(np.flatnonzero(reach > 51).tolist())
    found = set(flat.layers[0].selected.array().tolist())
    assert beyond <= found <= set(np.flatnonzero(reach >= 49).tolist())
    before = flat.count()
    flat.select_polygon([[x0, 0], [199, 0], [199, 80], [x0, 80]], mode="remove", through=True)
    y = np.array([line[0, 1] for line in lines])
    assert set(flat.layers[0].selected.array().tolist()) == {i for i in found if y[i] > 18}
    assert 0 < flat.count() < before
    flat.deselect()
    assert flat.layers[0].selected is None
    assert len(flat.actor(layer.id).selection) == 0
    with pytest.raises(ValueError, match="lasso"):
        flat.select_polygon([[0, 0]])
    with pytest.raises(ValueError, match="mode"):
        flat.select_box(0, 0, 9, 9, mode="perhaps")


def test_the_table_says_what_is_selected(scene, lines):
    layer = scene.open("lines.fiblets")
    scene.set(layer.id, "scalars", "fa")
    scene.select(layer.id, [7, 31, 59])
    table = scene.table()
    assert table["total"] == 3
    assert [row["streamline"] for row in table["rows"]] == [7, 31, 59]
    np.testing.assert_allclose([row["length"] for row in table["rows"]], lines.lengths()[[7, 31, 59]], atol=0.1)
    assert [row["points"] for row in table["rows"]] == lines.counts[[7, 31, 59]].tolist()
    np.testing.assert_allclose([row["value"] for row in table["rows"]], 0.5, atol=0.01)
    assert [row["groups"] for row in table["rows"]] == [["near"], ["far"], ["far"]]
    assert [row["streamline"] for row in scene.table(first=1, limit=1)["rows"]] == [31]
    json.dumps(table, allow_nan=False)
    profile = scene.profile(layer.id, n=5)
    np.testing.assert_allclose(profile["mean"], [0, 0.25, 0.5, 0.75, 1], atol=0.01)
    assert (profile["name"], profile["count"]) == ("fa", 3)
    for ids in ([60], [-1], [0.5]):
        with pytest.raises(ValueError, match="streamlines are"):
            scene.select(layer.id, ids)


@pytest.mark.parametrize("suffix", [".trk", ".tck", ".trx", ".vtp", ".vtk", ".fiblets"])
def test_exports_hold_what_was_selected(scene, lines, suffix):
    layer = scene.open("lines.fiblets")
    with pytest.raises(ValueError, match="nothing"):
        scene.export(layer.id, f"some{suffix}")
    scene.select(layer.id, [3, 10, 11, 40])
    said = scene.export(layer.id, f"some{suffix}")
    assert (said["path"], said["streamlines"]) == (f"some{suffix}", 4)
    place = scene.root / f"some{suffix}"
    found = pvfiblets.FibletSet.open(place).decompress() if suffix == ".fiblets" else pvfiblets.read(place)
    assert len(found) == 4
    np.testing.assert_allclose(found.points, lines[[3, 10, 11, 40]].points, atol=0.06)
    with pytest.raises(FileExistsError):
        scene.export(layer.id, f"some{suffix}")
    scene.set_groups(layer.id, ["far"])
    assert scene.export(layer.id, f"some{suffix}", what="shown", overwrite=True)["streamlines"] == 30
    with pytest.raises(ValueError, match="end in one of"):
        scene.export(layer.id, "some.txt")


def test_what_is_selected_becomes_a_layer_of_its_own(scene, lines):
    layer = scene.open("lines.fiblets")
    scene.select(layer.id, np.arange(20, 50))
    part = scene.keep_selection(layer.id)
    assert part.kind == "selection"
    scene.select(part.id, [0, 5, 29], mode="replace")
    nested = scene.keep_selection(part.id)
    assert nested.source.ids.array().tolist() == [20, 25, 49]
    np.testing.assert_allclose(
        scene.actor(nested.id).fiblets.decompress().points, lines[[20, 25, 49]].points, atol=0.06
    )
    scene.remove(layer.id)
    scene.screenshot()
