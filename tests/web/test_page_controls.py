"""Controls of the page in a real browser that act before they are let go, or whose effect outlives the page."""

import numpy as np
import pytest


def test_a_slider_acts_while_it_is_held_and_is_one_step(visit):
    here = visit("lines.fiblets")
    here.press("2")
    before = here.rests()
    thumb = here.page.locator("[data-property=opacity] [role=slider]")
    number = here.page.locator("[data-property=opacity] input.pv-num")
    box = thumb.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    here.page.mouse.move(x, y)
    here.page.mouse.down()
    for step in range(1, 8):
        was = thumb.get_attribute("aria-valuenow")
        here.page.mouse.move(x - 8 * step, y)
        here.wait(lambda was=was: thumb.get_attribute("aria-valuenow") != was, "the thumb to follow")
    dimmed = here.changed(before)  # the button is still down
    held = float(thumb.get_attribute("aria-valuenow"))
    assert held < 0.7
    here.wait(lambda: float(number.input_value()) == held, "the number of where the thumb is")
    assert dimmed.max(axis=2).mean() < before.max(axis=2).mean()
    here.page.mouse.up()
    here.wait(lambda: here.state("held") == {}, "the page to be in step")
    assert float(thumb.get_attribute("aria-valuenow")) == held
    thumb.focus()
    here.press("ArrowRight")
    here.wait(lambda: float(number.input_value()) > held, "what a key does")
    while here.state("undo_label").startswith("opacity"):  # keys a second later are a step of their own
        before_undo = number.input_value()
        here.page.click("[data-action=undo]")
        here.wait(lambda shown=before_undo: number.input_value() != shown, "an undo")
    assert float(number.input_value()) == 1.0
    assert np.abs(here.changed(dimmed) - before).mean() < 0.5


def test_light_or_dark_and_sessions_outlive_the_page(visit):
    here = visit("lines.fiblets")
    here.rests()
    assert here.state("dark") is True
    here.press("t")
    here.wait(lambda: here.page.evaluate("localStorage.getItem('pvfiblets-dark')") == "false", "light to be kept")
    here.choose("scalars", "length")
    here.rests()
    here.press("s")
    here.page.fill("#dialog-session input.pv-num", "kept here")
    here.page.click("[data-action=store-session]")
    here.wait(lambda: "saved in the served folder as kept here.json" in here.toast(), "where it is")
    assert (here.served.root / "kept here.json").is_file()
    here.choose("scalars", "orientation")
    here.page.goto("about:blank")  # a page whose session has ended complains
    here.context.request.post(f"{here.served.base}/end", headers={"Origin": here.served.base})
    here.context.clear_cookies()
    here.open()  # another session in the same browser
    here.wait(lambda: here.state("dark") is False, "the light page")
    here.press("o")
    here.page.click("[data-entry='kept here.json']")
    here.wait(lambda: here.state("undo_label") == "open a session", "the session")
    here.page.wait_for_selector("[data-property=scalars]:has-text('length')")


@pytest.mark.more
def test_streamlines_are_exported_to_this_computer_alone(visit):
    import pvfiblets

    here = visit("lines.fiblets")
    here.rests()
    before = sorted(here.served.root.iterdir())
    here.tab("selection")
    for key, title in (("export_what", "all streamlines"), ("export_to", "this computer")):
        here.page.click(f"[data-select={key}] .v-field")
        here.page.click(f".v-overlay--active .v-list-item:has-text('{title}')")
    here.page.click("[data-action=export]")
    here.page.click("[data-export='.tck']")
    with here.page.expect_download() as download:
        here.page.click("[data-action=download]")
    assert download.value.suggested_filename == "lines.tck"
    copy = here.served.root.parent / "copy.tck"
    download.value.save_as(copy)
    assert len(pvfiblets.read(copy)) == 60
    assert sorted(here.served.root.iterdir()) == before
