"""What a page gives away: pictures of any size, tables, profiles and streamlines, in a real browser."""

import csv
import io
import itertools
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import pvfiblets
from pvfiblets.support import memory
from tests.web import bombs

pytestmark = pytest.mark.more


def text_of(download):
    return download.value.path().read_text(encoding="utf-8")


def test_a_picture_is_saved_at_any_size(revisit):
    here = revisit("lines.fiblets")
    before = here.rests()
    here.page.click("[data-action=picture]")
    here.page.wait_for_selector("#dialog-picture")
    height, width = before.shape[:2]
    here.wait(lambda: here.page.input_value("#picture-width") == str(width), "the size of the view")
    here.page.click("[data-times='2']")
    here.wait(lambda: here.page.input_value("#picture-height") == str(2 * height), "twice the size")
    here.page.fill("#picture-width", "300")
    here.page.fill("#picture-height", "200")
    here.page.fill("#picture-dpi", "600")
    here.page.check("#picture-transparent")
    with here.page.expect_download() as download:
        here.page.click("[data-action=save-picture]")
    with Image.open(download.value.path()) as image:
        assert (image.size, image.mode) == ((300, 200), "RGBA")
        assert image.info["dpi"] == pytest.approx((600, 600), rel=1e-4)
        alpha = np.asarray(image)[..., 3]
    assert 0.01 < (alpha > 0).mean() < 0.9
    here.wait(lambda: not here.page.locator("#dialog-picture").is_visible(), "the dialog to close")
    assert np.abs(here.rests() - before).mean() < 0.5
    for field, text, said in (("width", "many", "width: 'many' is not a number"), ("height", "90000", "height")):
        here.page.click("[data-action=picture]")
        here.page.wait_for_selector("#dialog-picture")
        here.wait(lambda: here.page.input_value("#picture-width") == str(width), "the size of the view")
        here.page.fill(f"#picture-{field}", text)
        here.page.click("[data-action=save-picture]")
        here.wait(lambda said=said: said in here.toast(), "why there is no picture")
        here.press("Escape")
        here.wait(lambda: not here.page.locator("#dialog-picture").is_visible(), "the dialog to close")


def test_tables_profiles_and_named_files_are_fetched(revisit):
    here = revisit("lines.fiblets")
    here.page.click("[data-tool-button=box]")
    here.trace([(0.1, 0.1), (0.95, 0.95)])
    here.wait(lambda: here.state("selection")["count"] > 3, "a selection")
    count = here.state("selection")["count"]
    with here.page.expect_download() as download:
        here.page.click("[data-action=table-csv]")
    rows = list(csv.DictReader(io.StringIO(text_of(download))))
    assert len(rows) == count
    with here.page.expect_download() as download:
        here.page.click("[data-action=profile-csv]")
    assert len(text_of(download).splitlines()) == 101
    here.page.fill("[data-field=export-name]", "faisceau arqué")
    here.page.locator("[data-field=export-name]").blur()
    here.wait(lambda: here.state("export_name") == "faisceau arqué", "the name")
    here.page.click("[data-select=export_to] .v-field")
    here.page.click(".v-overlay--active .v-list-item:has-text('this computer')")
    here.page.click("[data-action=export]")
    here.page.click("[data-export='.trx']")
    here.wait(lambda: here.state("download").get("url"), "the file")
    with here.page.expect_download() as download:
        here.page.click("[data-action=download]")
    assert download.value.suggested_filename == "faisceau arqué.trx"
    place = here.served.root / "fetched.trx"
    download.value.save_as(place)
    assert len(pvfiblets.read(place)) == count
    place.unlink()


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
    here.wait(lambda: "clusters" in here.toast(), "how many there are")
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
    for k, name in enumerate(("3", "5")):
        label = "#pv-{} span:text-is('{}')".format
        row, column = (here.page.locator(label(side, name)).bounding_box() for side in ("rows", "columns"))
        assert row["y"] + row["height"] / 2 == pytest.approx(cells["y"] + (k + 0.5) / 2 * cells["height"], abs=1.5)
        assert row["x"] + row["width"] <= cells["x"]
        assert column["x"] + column["width"] / 2 == pytest.approx(cells["x"] + (k + 0.5) / 2 * cells["width"], abs=1.5)
        assert column["y"] + column["height"] <= cells["y"]
    here.page.evaluate(  # of many parcels there are as many names as there is room for
        "trame.state.set('matrix', {...trame.state.get('matrix'), names: [...Array(200).keys()].map(String)})"
    )
    here.page.wait_for_selector("#pv-rows span >> nth=5")
    boxes = [label.bounding_box() for label in here.page.locator("#pv-rows span").all()]
    assert 10 < len(boxes) < 60
    assert all(b["y"] - a["y"] >= 11.5 for a, b in itertools.pairwise(boxes))
    at = (cells["x"] + 0.75 * cells["width"], cells["y"] + 0.25 * cells["height"])
    here.page.mouse.move(*at)
    # Lines begin in 3, and of those that end in 5 the lengths are 15 to 30 mm.
    here.wait(lambda: here.page.locator("#pv-cell").inner_text() == "3 – 5: 16 streamlines", "what is told")
    here.page.mouse.click(*at)
    here.wait(lambda: here.state("matrix")["cell"] == "3 – 5", "its streamlines")
    beside, view = here.page.locator("#pv-cells").bounding_box(), here.page.locator("#pv-view").bounding_box()
    here.page.click("[data-action=matrix-alone]")
    here.page.wait_for_selector("#pv-matrix.pv-alone")
    alone, panel = (here.page.locator(one).bounding_box() for one in ("#pv-cells", "#pv-matrix"))
    assert alone["width"] == alone["height"] > 1.2 * beside["width"]
    assert panel["x"] <= view["x"]
    here.page.click("[data-action=matrix-alone]")
    here.page.wait_for_selector("#pv-matrix:not(.pv-alone)")
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
    here.page.click("[data-action=matrix]")
    here.page.click("[data-action=matrix-graph] input")
    here.wait(lambda: here.state("matrix")["graph"], "nodes and edges")
    here.press("Control+z")
    here.wait(lambda: not here.state("matrix")["graph"], "no nodes and edges")
    here.press("Control+y")
    here.page.click("[data-action=show-all-connections]")
    here.page.click("[data-action=eye]")  # leaves two balls, and the edge in the middle between them
    here.wait(lambda: here.state("matrix")["cell"] == "" and not here.state("layers")[0]["visible"], "the edge alone")
    here.press("1")
    here.page.click("[data-tool-button=pick]")
    alone = here.rests()
    down, across = np.argwhere(alone.max(axis=2) > 40).mean(axis=0) / alone.shape[:2]
    view = here.page.locator("#pv-view").bounding_box()
    here.page.mouse.click(view["x"] + across * view["width"], view["y"] + down * view["height"])
    here.wait(lambda: here.state("matrix")["cell"] == "3 – 5", "the cell of the edge")
    here.page.fill("[data-field=matrix-threshold]", "17")
    here.press("Tab")
    here.wait(lambda: here.state("undo_label") == "threshold of the matrix", "the threshold")


@pytest.mark.skipif(not memory.CAN_LIMIT, reason="only Linux limits the data of a process")
def test_bombs_are_refused_on_the_page_and_the_session_goes_on(visit):
    here = visit("lines.fiblets", "--max-memory", "768M")
    root = here.served.root
    process = re.findall(r"started as process (\d+)", here.served.log.read_text())[-1]
    limits = Path(f"/proc/{process}/limits").read_text()
    assert re.search(rf"^Max data size +{768 << 20} ", limits, re.MULTILINE)
    bombs.trk_of_one(root / "lines.trk.gz", 2000)
    bombs.nii(root / "scaled.nii.gz", 150, 2.0)
    for name, says in (("lines.trk.gz", "it says that it takes 2.0 GB"), ("scaled.nii.gz", "it needs more memory")):
        here.press("o")
        here.page.click(f"[data-entry='{name}']")
        here.wait(lambda name=name, says=says: f"{name} was not opened: {says}" in here.toast(), "a sentence")
        assert "of the 768 MB that a session may have" in here.toast()
        here.tab("filter")
        here.tab("clip")
        assert here.layers() == 1
        (root / name).unlink()
    before = here.rests()
    here.drag()
    here.changed(before)
    here.press("o")
    here.page.click("[data-entry='lines.trk']")
    here.wait(lambda: here.layers() == 2, "a file like any other")
