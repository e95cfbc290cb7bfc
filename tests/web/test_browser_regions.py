"""Streamlines through A and not through B, in a real browser."""

from __future__ import annotations

import json

import numpy as np

from tests.web.browsing import QUIET


def passing(lines, sphere):
    """Say of each streamline whether its polyline meets a sphere, by the nearest point of every segment."""
    centre = np.array(sphere["center"])
    found = []
    for first, last in zip(lines.offsets[:-1], lines.offsets[1:], strict=True):
        a, b = lines.points[first : last - 1].astype(float), lines.points[first + 1 : last].astype(float)
        share = ((centre - a) * (b - a)).sum(1) / ((b - a) ** 2).sum(1)
        near = a + np.clip(share, 0.0, 1.0)[:, None] * (b - a)
        found.append(np.linalg.norm(near - centre, axis=1).min() <= sphere["radius"])
    return np.array(found)


def spheres(here):
    layer = json.loads(here.page.evaluate("window.trame.trigger('save_session')"))["layers"][0]
    parts = layer.get("filters", {}).get("regions", {"of": []})["of"]
    return [(part["of"][0] if part.get("op") == "not" else part)["region"] for part in parts]


def drag(here, handle, by):
    box = here.page.locator(handle).bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    here.page.mouse.move(x, y)
    here.page.mouse.down()
    here.page.mouse.move(x + by[0], y + by[1], steps=6)
    here.page.mouse.up()
    here.page.wait_for_timeout(QUIET)


def test_through_a_and_not_through_b(visit, lines):
    here = visit("lines.fiblets")
    here.press("1")
    here.rests()
    counted = here.page.locator("[data-value=counted]")
    here.tab("filter")
    here.page.click("[data-region=sphere]")
    here.page.wait_for_selector("[data-handle=center][data-row='0']")
    before = spheres(here)[0]
    drag(here, "[data-handle=center][data-row='0']", (-60, 30))
    a = spheres(here)[0]
    assert a["name"] == "A"
    assert a["center"][0] < before["center"][0]  # seen from above, x goes to the right and y up
    assert a["center"][1] < before["center"][1]
    assert abs(a["center"][2] - before["center"][2]) < 1e-3
    drag(here, "[data-handle=radius][data-row='0']", (20, 0))
    assert spheres(here)[0]["radius"] > a["radius"]
    # One drag is one step.
    here.press("Control+z")
    here.wait(lambda: spheres(here)[0] == a, "the radius of before")
    # B lies beside A, is put on a line by a click, and is typed.
    here.page.click("[data-region=sphere]")
    here.page.wait_for_selector("[data-handle=center][data-row='1']")
    second = "[data-region-row='1'] "
    here.page.click(second + "[data-action=place]")
    here.page.wait_for_selector("#pv-over[data-tool=place]")
    lit = np.argwhere(here.rests().max(axis=2) > 60)
    row, column = lit[len(lit) // 2]
    height, width = here.picture().shape[:2]
    here.trace([(column / width, row / height)])
    here.wait(lambda: here.state("tool") == "rotate", "the place to be taken")
    b = spheres(here)[1]
    near = np.linalg.norm(lines.points - b["center"], axis=1).min()
    assert near < 1.0  # mm: it lies on a streamline
    here.page.fill(second + "[data-control=radius] input.pv-num", "4.5 mm")
    here.press("Tab")
    here.page.fill(second + "[data-field=name]", "<b>B</b>")
    here.press("Tab")
    here.page.click(second + "button:has-text('not')")
    sentence = here.page.locator("[data-value=sentence]")
    here.wait(lambda: sentence.inner_text() == "through A and not through <b>B</b>", "both regions in words")
    assert here.page.locator(".pv-mark-name b").count() == 0  # a name is text
    one, other = spheres(here)
    assert other["radius"] == 4.5
    expected = int((passing(lines, one) & ~passing(lines, other)).sum())
    here.wait(lambda: counted.inner_text() == f"{expected} of 60 streamlines", f"{expected} streamlines")
    here.page.click("[data-action=show-regions]")
    here.wait(lambda: here.page.locator("#pv-marks").count() == 0, "no regions in the picture")
    here.page.reload()
    here.ready()
    here.wait(lambda: len(spheres(here)) == 2, "the regions after a reload")
