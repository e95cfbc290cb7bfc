"""Profiles and statistics of bundles on the page."""

from __future__ import annotations

import csv
import io
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from tests.web.desk import Desk


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
    desk.scene.add_bundle(layer, [1, 2], "=cmd()")
    desk.run(desk.measuring.statistics)
    assert "'=cmd()" in desk.measuring.fetch("table", "csv")
    desk.scene.move_bundles(layer, ["far"], 0)
    desk.measuring.refresh()
    assert desk.page.measures["table"]["rows"]  # still of these bundles
    desk.scene.remove_bundles(layer, ["far"])
    desk.measuring.refresh()
    assert not desk.page.measures["table"]
    with pytest.raises(ValueError, match="nothing was measured"):
        desk.measuring.fetch("table", "csv")


def test_hidden_and_empty_bundles_are_left_out(desk):
    layer = desk.page.chosen
    desk.scene.set_bundle(layer, "near", visible=False)
    desk.run(desk.measuring.statistics)
    assert [row[0] for row in desk.page.measures["table"]["rows"]] == ["far"]
    desk.scene.set_bundle(layer, "far", visible=False)
    with pytest.raises(ValueError, match="no bundle"):
        desk.measuring.profile()
