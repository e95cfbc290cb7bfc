"""Bundles and the matrix, in a real browser."""

from __future__ import annotations

import csv

import numpy as np
import pytest

pytestmark = pytest.mark.more


def rows(here):
    return here.state("bundles")["rows"]


def names(here):
    return [row["name"] for row in rows(here)]


def choose(here, *wanted):
    for name in wanted:
        here.page.click(f"[data-bundle-row='{name}'] input[type=checkbox]")
        here.wait(lambda name=name: any(row["name"] == name and row["order"] for row in rows(here)), "its box")


def test_bundles_are_found_ordered_measured_and_fetched(revisit, tmp_path):
    here = revisit("lines.fiblets")
    here.tab("bundles")
    here.page.click("[data-action=find]")
    # What runs near the selected ones.
    choose(here, "far")
    here.page.click("[data-bundle-act=select]")
    here.wait(lambda: here.state("selection")["count"] == 30, "a selection")
    here.page.fill("[data-find=similar] input", "7")
    here.page.click("[data-bundle=similar]")
    here.wait(lambda: "within 7 mm of 30" in here.state("toast"), "what runs near")
    assert here.state("selection")["count"] > 30
    here.press("Control+z")
    here.wait(lambda: here.state("selection")["count"] == 30, "the selection before")
    # Clusters, in one step.
    here.page.fill("[data-find=clusters] input", "12")
    here.page.click("[data-bundle=clusters]")
    here.wait(lambda: "cluster 1" in names(here), "clusters")
    assert "clusters" in here.toast()
    count = len(names(here))
    here.press("Control+z")
    here.wait(lambda: names(here) == ["near", "far"], "none of them")
    here.press("Control+y")
    here.wait(lambda: len(names(here)) == count, "all of them")
    # Their order: dragged, and by buttons.
    here.page.drag_and_drop("[data-bundle-row='cluster 1'] [data-action=grip]", "[data-bundle-row=near]")
    here.wait(lambda: names(here)[:3] == ["cluster 1", "near", "far"], "the first place")
    here.page.click("[data-bundle-move='-1']")
    here.wait(lambda: names(here)[:3] == ["cluster 1", "far", "near"], "a place above")
    # Along them, and a row for each.
    choose(here, "near")
    here.page.click("[data-action=measure-bundles]")
    here.page.click("[data-action=profile-bundles]")
    here.page.wait_for_selector("#bundle-profile svg polyline")
    assert here.page.locator("#bundle-profile .pv-dot").count() == 2
    with here.page.expect_download() as download:
        here.page.click("[data-fetch=profile-tsv]")
    download.value.save_as(tmp_path / "profile.tsv")
    found = list(csv.DictReader((tmp_path / "profile.tsv").read_text().splitlines(), delimiter="\t"))
    assert np.allclose([float(row["mean"]) for row in found], 2 * [*np.linspace(0, 1, 100)], atol=1 / 255)
    here.page.click("[data-action=table-bundles]")
    here.page.wait_for_selector("#bundle-table tbody tr >> nth=1")
    with here.page.expect_download() as download:
        here.page.click("[data-fetch=table-parquet]")
    download.value.save_as(tmp_path / "table.parquet")
    assert (tmp_path / "table.parquet").read_bytes()[:4] == b"PAR1"
    # Colours of bundles, and all of it again.
    before = here.rests()
    here.page.click("[data-action=colour-by-bundle]")
    here.changed(before)
    order = names(here)
    here.page.reload()
    here.ready()
    assert names(here) == order
    assert here.state("bundles")["coloured"]


def test_a_matrix_is_made_pointed_at_and_clicked(revisit, tmp_path):
    here = revisit("lines.fiblets")
    here.page.click("[data-action=matrix]")
    here.page.click("[data-select=matrix-labels] .v-field")
    here.page.click(".v-overlay--active .v-list-item:has-text('atlas.nii.gz')")
    here.page.fill("[data-field=matrix-radius]", "0")
    here.press("Tab")
    here.wait(lambda: here.state("matrix")["form"]["chosen"]["radius"] == "0", "the radius")
    here.page.click("[data-action=make-matrix]")
    here.page.wait_for_selector("#pv-cells[data-n='2']")
    # Of a window of 1280 pixels the panels leave 640, and the matrix takes a part of these.
    width = lambda: round(here.page.locator("#pv-view").bounding_box()["width"])  # noqa: E731
    here.wait(lambda: here.picture().shape[1] == width() < 500, "the brain to make room")
    picture = here.picture()
    cells = here.page.locator("#pv-cells").bounding_box()
    at = (cells["x"] + 0.75 * cells["width"], cells["y"] + 0.25 * cells["height"])
    here.page.mouse.move(*at)
    # Lines begin in 3, and of those that end in 5 the lengths are 15 to 30 mm.
    here.wait(lambda: here.page.locator("#pv-cell").inner_text() == "3 – 5: 16 streamlines", "what is told")
    here.page.mouse.click(*at)
    here.wait(lambda: here.state("matrix")["cell"] == "3 – 5", "its streamlines")
    assert here.state("filters")["counted"] == "16 of 60 streamlines"
    with here.page.expect_download() as download:
        here.page.click("[data-fetch='matrix.npy']")
    download.value.save_as(tmp_path / "matrix.npy")
    matrix = np.load(tmp_path / "matrix.npy")
    assert matrix.tolist() == [[5, 16], [16, 0]]
    here.page.click("[data-action=fold-matrix]")
    here.changed(picture)
    here.press("Control+z")
    here.wait(lambda: here.state("filters")["counted"] == "60 of 60 streamlines", "all of them")
    here.press("Control+y")
    here.page.reload()
    here.ready()
    here.wait(lambda: here.state("filters")["counted"] == "16 of 60 streamlines", "the same")
