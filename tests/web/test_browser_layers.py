"""Volumes and meshes as layers of a page, in a real browser: opened, shown, changed, cut and removed."""

import numpy as np
import pytest

pytestmark = pytest.mark.more


def lit(picture):
    """Return how many pixels something is drawn in."""
    return int((picture.max(axis=2) > 40).sum())


def same(one, other):
    return one.shape == other.shape and np.abs(one - other).mean() < 0.5


def type_(here, name, text):
    here.page.fill(f"[data-property={name}] input.pv-num", text)
    here.press("Tab")
    here.page.evaluate("document.activeElement.blur()")  # the next field would take Control+z for itself


def colour(here, name, value):
    control = here.page.locator(f"[data-property={name}] input[type=color]")
    control.fill(value)
    control.dispatch_event("change")


def add(here, file, kind, before):
    """Open a file of the served folder as one more layer, and return the picture then."""
    count = here.layers()
    here.press("o")
    here.page.click(f"[data-entry='{file}']")
    here.wait(lambda: here.layers() == count + 1, f"the layer of {file}")
    assert here.state("layers")[-1]["kind"] == kind
    here.page.locator("[data-layer]").last.click()
    here.wait(lambda: here.state("chosen_name") == file, "its properties")
    return here.changed(before)


def hide_and_remove(here, before, shown):
    """Hide the chosen layer, show it again, and take it away; each is seen."""
    here.press("v")
    assert same(here.changed(shown), before)
    here.press("v")
    assert same(here.changed(before), shown)
    here.page.locator("[data-action=more]").last.click()
    here.page.click(".v-overlay--active .v-list-item:has-text('Remove')")
    here.wait(lambda: here.layers() == 1, "the layer to go")
    assert same(here.changed(shown), before)
    here.press("Control+z")
    here.wait(lambda: here.layers() == 2, "the layer again")
    assert same(here.changed(before), shown)


@pytest.fixture
def here(revisit):
    """A page of the lines, seen from the front."""
    found = revisit("lines.fiblets")
    found.press("2")
    found.wait(lambda: found.state("edges").get("top") == "S", "the view")
    found.rests()
    return found


def test_a_volume_is_a_layer(here):
    before = here.rests()
    shown = add(here, "head.nii.gz", "volume", before)
    assert lit(shown) > lit(before) + 2000  # a surface, where lines leave gaps
    colour(here, "color", "#ff2000")
    red = here.changed(shown)
    more = (np.abs(red - before).max(axis=2) > 24) & (red.max(axis=2) > 40)
    assert more.sum() > 2000
    assert (red[more][:, 0] > 2 * red[more][:, 2]).mean() > 0.95
    here.press("Control+z")
    assert same(here.changed(red), shown)
    # The volume's values fall from 1 in the middle.
    type_(here, "values", "0.6")
    small = here.changed(shown)
    assert lit(before) < lit(small) < lit(shown) - 500
    here.press("Control+z")
    here.changed(small)
    here.choose("mode", "greatest value")
    projected = here.changed(shown)
    assert len(np.unique(projected.reshape(-1, 3), axis=0)) > 30
    here.press("Control+z")
    assert same(here.changed(projected), shown)
    hide_and_remove(here, before, shown)


def test_several_files_are_chosen_and_opened_at_once(revisit):
    here = revisit("lines.fiblets")
    here.press("o")
    here.page.wait_for_selector("#dialog-open")
    here.page.check("[data-mark='ball.ply']")
    here.page.check("[data-mark='head.nii.gz']")
    here.page.check("[data-mark='atlas.nii.gz']")
    here.wait(lambda: len(here.state("marked")) == 3, "three chosen")
    here.page.uncheck("[data-mark='atlas.nii.gz']")
    here.wait(lambda: len(here.state("marked")) == 2, "two chosen")
    here.page.click("[data-action=open-marked]")
    here.wait(lambda: here.layers() == 3, "both files")
    assert [layer["name"] for layer in here.state("layers")] == ["lines.fiblets", "ball.ply", "head.nii.gz"]
    assert here.state("chosen_name") == "lines.fiblets"
    here.tab("clip")
    here.page.click("[data-cut=mesh]")
    here.page.wait_for_selector("#dialog-open")
    here.wait(lambda: here.state("several") is False, "one file for a cut")
    assert here.page.locator("[data-mark]").count() == 0


@pytest.mark.parametrize("width", [1280, 390])
def test_values_along_bundles_are_plotted_beside_the_picture(visit, width):
    here = visit("lines.fiblets", width=width, height=800)
    (here.served.root / "fa.csv").write_text("bundle,mean\nnear,1\nnear,3\nfar,5\nfar,4\n")
    here.press("o")
    here.page.click("#dialog-open .v-list-item:has-text('fa.csv')")
    here.page.evaluate("window.trame.state.update({right_open: true, tab: 'bundles'})")
    chart = here.page.get_by_role("img", name="fa along near, far")
    chart.wait_for()
    here.stands()
    box = chart.bounding_box()
    assert box["width"] >= 280
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= width
    letters = chart.locator("text").first.evaluate("(one) => one.getBoundingClientRect().height")
    assert letters >= 10
    here.press("Control+z")
    here.wait(lambda: chart.count() == 0, "no chart")
