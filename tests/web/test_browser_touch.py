"""Fingers on a tablet, in a real browser."""

from __future__ import annotations

import numpy as np
import pytest

pytestmark = pytest.mark.more


class Fingers:
    """Touches of a page, as shares of the picture's width and height."""

    def __init__(self, here):
        self.page = here.page
        self.devtools = here.context.new_cdp_session(here.page)
        self.box = here.page.locator("#pv-view").bounding_box()

    def _send(self, kind, places):
        points = [
            {"x": self.box["x"] + x * self.box["width"], "y": self.box["y"] + y * self.box["height"], "id": k}
            for k, (x, y) in enumerate(places)
        ]
        self.devtools.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        self.page.wait_for_timeout(40)  # a hand is slower than a script

    def move(self, *paths, steps=8):
        """Put a finger at the beginning of each path, from one place to another, and move all at once."""
        paths = np.array(paths, float)
        self._send("touchStart", paths[:, 0])
        for share in np.linspace(0.0, 1.0, steps + 1)[1:]:
            self._send("touchMove", (1.0 - share) * paths[:, 0] + share * paths[:, 1])
        self._send("touchEnd", [])


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
    here.wait(lambda: abs(here.page.locator("#right").bounding_box()["x"] + 328 - 820) < 1, "the panel to stand still")
    here.page.touchscreen.tap(100, 600)  # beside it
    here.wait(lambda: not here.state("right_open"), "the panel to go")
