"""Fingers on a tablet, in a real browser."""

import time

import numpy as np
import pytest

pytestmark = pytest.mark.more

SLOW = 0.06  # seconds from touch to touch, by what they say: faster ones end as a throw, which the next tap stops


class Fingers:
    """Touches of a page, as shares of the picture's width and height."""

    def __init__(self, here):
        self.page = here.page
        self.devtools = here.context.new_cdp_session(here.page)
        self.box = here.page.locator("#pv-view").bounding_box()

    def _send(self, kind, places, when):
        points = [
            {"x": self.box["x"] + x * self.box["width"], "y": self.box["y"] + y * self.box["height"], "id": k}
            for k, (x, y) in enumerate(places)
        ]
        self.devtools.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points, "timestamp": when})
        self.page.evaluate("() => new Promise(requestAnimationFrame)")

    def move(self, *paths, steps=8):
        """Put a finger at the beginning of each path, from one place to another, and move all at once."""
        paths = np.array(paths, float)
        start, *middle, end = time.time() + SLOW * np.arange(-steps - 1, 1)
        self._send("touchStart", paths[:, 0], start)
        for share, when in zip(np.linspace(0.0, 1.0, steps + 1)[1:], middle, strict=True):
            self._send("touchMove", (1.0 - share) * paths[:, 0] + share * paths[:, 1], when)
        self._send("touchEnd", [], end)


def tablet(revisit):
    here = revisit("lines.fiblets", width=820, height=1180, has_touch=True, is_mobile=True)
    here.wait(lambda: here.page.locator("#pv-view").bounding_box()["width"] >= 800, "the panels to close")
    here.wait(lambda: here.picture().shape[1] >= 800, "a picture of that width")
    return here, here.rests()


def extent(picture):
    """Return how wide what is drawn is, in pixels."""
    columns = np.flatnonzero((picture.max(axis=2) > 60).any(axis=0))
    return columns[-1] - columns[0]


def test_one_finger_turns_and_two_zoom(revisit):
    here, before = tablet(revisit)
    assert before.shape[1] >= 800
    fingers = Fingers(here)
    edges = here.state("edges")
    fingers.move([(0.3, 0.5), (0.75, 0.55)])
    turned = here.changed(before)
    assert here.state("edges") != edges
    here.press("1")
    flat = here.changed(turned)
    fingers.move([(0.3, 0.5), (0.4, 0.5)], [(0.7, 0.5), (0.6, 0.5)])
    small = here.changed(flat)
    assert abs(extent(small) / extent(flat) - 0.5) < 0.15  # the fingers end at half the distance
    assert here.page.evaluate("window.visualViewport.scale") == 1.0  # the picture was zoomed, not the page


def test_fingers_select_and_panels_open_over_the_picture(revisit):
    here, before = tablet(revisit)
    here.press("1")
    here.changed(before)
    here.page.tap("[data-tool-button=box]")
    here.page.wait_for_selector("#pv-over[data-tool=box]")
    Fingers(here).move([(0.98, 0.98), (0.02, 0.02)])
    here.wait(lambda: here.state("selection")["count"] > 9, "selected lines")
    here.page.wait_for_selector("#picked tbody tr")  # the panel has come
    here.stands()
    assert abs(here.page.locator("#right").bounding_box()["x"] + 328 - 820) < 1
    here.page.touchscreen.tap(100, 600)  # beside it
    here.wait(lambda: not here.state("right_open"), "the panel to go")


# Replies wait in the browser while window.late is a list.
LATE = """
window.late = null;
window.WebSocket = class extends WebSocket {
  set onmessage(take) { super.onmessage = (event) => window.late ? window.late.push(() => take(event)) : take(event) }
};
"""
ARRIVE = "() => { const all = window.late; window.late = null; for (const one of all) one() }"


def opened(visit):
    """Open a page whose replies can be made late, with slices."""
    here = visit("lines.fiblets", opened=False)
    here.page.add_init_script(LATE)
    here.open()
    here.tab("slices")
    here.page.click("[data-action=open-slices]")
    here.page.click("#dialog-open .v-list-item:has-text('head.nii.gz')")
    here.wait(lambda: here.state("slicing")["shown"], "slices")
    here.rests()
    return here


def test_a_late_reply_leaves_what_is_typed(visit):
    here = opened(visit)
    fields = [here.page.locator(f"[data-place=position] input >> nth={axis}") for axis in range(3)]
    told = lambda: [float(part) for part in here.state("slicing")["position"]]  # noqa: E731
    # The first is on its way while the second is typed, and arrives before it is left.
    here.page.evaluate("window.late = []")
    fields[0].fill("20")
    here.press("Tab")
    here.page.keyboard.type("2")
    here.wait(lambda: here.page.evaluate("window.late.length"), "a reply")
    assert fields[0].input_value() == "20"  # not what was there before
    here.page.evaluate(ARRIVE)
    here.wait(lambda: told()[0] == 20.0 and fields[0].input_value() == "20.0", "the first")
    assert fields[1].input_value() == "2"
    here.page.keyboard.type("4")
    here.press("Tab")
    here.wait(lambda: told()[1] == 24.0 and fields[1].input_value() == "24.0", "the second")
    # Escape gives back what the server has, the newest, and sends nothing.
    before = fields[2].input_value()
    fields[2].fill("1")
    here.press("Escape")
    assert fields[2].input_value() == before
    fields[2].fill("12 mm")
    here.page.evaluate("window.trame.trigger('step_slice', [0.1, 0.1, 0, 0, 1])")
    here.wait(lambda: any(f"{told()[axis]:.1f}" != was for axis, was in enumerate(["20.0", "24.0", before])), "a step")
    assert fields[2].input_value() == "12 mm"
    at = told()
    here.press("Escape")
    assert fields[2].input_value() == f"{at[2]:.1f}"
    here.press("Tab")
    here.rests()
    assert told() == at
    # A value that is refused is not left standing; nor is one that the server has already.
    here.page.click("[data-action=panes]")
    radius = here.page.locator("input[aria-label='Slab, mm']")
    usual = radius.input_value()
    for text in ("-5", f" {usual} mm"):
        radius.fill(text)
        here.press("Enter")
        here.wait(lambda: radius.input_value() == usual, "the value as it was")
