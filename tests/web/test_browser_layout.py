"""What lies where on a page of 1280 by 720 pixels, in a real browser."""

from __future__ import annotations

import itertools

import pytest

CUT_OFF = """() => {
    const found = [];
    for (const root of document.querySelectorAll('header, #left, #right, .v-dialog .v-card, #busy')) {
        const inside = root.getBoundingClientRect();
        if (!inside.width) continue;
        if (root.scrollWidth > root.clientWidth + 1) found.push(`${root.id || root.tagName} scrolls sideways`);
        for (const part of root.querySelectorAll('button, input, label, .v-field, .v-slider, .pv-value, td, th')) {
            const box = part.getBoundingClientRect();
            if (!box.width || part.closest('[hidden]')) continue;
            if (box.left < inside.left - 1 || box.right > inside.right + 1)
                found.push(`${part.outerHTML.slice(0, 90)} sticks out of ${root.id || root.tagName}`);
            if (part.matches('label, .v-btn, .pv-value') && part.scrollWidth > part.clientWidth + 1)
                found.push(`${part.innerText} is cut off in ${root.id || root.tagName}`);
        }
    }
    if (document.documentElement.scrollWidth > innerWidth) found.push('the page scrolls sideways');
    if (document.documentElement.scrollHeight > innerHeight) found.push('the page scrolls');
    return found;
}"""


def overlap(one, other):
    across = min(one["x"] + one["width"], other["x"] + other["width"]) - max(one["x"], other["x"])
    down = min(one["y"] + one["height"], other["y"] + other["height"]) - max(one["y"], other["y"])
    return across > 1 and down > 1


def boxes(here, selector):
    found = here.page.locator(selector).all()
    return [box for part in found if part.is_visible() and (box := part.bounding_box()) is not None]


def fits(here):
    assert here.page.evaluate(CUT_OFF) == []
    for place in ("header .v-btn, header label", ".pv-tools .v-btn, .pv-edge, .pv-status"):
        found = boxes(here, place)
        assert len(found) > 3
        assert not any(overlap(one, other) for one, other in itertools.combinations(found, 2))


@pytest.mark.parametrize("width", [1280, 820])
def test_nothing_overlaps_or_is_cut_off(visit, width):
    here = visit("lines.fiblets", "--volume", "head.nii.gz", width=width, height=720)
    here.wait(lambda: here.layers() == 2, "the volume")
    here.rests()
    if width < 1100:
        here.wait(lambda: not here.state("right_open"), "the panels to close")
        fits(here)
        here.press("[")
        here.page.wait_for_timeout(500)  # they slide
        fits(here)
        return
    for key in ("1", "4"):
        here.press(key)
        here.rests()
        fits(here)
    here.page.click("[data-layer] .v-list-item-title >> nth=0")
    here.choose("scalars", "fa")
    here.page.fill("[data-property=tube_radius] input", "0.5")
    here.press("Tab")
    for kind in ("plane", "slab", "box", "sphere"):
        here.page.click(f"[data-cut={kind}]")
    here.wait(lambda: len(here.state("clips")) == 4, "four cuts")
    fits(here)
