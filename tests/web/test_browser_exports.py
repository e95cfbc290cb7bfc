"""What a page gives away: pictures of any size, tables, profiles and streamlines, in a real browser."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest
from PIL import Image

import pvfiblets

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
