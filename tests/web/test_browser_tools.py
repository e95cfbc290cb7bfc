"""What a page's tools, keys and dialogs do, in a real browser."""

import json

import numpy as np
import pytest
import pyvista as pv

pytestmark = pytest.mark.more


def from_above(here):
    """Look down: each of the topmost lines, 50 to 59, hides what is below it; y goes up and x to the right."""
    here.press("1")
    here.wait(lambda: here.state("edges").get("top") == "A", "the view from above")
    if not here.state("parallel"):
        here.press("5")
        here.wait(lambda: here.state("parallel"), "parallel lines of sight")
    here.rests()


def picked(here, count):
    """Wait until so many are selected, and return the numbers in the table."""
    here.wait(lambda: here.state("selection")["count"] == count, f"{count} selected streamlines")
    here.wait(lambda: here.page.locator("#picked tbody tr").count() == count, "a row for each")
    return {int(text) for text in here.page.locator("#picked tbody tr td:first-child").all_inner_texts()}


def test_lassos_and_boxes_take_what_lies_in_them(revisit):
    here = revisit("lines.fiblets")
    from_above(here)
    front, back = set(range(55, 60)), set(range(50, 55))  # the picture's middle is at y = 18 mm
    here.press("l")
    here.page.wait_for_selector("#pv-over[data-tool=lasso]")
    here.trace([(0.98, 0.02), (0.98, 0.5), (0.5, 0.5), (0.02, 0.5), (0.2, 0.02)])  # the tools are in one corner
    assert picked(here, 5) == front
    here.press("b")
    here.page.wait_for_selector("#pv-over[data-tool=box]")
    here.page.keyboard.down("Shift")
    here.trace([(0.98, 0.98), (0.5, 0.5)])
    here.page.keyboard.up("Shift")
    assert picked(here, 10) == front | back
    here.trace([(0.02, 0.98), (0.5, 0.5)])
    assert picked(here, 5) == back
    here.page.click("#tab-selection button:has-text('As a layer')")
    here.wait(lambda: here.layers() == 2, "a layer of what was selected")
    assert here.state("layers")[1]["kind"] == "selection"
    here.press("Escape")
    here.page.click("#tab-selection button:has-text('Clear')")
    here.wait(lambda: here.state("selection")["count"] == 0, "nothing selected")


def test_a_distance_is_measured_in_millimetres(revisit):
    here = revisit("lines.fiblets")
    from_above(here)
    here.page.fill("[data-property=line_width] input.pv-num", "6")
    here.press("Tab")
    here.wait(lambda: "line_width" in here.state("undo_label"), "wide lines")
    lit = here.rests().max(axis=2) > 60
    # From above, lines 50 to 59 are nearest; the longest spans 69 mm from left to right.
    rows = np.flatnonzero(lit.any(axis=1))
    extents = {row: np.flatnonzero(lit[row])[[0, -1]] for row in rows}
    row = max(rows, key=lambda found: np.ptp(extents[found]))
    first, last = extents[row]
    per_mm = (last - first) / 69.0
    row = int(np.median([other for other in rows if np.array_equal(extents[other], extents[row])]))
    here.press("m")
    here.page.wait_for_selector("#pv-over[data-tool=measure]")
    height, width = lit.shape
    here.drag(((first + 10 * per_mm) / width, row / height), ((first + 50 * per_mm) / width, row / height))
    here.wait(lambda: here.state("measured"), "a distance")
    assert "mm" in here.page.inner_text("[data-action=remove-distance]")
    assert abs(float(here.state("measured")[0].split()[0]) - 40.0) < 1.0
    here.drag(((first + 10 * per_mm) / width, row / height), ((first + 30 * per_mm) / width, row / height))
    here.wait(lambda: len(here.state("measured")) == 2, "another distance")
    here.press("Control+z")
    here.wait(lambda: len(here.state("measured")) == 1, "the first alone")
    here.press("Control+y")
    here.wait(lambda: len(here.state("measured")) == 2, "both")
    here.page.locator("[data-action=remove-distance]").first.click()
    here.wait(lambda: len(here.state("measured")) == 1, "the second alone")
    assert abs(float(here.state("measured")[0].split()[0]) - 20.0) < 1.0
    here.page.click("[data-action=remove-distance]")
    here.wait(lambda: not here.state("measured"), "no distance")


def test_two_clicks_measure_and_escape_ends(revisit):
    here = revisit("lines.fiblets")
    from_above(here)
    lit = here.rests().max(axis=2) > 60
    height, width = lit.shape
    rows, columns = np.nonzero(lit)
    first, last = columns.argmin(), columns.argmax()
    ends = [(columns[at] / width, rows[at] / height) for at in (first, last)]
    line = here.page.locator("#pv-over polyline")
    note = here.page.locator("[data-value=measuring]")
    here.press("m")
    here.wait(lambda: note.count() and "Click two points, or drag" in note.inner_text(), "what to do")
    here.trace(ends[:1])
    here.wait(lambda: "second point" in note.inner_text(), "what to do next")
    here.wait(lambda: line.count() == 1, "the first point")
    box = here.page.locator("#pv-view").bounding_box()
    here.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    before = line.get_attribute("points").split()
    assert before[0] != before[1]  # it follows the pointer
    here.trace(ends[1:])
    here.wait(lambda: len(here.state("measured")) == 1, "the distance")
    assert float(here.state("measured")[0].split()[0]) > 60.0  # mm: lines are up to 69 mm long
    here.trace(ends[:1])
    here.wait(lambda: line.count() == 1, "the first point of another")
    here.press("Escape")
    here.wait(lambda: here.state("tool") == "rotate", "the end")
    here.press("m")
    here.trace(ends[1:])
    here.wait(lambda: "second point" in note.inner_text(), "a first point again")
    assert len(here.state("measured")) == 1
    here.press("Escape")


def test_keys_are_listed_and_do_what_the_list_says(revisit):
    here = revisit("lines.fiblets")
    before = here.rests()
    here.press("?")
    listed = here.page.locator("#dialog-help").inner_text()
    assert all(word in listed for word in ("undo, redo", "pick, box, lasso", "light or dark", "pinch"))
    here.press("Escape")
    here.wait(lambda: not here.page.locator("#dialog-help").is_visible(), "the list to close")
    theme = here.page.locator(".v-application").first.get_attribute("class")
    here.press("t")
    here.wait(
        lambda: here.page.locator(".v-application").first.get_attribute("class") != theme, "light instead of dark"
    )
    shades = here.page.evaluate(
        "['background-color', 'color'].map(name => getComputedStyle(document.querySelector('#left'))"
        ".getPropertyValue(name).match(/[0-9.]+/g).slice(0, 3).reduce((a, b) => a + Number(b), 0) / 3)"
    )
    assert shades[0] > 200
    assert shades[1] < 80
    here.press("[")
    here.press("]")
    width = 1280 - 2 * 48  # icons beside it
    here.wait(lambda: here.page.locator("#pv-view").bounding_box()["width"] == width, "folded panels")
    here.wait(lambda: here.picture().shape[1] == width, "a picture of that width")
    here.press("[")
    here.press("]")
    here.wait(lambda: here.picture().shape == before.shape, "the panels again")
    here.press("v")
    here.wait(lambda: here.state("layers")[0]["visible"] is False, "a hidden layer")
    here.press("Control+z")
    here.wait(lambda: here.state("layers")[0]["visible"] is True, "the layer again")
    here.press("Control+y")
    here.wait(lambda: here.state("layers")[0]["visible"] is False, "the layer hidden again")
    here.press("Control+Shift+z")  # there is nothing more to do again
    here.press("Control+z")
    here.wait(lambda: here.state("layers")[0]["visible"] is True, "the layer again")
    assert np.abs(here.rests() - before).mean() < 0.5
    with here.page.expect_download() as download:
        here.press("c")
    assert download.value.path().read_bytes().startswith(b"\x89PNG")


def test_menus_close_files_are_found_and_sentences_are_said_once(revisit):
    here = revisit("lines.fiblets")
    assert here.page.locator("#pv-view img").evaluate("image => getComputedStyle(image).objectFit") == "contain"
    detail = here.page.locator("[data-property=detail] label")  # what experts set is folded
    assert not detail.is_visible()
    here.page.click("[data-action=expert]")
    detail.wait_for()
    here.page.click("[data-action=more]")
    menu = here.page.locator(".v-menu.v-overlay--active .v-list-item:has-text('Duplicate')")
    menu.wait_for()
    here.press("Escape")
    menu.wait_for(state="hidden")
    here.press("o")
    names = here.page.locator("#dialog-open [data-entry]")
    here.wait(lambda: names.count() > 4, "the files")

    def listed():
        return [one.get_attribute("data-entry") for one in names.all()]

    here.page.click("[data-sort=bytes]")
    sizes = {path.name: path.stat().st_size for path in here.served.root.iterdir()}
    here.wait(lambda: listed() == sorted(listed(), key=lambda name: -sizes[name]), "the largest first")
    here.page.fill("[data-field=search] input", "LINES")
    here.wait(lambda: set(listed()) == {"lines.trk", "lines.fiblets"}, "those of that name")
    icons = [names.nth(k).locator("i").first.get_attribute("class") for k in range(2)]
    assert all("mdi-vector-polyline" in icon for icon in icons)
    (here.served.root / "bad_lines.trk").write_bytes(b"TRACK" + bytes(2000))
    here.press("Escape")
    here.page.wait_for_selector("#dialog-open", state="hidden")
    here.page.click("[data-action=open]")
    here.page.click("[data-entry='bad_lines.trk']")
    here.wait(lambda: here.state("toast_open") and "bad_lines.trk" in here.toast(), "why it was not opened")
    here.page.reload()
    here.ready()
    here.wait(lambda: here.state("toast_open") is False, "no sentence that was said before")
    (here.served.root / "bad_lines.trk").unlink()


def test_a_file_of_vtk_is_opened_in_the_space_that_is_chosen(revisit):
    here = revisit("lines.fiblets")
    pv.lines_from_points(np.array([[20.0, 5, 7], [30, 5, 7], [40, 5, 7]])).save(here.served.root / "dipy.vtk")
    here.press("o")
    here.page.wait_for_selector("[data-part=space]")
    here.page.click("[data-space=LPS]")
    here.wait(lambda: here.state("open_space") == "LPS", "the choice")
    here.page.click("[data-entry='dipy.vtk']")
    here.wait(lambda: here.layers() == 2, "the layer")
    saved = json.loads(here.page.evaluate("window.trame.trigger('save_session')"))
    assert saved["layers"][1]["source"] == {"path": "dipy.vtk", "space": "LPS"}
    here.press("o")
    here.wait(lambda: here.state("open_space") == "RAS", "the default again")
    here.page.click("#dialog-open [aria-label=Close]")
    here.page.wait_for_selector("#dialog-open", state="hidden")
    pv.Sphere(radius=8.0, center=(-20, -18, 10)).save(here.served.root / "lps.vtp")
    here.tab("clip")
    here.page.click("[data-cut=mesh]")
    here.page.click("#dialog-open [data-space=LPS]")
    here.page.click("[data-entry='lps.vtp']")
    here.wait(lambda: len(here.state("clips")) == 1, "the cut")
    saved = json.loads(here.page.evaluate("window.trame.trigger('save_session')"))
    assert saved["clips"][0]["shape"] == {"kind": "mesh", "path": "lps.vtp", "space": "LPS"}
    for name in ("dipy.vtk", "lps.vtp"):
        (here.served.root / name).unlink()


def test_an_image_that_is_open_is_a_criterion(revisit):
    here = revisit("lines.fiblets", "--volume", "head.nii.gz")
    here.wait(lambda: here.layers() == 2, "both layers")
    here.page.click("text=lines.fiblets")
    here.tab("filter")
    here.page.click("#tab-filter .v-select:has(#add-criterion) .v-field")
    here.page.click(".v-overlay--active .v-list-item:has-text('volume head.nii.gz')")
    row = here.page.locator("[data-criterion='volume head.nii.gz']")
    row.locator("svg").first.wait_for()
    before = here.rests()
    row.locator("input.pv-num").first.fill("0.5")
    here.press("Tab")
    here.changed(before)
    saved = json.loads(here.page.evaluate("window.trame.trigger('save_session')"))
    assert saved["layers"][0]["filters"]["criteria"]["volume head.nii.gz"][0] == 0.5


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
    here.rests()


def test_through_a_and_not_through_b(revisit, lines):
    here = revisit("lines.fiblets")
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
