"""Pages of ``pvfiblets serve`` in a real browser."""

import numpy as np
import pytest

from tests.web.browsing import HELD_BACK, SESSION

pytestmark = pytest.mark.more


def test_a_page_opens_turns_and_rests(revisit):
    here = revisit("lines.fiblets")
    assert here.state("layers")[0]["name"] == "lines.fiblets"
    before = here.rests()
    assert before.shape[0] > 400  # as large as the place for it
    here.drag()
    after = here.changed(before)
    assert after.shape == before.shape
    # At rest nothing is drawn and nothing is sent but answers.
    count, frame, known = here.pictures, here.state("frame"), len(here.received)
    for _ in range(5):
        here.page.evaluate(HELD_BACK)
        here.page.evaluate(SESSION)
    assert here.pictures == count
    assert len(here.received) == known + 5
    assert here.state("frame") == frame
    # Everything comes from the server itself.
    assert all(url.startswith((here.served.base, "blob:", "data:")) for url in here.requests)
    assert not any("token=" in url for url in here.requests[1:])
    assert "token" not in here.page.url


def test_pictures_are_coarse_in_motion_and_fine_at_rest(revisit):
    here = revisit("lines.fiblets")
    here.rests()
    here.page.evaluate(
        """() => { window.sizes = []; const real = URL.createObjectURL;
            URL.createObjectURL = (blob) => { window.sizes.push(blob.size); return real.call(URL, blob); }; }"""
    )
    here.drag(steps=20)
    here.rests()
    sizes = here.page.evaluate("window.sizes")
    assert len(sizes) >= 2
    assert sizes[-1] > 1.5 * min(sizes[:-1])


def test_properties_change_the_picture_and_are_undone(revisit):
    here = revisit("lines.fiblets")
    here.press("2")
    first = here.rests()
    here.choose("scalars", "length")
    coloured = here.changed(first)
    assert here.page.locator("[data-property=clim] .pv-chart, [data-property=clim] svg").count()
    here.page.fill("[data-property=line_width] input.pv-num", "6")
    here.press("Tab")
    wide = here.changed(coloured)
    assert (wide.max(axis=2) > 40).sum() > 1.5 * (coloured.max(axis=2) > 40).sum()
    here.page.click("[data-action=undo]")
    here.page.click("[data-action=undo]")
    assert np.abs(here.changed(wide) - first).mean() < 0.5
    here.page.fill("[data-property=line_width] input.pv-num", "a lot")
    here.press("Tab")
    here.wait(lambda: "not a number" in here.toast(), "a sentence on what was typed")
    width = "[data-property=line_width] input.pv-num"
    here.wait(lambda: here.page.input_value(width) == "1", "the width that there is")


def test_layers_are_hidden_renamed_duplicated_and_removed(revisit):
    here = revisit("lines.fiblets")
    full = here.rests()
    here.page.click("[data-action=eye]")
    here.wait(lambda: here.picture().std() < 0.5, "an empty picture")
    here.page.click("[data-action=eye]")
    here.changed(np.zeros_like(full))
    here.page.click("[data-action=more]")
    here.page.click(".v-overlay--active .v-list-item:has-text('Rename')")
    here.page.fill("#rename", "corticospinal")
    here.press("Enter")
    here.wait(lambda: here.state("layers")[0]["name"] == "corticospinal", "the new name")
    here.page.click("[data-action=more]")
    here.page.click(".v-overlay--active .v-list-item:has-text('Duplicate')")
    here.wait(lambda: here.layers() == 2, "a second layer")
    here.press("Delete")
    here.wait(lambda: here.layers() == 1, "one layer")


def test_cuts_and_filters_leave_less_to_see(revisit):
    here = revisit("lines.fiblets")
    here.press("2")
    full = here.rests()

    def lit(picture):
        return (picture.max(axis=2) > 40).mean()

    here.page.click("[data-cut=plane]")
    cut = here.changed(full)
    assert 0.2 < lit(cut) / lit(full) < 0.9
    here.page.click("[data-clip] [data-action=side]")
    other = here.changed(cut)
    assert abs(lit(cut) + lit(other) - lit(full)) < 0.25 * lit(full)
    here.press("Control+z")
    here.press("Control+z")
    here.changed(other)
    here.tab("filter")
    here.page.click("#tab-filter .v-select:has(#add-criterion) .v-field")
    here.page.click(".v-overlay--active .v-list-item:has-text('length')")
    least = here.page.locator("[data-criterion=length] input.pv-num").first
    least.fill("40.5")
    here.press("Tab")
    # Lines of 10 to 69 mm, one of each length.
    here.wait(lambda: here.page.inner_text("[data-value=counted]") == "29 of 60 streamlines", "29 streamlines")
    assert lit(here.rests()) < 0.9 * lit(full)


def test_what_is_picked_fills_the_table_and_is_exported(revisit):
    import pvfiblets

    here = revisit("lines.fiblets")
    here.press("2")
    before = here.rests()
    here.press("b")
    here.page.wait_for_selector("#pv-over[data-tool=box]")
    here.drag((0.15, 0.02), (0.98, 0.5))
    here.wait(lambda: here.state("selection")["count"] > 0, "a selection")
    here.changed(before)
    count = here.state("selection")["count"]
    assert here.page.locator("#picked tbody tr").count() == count
    assert here.page.locator("#profile svg").count() == 1
    here.page.click("[data-action=export]")
    here.page.click("[data-export='.trk']")
    here.page.wait_for_selector("[data-action=download]")
    with here.page.expect_download() as download:
        here.page.click("[data-action=download]")
    path = here.served.root / download.value.suggested_filename
    assert path.read_bytes() == download.value.path().read_bytes()
    assert len(pvfiblets.read(path)) == count


def test_sessions_are_saved_loaded_and_survive_a_reload(revisit):
    here = revisit("lines.fiblets")
    first = here.rests()
    here.choose("scalars", "length")
    coloured = here.changed(first)
    here.press("1")
    kept = here.changed(coloured)
    here.press("s")
    with here.page.expect_download() as download:
        here.page.click("[data-action=save-session]")
    file = here.served.root / "kept.json"
    download.value.save_as(file)
    here.page.keyboard.press("Escape")
    here.page.reload()
    here.ready()
    assert np.abs(here.rests() - kept).mean() < 0.5
    here.choose("scalars", "orientation")
    here.press("2")
    other = here.changed(kept)
    file.write_text(file.read_text() + " " * 1_500_000)  # more than a message may have
    here.press("s")
    here.page.set_input_files("[data-session]", file)
    assert np.abs(here.changed(other) - kept).mean() < 0.5
    file.write_text('{"version": 1, "layers": "none"}')
    here.press("s")
    here.page.set_input_files("[data-session]", file)
    here.wait(lambda: here.state("toast_open") and "program" in here.toast(), "why it is no session")
    here.page.evaluate("document.querySelector('[data-session]').dataset.limit = 20")
    here.press("s")
    here.page.set_input_files("[data-session]", file)
    here.wait(lambda: "session files have" in here.toast(), "that it is too large")
    here.press("Escape")
    assert np.abs(here.rests() - kept).mean() < 0.5


def test_files_are_opened_uploaded_and_refused(revisit, tmp_path, lines):
    import pvfiblets

    here = revisit("lines.fiblets")
    here.press("o")
    here.page.click("[data-entry='ball.ply']")
    here.wait(lambda: here.layers() == 2, "the mesh")
    assert here.state("layers")[1]["kind"] == "mesh"
    (here.served.root / "bad.trk").write_bytes(b"TRACK" + bytes(2000))
    here.press("o")
    here.page.click("[data-entry='bad.trk']")
    here.wait(lambda: "bad.trk" in here.toast(), "why it was not opened")
    assert here.layers() == 2
    pvfiblets.write(tmp_path / "sent.tck", lines)
    here.press("o")
    here.page.set_input_files("[data-upload]", tmp_path / "sent.tck")
    here.wait(lambda: here.layers() == 3, "the upload")
    assert (here.served.root / "sent.tck").read_bytes() == (tmp_path / "sent.tck").read_bytes()
