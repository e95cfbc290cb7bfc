"""Slices beside the 3-D view, in a real browser."""

from __future__ import annotations

import json

import numpy as np


def told(here):
    """Return the cross-hair in mm."""
    return [float(part) for part in here.state("slicing")["position"]]


def sliced(here, name="head.nii.gz"):
    """Open an image as slices, by the tab."""
    here.tab("slices")
    here.page.click("[data-action=open-slices]")
    here.page.click(f"#dialog-open .v-list-item:has-text('{name}')")
    here.wait(lambda: here.state("slicing")["shown"], "slices")
    here.rests()


def click(here, name, across, down):
    """Click in a view, at shares of it from its upper left."""
    view = next(one for one in here.state("slicing")["boxes"] if one["name"] == name)
    box = here.page.locator("#pv-view").bounding_box()
    x, y = view["x"] + across * view["w"], view["y"] + down * view["h"]
    here.page.mouse.click(box["x"] + x * box["width"], box["y"] + y * box["height"])


def test_a_t1_is_opened_gone_through_and_found_again(visit):
    here = visit("lines.fiblets")
    before = here.picture()
    sliced(here)
    assert here.state("slicing")["layout"] == "beside"
    picture = here.changed(before)
    width = picture.shape[1]
    right = picture[:, int(0.75 * width) :]
    assert (right.min(axis=2) > 60).any()  # grey of the image, in the panes
    # A click moves the cross-hair within the pane's plane; the patient's left is on the right.
    start = told(here)
    click(here, "axial", 0.6, 0.4)
    here.wait(lambda: told(here) != start, "another position")
    moved = told(here)
    assert moved[0] < start[0]
    assert moved[1] > start[1]
    assert moved[2] == start[2]
    here.page.mouse.wheel(0, -120)
    here.wait(lambda: told(here)[2] != start[2], "another slice")
    assert abs(told(here)[2] - start[2]) == 4.0  # mm: a voxel
    here.press("ArrowUp")
    here.wait(lambda: told(here)[1] == moved[1] + 4.0, "a step forward")
    # Go to a point.
    for axis, text in enumerate(("20", "24,0", "28 mm")):
        here.page.fill(f"[data-place=position] input >> nth={axis}", text)
        here.press("Tab")
    here.wait(lambda: told(here) == [20.0, 24.0, 28.0], "the point")
    here.rests()
    assert here.state("slicing")["voxel"] == ["5", "6", "7"]
    # x = 2 i / 15 - 1 along each axis of the image's 16 voxels.
    value = 1.0 - np.linalg.norm(2.0 * np.array([5, 6, 7]) / 15.0 - 1.0)
    under = here.page.locator("[data-under='head.nii.gz'] .pv-value").inner_text()
    assert abs(float(under) - value) < 1e-3
    # One slice large, and back.
    here.page.click("[data-action=layouts]")
    here.page.click("[data-layout=coronal]")
    here.wait(lambda: [one["name"] for one in here.state("slicing")["boxes"]] == ["coronal"], "one view")
    here.rests()
    here.press("x")
    here.wait(lambda: here.state("slicing")["layout"] == "beside", "all views")
    here.rests()
    # Reload, and from a session.
    here.page.reload()
    here.ready()
    assert told(here) == [20.0, 24.0, 28.0]
    text = here.page.evaluate("window.trame.trigger('save_session')")
    assert json.loads(text)["slices"]["position"] == [20.0, 24.0, 28.0]
    here.press("Control+z")
    here.wait(lambda: not here.state("slicing")["shown"], "no slices")
    here.page.evaluate("(text) => window.trame.trigger('load_session', [text])", text)
    here.wait(lambda: here.state("slicing")["shown"], "slices again")
    assert told(here) == [20.0, 24.0, 28.0]
