"""Slices beside the 3-D view, in a real browser."""

import json
import shutil

import numpy as np
import pytest

from pvfiblets.web.panels.dialogs import KEYS
from tests.web.browsing import LOAD

pytestmark = pytest.mark.more


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
    if here.state("slicing")["layout"] != "beside":  # a page that tests share keeps what the one before chose
        here.page.evaluate("window.trame.trigger('set_layout', ['beside'])")
        views = {"axial", "coronal", "sagittal"}
        here.wait(lambda: views <= {one["name"] for one in here.state("slicing")["boxes"]}, "all views")
        here.rests()


def pixel(here, name, across, down):
    """Return the page's pixel at shares of a view from its upper left."""
    view = next(one for one in here.state("slicing")["boxes"] if one["name"] == name)
    box = here.page.locator("#pv-view").bounding_box()
    x, y = view["x"] + across * view["w"], view["y"] + down * view["h"]
    return box["x"] + x * box["width"], box["y"] + y * box["height"]


def click(here, name, across, down):
    """Click in a view, at shares of it from its upper left."""
    here.page.mouse.click(*pixel(here, name, across, down))


def test_a_t1_is_opened_gone_through_and_found_again(revisit):
    here = revisit("lines.fiblets")
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
    # Steps are of the pane that they were made in, however soon the pointer is in another one.
    before = told(here)
    for name, times in (("axial", 3), ("coronal", 2)):
        here.page.mouse.move(*pixel(here, name, 0.5, 0.5))
        for _ in range(times):
            here.press("PageDown")
    there = lambda: np.abs(np.subtract(told(here), before)).tolist()  # noqa: E731
    here.wait(lambda: there() == [0.0, 8.0, 12.0], "three slices of one pane and two of the other")
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
    here.page.evaluate(LOAD, text)
    here.wait(lambda: here.state("slicing")["shown"], "slices again")
    assert told(here) == [20.0, 24.0, 28.0]


def window(here, name):
    """Choose an image, and return its window."""
    here.page.click(f"[data-layer]:has-text('{name}')")
    here.wait(lambda: here.state("chosen_name") == name, "the image's settings")
    groups = here.state("groups")
    return next(one["effective"] for group in groups for one in group["properties"] if one["name"] == "clim")


def test_the_right_button_changes_the_chosen_image(revisit):
    here = revisit("lines.fiblets")
    names = "head.nii.gz", "other.nii.gz"
    shutil.copy(*(here.served.root / name for name in names))
    for name in names:
        sliced(here, name)
    before = [window(here, name) for name in names]
    for number, name in enumerate(names):
        window(here, name)
        here.page.mouse.move(*pixel(here, "axial", 0.4, 0.4))
        here.page.mouse.down(button="right")
        here.page.mouse.move(*np.add(pixel(here, "axial", 0.4, 0.4), (30, 20)), steps=4)
        here.page.mouse.up(button="right")
        here.wait(lambda name=name, number=number: window(here, name) != before[number], "another window")
        if number == 0:
            assert window(here, names[1]) == before[1]


def test_the_mouse_does_in_a_pane_what_the_table_says(revisit):
    """The table of docs/slices.md, but for the left button and the wheel alone."""
    here = revisit("lines.fiblets")
    sliced(here)
    at = told(here)
    mouse, keys = here.page.mouse, here.page.keyboard

    def drag(button, *held, by=(30, 20)):
        x, y = pixel(here, "axial", 0.4, 0.4)
        mouse.move(x, y)
        for key in held:
            keys.down(key)
        mouse.down(button=button)
        mouse.move(x + by[0], y + by[1], steps=4)
        mouse.up(button=button)
        for key in held:
            keys.up(key)

    def disc():
        picture = here.rests()
        view = next(one for one in here.state("slicing")["boxes"] if one["name"] == "axial")
        rows, columns = (
            slice(round(length * view[start]) + 2, round(length * (view[start] + view[size])) - 2)
            for length, start, size in zip(picture.shape, "yx", "hw", strict=False)
        )
        bright = picture[rows, columns].min(axis=2) > 200  # a disc in the middle of the image
        return [found.mean() for found in np.nonzero(bright)], np.sqrt(bright.mean())

    before = window(here, "head.nii.gz")
    drag("right")
    here.wait(lambda: window(here, "head.nii.gz") != before, "another window")
    assert told(here) == at
    here.press("Control+z")
    here.wait(lambda: window(here, "head.nii.gz") == before, "the window again")
    (middle, size) = disc()
    for button, held in (("left", ["Shift"]), ("middle", [])):
        drag(button, *held)
        # Pixels are coarse while something moves.
        assert disc()[0] == pytest.approx([middle[0] + 20, middle[1] + 30], abs=6), button
        drag(button, *held, by=(-30, -20))
        assert disc()[0] == pytest.approx(middle, abs=10)
    keys.down("Control")
    mouse.wheel(0, -240)
    keys.up("Control")
    here.wait(lambda: disc()[1] > 1.05 * size, "the image nearer")
    keys.down("Control")
    mouse.wheel(0, 240)
    keys.up("Control")
    here.wait(lambda: disc()[1] < 1.02 * size, "as far as before")
    drag("right", "Control", by=(0, -30))
    here.wait(lambda: abs(disc()[1] / size - 1.0) > 0.03, "another size")
    assert told(here) == at


def test_every_key_of_the_list_works(revisit):
    here = revisit("lines.fiblets")
    sliced(here)
    here.page.locator("#pv-view").hover(position={"x": 40, "y": 300})
    here.page.click("[data-action=add-painted]")
    here.press("Escape")
    state, at = here.state, lambda: told(here)
    tools = {"p": "pick", "b": "box", "l": "lasso", "m": "measure", "n": "brush", "e": "erase", "f": "fill",
             "u": "outline", "j": "sphere", "w": "grow"}  # fmt: skip
    for key, tool in tools.items():
        here.press(key)
        here.wait(lambda tool=tool: state("tool") == tool, f"the tool of {key}")
        here.press("Escape")
        here.wait(lambda: state("tool") == "rotate", "Escape")
    for key, dialog in {"o": "open", "s": "session", "?": "help"}.items():
        here.press(key)
        here.page.wait_for_selector(f"#dialog-{dialog}")
        here.press("Escape")
        here.page.wait_for_selector(f"#dialog-{dialog}", state="hidden")
    for key, name in {"t": "dark", "[": "left_open", "]": "right_open", "5": "parallel"}.items():
        before = state(name)
        for wanted in (not before, before):
            here.press(key)
            here.wait(lambda name=name, wanted=wanted: state(name) is wanted, f"{name} by {key}")
    camera = lambda: json.loads(here.page.evaluate("window.trame.trigger('save_session')"))["camera"]  # noqa: E731
    for key in "12340r":
        before = camera()
        if key == "r":
            here.page.evaluate("window.trame.trigger('view', ['axial'])")
        here.press(key)
        here.wait(lambda before=before: camera() != before, f"another view by {key}")
    for key, steps in {"ArrowLeft": "ArrowRight", "ArrowUp": "ArrowDown", "PageUp": "PageDown"}.items():
        before = at()
        here.press(key)
        here.wait(lambda before=before: at() != before, f"a step by {key}")
        here.press(steps)
        here.wait(lambda before=before: at() == before, f"a step back by {steps}")
    here.press("x")
    here.wait(lambda: state("slicing")["layout"] == "3d", "the 3-D view alone")
    here.press("x")
    here.wait(lambda: state("slicing")["layout"] == "beside", "slices again")
    here.press("]")
    here.wait(lambda: state("right_open") is False, "no tab")
    here.press("g")
    here.wait(lambda: here.page.evaluate("document.activeElement.ariaLabel") == "mm x", "the field of the position")
    here.page.keyboard.type("12")
    here.press("Enter")
    here.wait(lambda: at()[0] == 12.0, "the position that was typed")
    visible = lambda: [layer["visible"] for layer in state("layers")]  # noqa: E731
    before = visible()
    here.press("v")
    here.wait(lambda: visible() != before, "a hidden layer")
    here.press("Control+z")
    here.wait(lambda: visible() == before, "undo")
    here.press("Control+y")
    here.wait(lambda: visible() != before, "redo")
    with here.page.expect_download():
        here.press("c")
    here.press("Delete")
    here.wait(lambda: here.layers() == 1, "one layer fewer")
    tested = {key.upper() for key in tools} | set("OSCTXGVR[]?123450") | {"Esc"}
    tested |= {"arrows", "Page", "Up", "Down", "Ctrl+Z", "Ctrl+Y", "Del"}
    tested |= {"comma,", "full", "stop"}  # test_volumes_of_a_series_are_gone_through
    assert {word for keys, _ in KEYS for word in keys.split()} <= tested


def test_a_painted_region_filters_and_is_kept(revisit, tmp_path):
    here = revisit("lines.fiblets")
    sliced(here)
    here.page.click("[data-layout-button=axial]")
    here.wait(lambda: [one["name"] for one in here.state("slicing")["boxes"]] == ["axial"], "one view")
    # Lines run along x at y = 0, 4, ... 36 and z = 0, 4, ... 20; the slice is at z = 20.
    for axis, text in enumerate(("20", "16", "20")):
        here.page.fill(f"[data-place=position] input >> nth={axis}", text)
        here.press("Tab")
    here.wait(lambda: told(here) == [20.0, 16.0, 20.0], "the point")
    here.page.click("[data-action=add-painted]")
    here.page.wait_for_selector("#pv-paint[data-tool=brush]")
    here.page.fill("[data-painted] [data-field=name]", "left <b>arm</b>")
    here.press("Tab")
    here.wait(lambda: here.state("painting")["active"] == "left <b>arm</b>", "the name")
    here.page.fill("input[aria-label='Radius, mm']", "1")
    here.press("Tab")
    here.wait(lambda: here.state("brush") == 1, "the radius")
    before = here.rests()
    # At the cross-hair and a voxel towards the front, which is up.
    view = here.page.locator("#pv-view").bounding_box()
    mm = here.state("slicing")["boxes"][0]["mm"]
    middle, voxel = 26.0, 4.0 / mm  # y of the image's middle, and shares of the picture's height
    at = 0.5 - (16.0 - middle) / mm
    across = 0.5 + (30.0 - 20.0) / mm * view["height"] / view["width"]  # the patient's right is on the left
    here.trace([(across, at), (across, at - voxel)], steps=3)
    here.wait(lambda: here.state("painting")["counted"] == "2 of 60 streamlines are shown", "what passes")
    assert here.state("painting")["regions"][0]["voxels"] == "2"
    here.wait(lambda: here.state("undo_label").startswith("paint"), "a step to undo")
    here.press("Escape")
    here.changed(before)
    here.press("Control+z")
    here.wait(lambda: here.state("painting")["counted"] == "60 of 60 streamlines are shown", "all")
    here.told("Undone: paint left <b>arm</b>")
    here.press("Control+y")
    here.wait(lambda: here.state("painting")["counted"] == "2 of 60 streamlines are shown", "what passes")
    here.page.fill("#painting-name", "arms")
    here.page.click("[data-action=save-painted]")
    here.wait(lambda: (here.served.root / "arms.nii.gz").is_file(), "the file")
    assert "left <b>arm</b>" in (here.served.root / "arms.tsv").read_text()
    here.page.reload()
    here.ready()
    here.tab("slices")
    assert here.page.locator("[data-value=painted-counted]").inner_text() == "2 of 60 streamlines are shown"
    assert here.page.locator("[data-painted] [data-field=name]").input_value() == "left <b>arm</b>"


def test_a_bundle_is_made_named_exported_and_kept(revisit):
    here = revisit("lines.fiblets")
    here.tab("bundles")
    names = lambda: [row["name"] for row in here.state("bundles")["rows"]]  # noqa: E731
    assert names() == ["near", "far"]
    here.page.click("[data-bundle-row=far] [data-action=eye]")
    here.page.click("[data-bundle=shown]")  # what is left: the near ones
    here.wait(lambda: len(names()) == 3, "a bundle")
    here.page.fill("[data-bundle-row='bundle 3'] [data-field=name]", "<b>shown</b>")
    here.press("Tab")
    here.wait(lambda: names()[2] == "<b>shown</b>", "its name")
    for name in ("<b>shown</b>", "near"):
        here.page.click(f"[data-bundle-row='{name}'] input[type=checkbox]")
        here.wait(lambda name=name: any(row["name"] == name and row["order"] for row in here.state("bundles")["rows"]),
                  "its box")  # fmt: skip
    here.page.click("[data-bundle-act=subtract]")
    here.wait(lambda: here.state("bundles")["rows"][2]["count"] == "0", "what is left")
    here.press("Control+z")
    here.wait(lambda: here.state("bundles")["rows"][2]["count"] == "30", "what was there")
    here.page.click("[data-bundle-act=export]")
    here.page.click("[data-bundle-export='.tck']")
    file = here.wait(lambda: next(here.served.root.glob("*shown*.tck"), None), "the file")
    import pvfiblets

    assert len(pvfiblets.read(file)) == 30
    here.page.reload()
    here.ready()
    assert names() == ["near", "far", "<b>shown</b>"]
    assert here.page.locator("[data-bundle-row] [data-field=name]").nth(2).input_value() == "<b>shown</b>"


def test_a_handle_of_the_oblique_slice_is_dragged_and_undone_at_once(visit):
    here = visit("lines.fiblets")  # a shared page would keep where the cross-hair was
    sliced(here)
    here.page.click("[data-action=panes]")
    here.page.click("[aria-label='Oblique slice']")
    here.wait(lambda: here.state("slicing")["tilted"], "an oblique slice")
    here.page.click("[data-layout-button=sagittal]")
    here.wait(lambda: [one["name"] for one in here.state("slicing")["boxes"]] == ["sagittal"], "one view")
    here.page.fill("input[aria-label='Tilt, degrees']", "30")
    here.press("Tab")
    tilt = lambda: here.state("slicing")["oblique"][0]  # noqa: E731
    here.wait(lambda: float(tilt()) == 30.0, "its angle")
    before = here.rests()
    (view,) = here.state("slicing")["boxes"]
    box = here.page.locator("#pv-view").bounding_box()
    middle = np.array(pixel(here, "sagittal", 0.5, 0.5))  # the cross-hair is in the image's middle
    reach = 0.36 * min(view["w"] * box["width"], view["h"] * box["height"])
    to_front = 1.0 if view["letters"]["right"] == "A" else -1.0

    def handle(degrees):
        """Return where the handle is that lies towards the front, which goes down as the slice is tilted."""
        angle = np.radians(degrees)
        return (middle + reach * np.array([to_front * np.cos(angle), np.sin(angle)])).tolist()

    mouse = here.page.mouse
    mouse.move(*handle(30))
    mouse.down()
    mouse.move(*handle(45), steps=3)
    here.wait(lambda: abs(float(tilt()) - 45.0) < 1.5, "the slice to follow")
    mouse.move(*handle(60), steps=3)
    mouse.up()
    here.wait(lambda: abs(float(tilt()) - 60.0) < 1.5, "the slice to follow on")
    here.changed(before)
    here.press("Control+z")
    here.wait(lambda: float(tilt()) == 30.0, "the slice as it was before the drag")
    here.press("Control+y")
    here.wait(lambda: abs(float(tilt()) - 60.0) < 1.5, "the whole drag again")


def test_volumes_of_a_series_are_gone_through(revisit):
    import nibabel

    here = revisit("lines.fiblets")
    series = np.stack([np.full((8, 8, 8), 10.0 * k, np.float32) for k in range(5)], axis=-1)
    nibabel.save(nibabel.Nifti1Image(series, np.diag([8.0, 8.0, 8.0, 1.0])), here.served.root / "bold.nii.gz")
    sliced(here, "bold.nii.gz")
    index = lambda: here.state("slicing")["series"][0]["index"]  # noqa: E731
    here.page.locator("[data-series='bold.nii.gz'] [role=slider]").focus()
    here.press("ArrowRight")
    here.wait(lambda: index() == 1, "the second volume")
    here.page.evaluate("document.activeElement.blur()")
    here.press(".")
    here.wait(lambda: index() == 2, "the third volume")
    here.page.fill("[data-series] [data-field=volume]", "4")
    here.press("Enter")
    under = here.page.locator("[data-under='bold.nii.gz'] .pv-value")
    here.wait(lambda: under.inner_text() == "40", "the last volume's value under the cross-hair")


def test_regions_are_outlined_grown_and_taken_from_a_file(revisit):
    here = revisit("lines.fiblets")
    sliced(here)
    here.page.click("[data-layout-button=axial]")
    here.wait(lambda: [one["name"] for one in here.state("slicing")["boxes"]] == ["axial"], "one view")
    rows = lambda: here.state("painting")["regions"]  # noqa: E731
    here.page.click("[data-action=add-painted]")
    here.page.wait_for_selector("#pv-paint[data-tool=brush]")
    here.press("u")
    here.page.wait_for_selector("#pv-paint[data-tool=outline]")
    here.trace([(0.35, 0.3), (0.65, 0.3), (0.65, 0.7), (0.35, 0.7)])
    here.wait(lambda: rows()[0]["voxels"] != "0", "an outline that is filled")
    here.wait(lambda: here.state("undo_label").startswith("paint"), "a step to undo")
    here.page.click("[data-action=add-painted]")
    here.wait(lambda: len(rows()) == 2, "another region")
    here.page.click("[data-paint-tool=grow]")
    here.page.fill("input[aria-label='Range, per cent']", "3")
    here.press("Tab")
    here.wait(lambda: here.state("grow_share") == 3, "the range")
    box = here.page.locator("#pv-view").bounding_box()
    here.page.mouse.click(box["x"] + 0.3 * box["width"], box["y"] + 0.3 * box["height"])
    here.wait(lambda: rows()[1]["voxels"] != "0", "what has grown")
    here.press("Escape")
    for name in ("region 1", "region 2"):
        here.page.click(f"[data-painted='{name}'] [aria-label=Remove]")
    here.wait(lambda: not rows(), "no regions")
    here.page.click("[data-action=open-labels]")
    here.page.click("#dialog-open .v-list-item:has-text('atlas.nii.gz')")
    here.wait(lambda: [row["name"] for row in rows()] == ["3", "5"], "the regions of the file")


def test_labels_of_an_atlas_are_searched_and_clicked(revisit):
    here = revisit("lines.fiblets")
    shutil.copy(here.served.root / "atlas.nii.gz", here.served.root / "parts.nii.gz")
    (here.served.root / "parts.tsv").write_text("index\tname\n3\tputamen\n5\t<b>insula</b>\n")
    here.page.evaluate("window.trame.trigger('browse', ['', 'slices'])")
    here.page.click("#dialog-open .v-list-item:has-text('parts.nii.gz')")
    here.wait(lambda: len(here.state("atlas")["rows"]) == 2, "labels")
    here.rests()
    here.tab("slices")
    here.page.click("[data-action=atlas]")
    here.page.fill("[data-field=atlas-search]", "insula")
    here.wait(lambda: here.page.locator("[data-label]").count() == 1, "the label that is searched for")
    here.page.click("[data-label='5'] >> text=insula")
    asked = lambda: here.state("atlas")["asked"]  # noqa: E731
    here.wait(lambda: asked() == [5], "the label is asked for")
    here.page.click("[data-atlas-how=ends_in]")
    here.page.click("[data-action=ask-in-slice]")
    click(here, "axial", 0.85, 0.5)  # the patient's left is on the right, where x is small
    here.wait(lambda: asked() == [5, 3], "the label in the slice")
    # Lines begin at 0 and end at 10 + i mm; the insula reaches from 14.3 to 30.3 mm.
    told = here.page.locator("[data-value=atlas-asked]").inner_text()
    assert "putamen – <b>insula</b>" in told
    assert "16 of 60 streamlines" in told
    here.page.reload()
    here.ready()
    here.wait(lambda: asked() == [5, 3], "what was asked")
    here.press("Control+z")
    here.wait(lambda: asked() == [5], "one label")


def test_a_phone_has_slices_below_and_tools_that_paint_at_hand(visit):
    here = visit("lines.fiblets", width=390, height=844, has_touch=True, is_mobile=True)
    here.page.evaluate("window.trame.trigger('browse', ['', 'slices'])")
    here.page.tap("#dialog-open .v-list-item:has-text('head.nii.gz')")
    here.wait(lambda: len(here.state("slicing")["boxes"]) == 4, "four views")
    here.rests()
    box = {one["name"]: one for one in here.state("slicing")["boxes"]}
    assert box["3d"]["w"] == 1.0
    assert min(box[name]["y"] for name in ("axial", "coronal", "sagittal")) >= 0.6
    here.page.evaluate("window.trame.state.update({right_open: true, tab: 'slices'})")
    here.page.tap("[data-action=add-painted]")
    here.page.wait_for_selector("#pv-paint[data-tool=brush]")
    here.page.evaluate("window.trame.state.update({right_open: false})")
    here.page.tap("[data-paint-at-hand=fill]")
    here.page.wait_for_selector("#pv-paint[data-tool=fill]")
    at = told(here)
    view = here.page.locator("#pv-view").bounding_box()
    middle = [view[side] + view[length] * (box["axial"][k] + 0.5 * box["axial"][n])
              for side, length, k, n in (("x", "width", "x", "w"), ("y", "height", "y", "h"))]  # fmt: skip
    here.stands()  # the panel slides away
    here.page.touchscreen.tap(*middle)
    here.wait(lambda: here.state("painting")["regions"][0]["voxels"] == "256", "the slice that is filled")
    for _ in range(3):  # as fast as they go
        here.page.tap("[data-slice-step='1']")
    here.wait(lambda: abs(told(here)[2] - at[2]) == 12.0, "a slice for each tap")


def test_from_a_t1_and_labels_to_an_exported_connection(revisit):
    """A session as users have it: images, a point, a painted region, a label, a file, and all of it after a reload."""
    here = revisit("lines.fiblets")
    shutil.copy(here.served.root / "atlas.nii.gz", here.served.root / "lobes.nii.gz")
    (here.served.root / "lobes.tsv").write_text("index\tname\n3\tputamen\n5\tinsula\n")
    sliced(here)
    here.page.click("[data-action=open-slices]")
    here.page.click("#dialog-open .v-list-item:has-text('lobes.nii.gz')")
    here.wait(lambda: len(here.state("atlas")["rows"]) == 2, "labels")
    for axis, text in enumerate(("20", "16", "20")):
        here.page.fill(f"[data-place=position] input >> nth={axis}", text)
        here.press("Tab")
    here.wait(lambda: told(here) == [20.0, 16.0, 20.0], "the point")
    assert here.page.locator("[data-under='lobes.nii.gz'] .pv-value").inner_text() == "insula (5)"
    # Lines begin at 0, in the putamen, and end at 10 + i mm.
    here.page.click("[data-action=atlas]")
    here.page.click("[data-label='3'] >> text=putamen")
    here.wait(lambda: here.state("atlas")["asked"] == [3], "the label")
    here.page.click("[data-action=add-painted]")
    here.page.wait_for_selector("#pv-paint[data-tool=brush]")
    here.page.click("[data-paint-tool=fill]")
    click(here, "sagittal", 0.5, 0.5)  # all of the slice at x = 20 mm, from 18 on, where one line ends
    here.wait(lambda: here.state("painting")["regions"][0]["voxels"] == "256", "the slice")
    counted = here.state("painting")["counted"]
    left = int(counted.split()[0])
    assert left in (51, 52)
    here.press("Escape")
    here.tab("selection")
    here.page.click("[data-select=export_what] .v-field")
    here.page.click(".v-overlay--active .v-list-item:has-text('visible streamlines')")
    here.page.fill("[data-field=export-name]", "reaching")
    here.press("Tab")
    here.wait(lambda: here.state("export_name") == "reaching", "the name")
    here.page.click("[data-action=export]")
    here.page.click("[data-export='.tck']")
    here.wait((here.served.root / "reaching.tck").exists, "the file, not an earlier one")
    import pvfiblets

    assert len(pvfiblets.read(here.served.root / "reaching.tck")) == left
    here.page.reload()
    here.ready()
    assert here.state("painting")["counted"] == counted
    assert here.state("atlas")["asked"] == [3]
    assert told(here) == [20.0, 16.0, 20.0]
