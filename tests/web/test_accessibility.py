"""Pages in axe-core, which checks what screen readers, keys and people with weak eyes need."""

from pathlib import Path

import pytest

pytestmark = pytest.mark.more

AXE = Path(__file__).parents[2] / "client/node_modules/axe-core/axe.min.js"
RUN = """() => axe.run(document, {resultTypes: ['violations']}).then((found) => found.violations
    .filter((one) => ['serious', 'critical'].includes(one.impact))
    .map((one) => [one.id, ...one.nodes.slice(0, 5).map((node) => node.html.slice(0, 300))].join('\\n  ')))"""


LOST = """() => [...document.querySelectorAll('[aria-labelledby]')]
    .filter((one) => one.getAttribute('aria-labelledby').split(' ').some((id) => !document.getElementById(id)))
    .map((one) => one.outerHTML.slice(0, 300))"""
"""Parts of a page that are named by what is not there, which axe-core leaves to people."""


def faults(here, where):
    """Return the serious findings of the page as it is."""
    here.stands()
    return [f"{where}: {one}" for one in here.page.evaluate(RUN) + here.page.evaluate(LOST)]


@pytest.fixture
def here(visit):
    """Return a page with lines and an image, and axe-core in it."""
    if not AXE.is_file():
        pytest.skip("there is no axe-core: scripts/axe.sh installs it")
    here = visit("lines.fiblets", "--volume", "head.nii.gz", width=1280, height=800)
    here.wait(lambda: here.layers() == 2, "both layers")
    here.page.evaluate(AXE.read_text(encoding="utf-8"))
    return here


def test_an_input_without_a_name_is_found(here):
    here.page.evaluate("document.querySelector('#pv-view').append(document.createElement('input'))")
    assert any("label" in one for one in faults(here, "page"))


def test_no_tab_has_a_serious_fault(here):
    here.page.click("text=lines.fiblets")
    here.page.click("[data-action=expert]")
    here.page.click("[data-view=axial]")
    here.rests()
    here.page.click("[data-tool-button=box]")
    here.page.wait_for_selector("#pv-over[data-tool=box]")
    here.trace([(0.98, 0.98), (0.1, 0.02)])
    here.wait(lambda: here.state("selection")["count"], "a selection")
    here.press("Escape")
    found = faults(here, "selection")
    here.tab("clip")
    here.page.click("[data-cut=plane]")
    here.wait(lambda: here.state("clips"), "a cut")
    found += faults(here, "clip")
    here.tab("filter")
    here.page.click("[data-region=sphere]")
    here.wait(lambda: here.state("filters")["regions"], "a region")
    found += faults(here, "filter")
    for name in ("bundles", "info"):
        here.tab(name)
        found += faults(here, name)
    here.tab("slices")
    here.page.click("[data-action=slices-of-volume]")
    here.wait(lambda: here.state("slicing")["shown"], "slices")
    here.page.click("[data-action=add-painted]")
    here.wait(lambda: here.state("painting")["regions"], "a painted region")
    here.page.click("[data-action=panes]")
    found += faults(here, "slices")
    here.page.click("[data-layer]:has-text('head.nii.gz 2')")
    here.wait(lambda: here.state("chosen_kind") == "image", "the image's settings")
    found += faults(here, "settings of an image")
    here.page.click("[data-action=matrix]")
    here.wait(lambda: here.state("matrix")["open"], "the matrix")
    found += faults(here, "matrix")
    for name in ("open", "session", "picture", "script", "help", "rename", "end"):
        here.page.evaluate(f"window.trame.state.set('dialog', '{name}')")
        here.page.wait_for_selector(f"#dialog-{name}")
        found += faults(here, f"dialog {name}")
        here.press("Escape")
        here.page.wait_for_selector(f"#dialog-{name}", state="hidden")
    assert "\n".join(found) == ""


@pytest.mark.parametrize(
    ("name", "state"), [("busy", {"job": {"text": "compiling", "share": -1.0}}), ("uploading", {"uploading": "a.trk"})]
)
def test_progress_has_a_name(here, name, state):
    here.wait(lambda: not here.state("job").get("text"), "no other work")
    here.page.evaluate("(state) => window.trame.state.update(state)", state)
    here.page.wait_for_selector(f"#{name}")
    assert faults(here, name) == []


def test_the_page_may_be_zoomed_and_its_picture_has_a_name(here):
    assert "maximum-scale" not in here.page.locator("meta[name=viewport]").get_attribute("content")
    assert here.page.get_by_role("img", name="Rendered scene").first.is_visible()
    colours = here.page.get_by_role("combobox", name="Colour by")
    assert colours.count() == 1
    here.page.click("[data-property=scalars] .v-field")
    here.page.get_by_role("listbox", name="Colour by").wait_for()
    assert faults(here, "open list") == []
