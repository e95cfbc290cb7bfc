"""What lies where on a page, in a real browser: nothing is cut off, over something else, or out of reach."""

from pathlib import Path

import pytest

pytestmark = pytest.mark.more

FAULTS = Path(__file__).with_name("layout_faults.js").read_text(encoding="utf-8")
SIZES = [(1280, 720), (800, 600), (320, 640)]
DIALOGS = ("open", "session", "picture", "script", "help", "rename", "end")
EACH_FRAME = """() => {
    const fits = window.fits = new Set();
    const look = () => {
        fits.add(getComputedStyle(document.querySelector('#pv-view img')).objectFit);
        if (window.fits === fits) requestAnimationFrame(look);
    };
    look();
}"""
"""Notes in each frame from now on how the picture fits its place."""
LONG = "a_tractogram_of_a_study_with_a_very_long_name_that_nobody_wants_to_read.trk"


def faults(here, *parts):
    here.wait(lambda: not here.state("job").get("text"), "the end of what lies over the page, such as compiling")
    return here.page.evaluate(f"({FAULTS})({list(parts)})")


def resize(here, size, *, left, right):
    """Make the page of a size, with some of its panels open."""
    here.page.set_viewport_size({"width": size[0], "height": size[1]})
    wanted = {"left": left, "right": right}
    for panels in (dict.fromkeys(wanted, False), wanted):  # what a narrower page closes by itself is closed by then
        here.stands()
        for side, opened in panels.items():
            here.page.evaluate("([name, value]) => window.trame.state.set(name, value)", [f"{side}_open", opened])

    here.stands()
    at = [here.page.locator(f"#{side}").bounding_box() for side in wanted]
    shown = [
        box is not None and box["x"] < size[0] - 1 and box["x"] + box["width"] > 1 and box["y"] < size[1] - 1
        for box in at
    ]
    assert shown == [left, right]


def pick(here, title, layer):
    here.page.click(f"[data-layer]:has-text('{layer}')")
    here.wait(lambda: here.state("chosen_name") == layer, title)


@pytest.fixture(scope="module")
def pages(browser, served):
    """Return a page with layers of three kinds, cuts, filters, a selection and an export: all panels are full."""
    from tests.web.browsing import Visit

    here = Visit(browser, served("lines.fiblets", "--volume", "head.nii.gz", "--mesh", "ball.ply"))
    here.open()
    here.wait(lambda: here.layers() == 3, "all layers")
    pick(here, "the lines", "lines.fiblets")
    here.choose("scalars", "fa")
    here.page.click("[data-view=axial]")
    here.rests()  # lines are selected of the picture that is shown
    here.page.click("[data-tool-button=box]")
    here.page.wait_for_selector("#pv-over[data-tool=box]")
    here.trace([(0.98, 0.98), (0.1, 0.02)])
    here.wait(lambda: here.state("selection")["count"] > 5, "a selection")
    here.page.click("[data-tool-button=rotate]")
    here.page.click("[data-action=export]")
    here.page.click("[data-export='.trk']")
    here.wait(lambda: here.state("download"), "an export")
    here.tab("clip")
    for kind in ("plane", "slab", "box", "sphere"):
        here.page.click(f"[data-cut={kind}]")
    here.wait(lambda: len(here.state("clips")) == 4, "four cuts")
    here.page.evaluate("window.trame.trigger('browse', ['', 'clip'])")
    here.page.click("[data-entry='ball.ply']")
    here.wait(lambda: len(here.state("clips")) == 5, "a cut by a mesh")
    here.tab("filter")
    for name in ("length", "weight"):
        here.page.click("#tab-filter .v-select:has(#add-criterion) .v-field")
        here.page.click(f".v-overlay--active .v-list-item:has-text('{name}')")
        here.page.wait_for_selector(f"[data-criterion={name}]")
    for kind in ("sphere", "box"):
        here.page.click(f"[data-region={kind}]")
    here.page.click("[data-region=file]")
    here.page.click("[data-entry='atlas.nii.gz']")
    here.wait(lambda: len(here.state("filters")["regions"]) == 3, "three regions")
    here.page.click("#tab-filter .v-btn-toggle button:has-text('any')")
    yield here
    errors = list(here.errors)
    here.close()
    assert not errors


@pytest.mark.parametrize("size", SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def test_panels_are_whole(pages, size):
    here = pages
    resize(here, size, left=True, right=False)
    wrong = faults(here, "header")
    for name in ("lines.fiblets", "head.nii.gz", "ball.ply"):
        pick(here, "a layer", name)
        wrong += faults(here, "#left")
    pick(here, "the lines", "lines.fiblets")
    resize(here, size, left=size[0] > 1100, right=True)
    for name in ("clip", "filter", "selection", "info"):
        here.tab(name)
        here.stands()
        wrong += [f"{name}: {fault}" for fault in faults(here, "#right")]
    assert "\n".join(wrong) == ""


@pytest.mark.parametrize("size", SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def test_dialogs_are_whole(pages, size):
    here = pages
    resize(here, size, left=False, right=False)
    here.page.evaluate("window.trame.trigger('browse', [''])")
    here.wait(lambda: here.state("entries"), "the files")
    wrong = []
    for name in DIALOGS:
        here.page.evaluate(f"window.trame.state.set('dialog', '{name}')")
        here.page.wait_for_selector(f"#dialog-{name}")
        here.stands()
        wrong += faults(here, f"#dialog-{name}")
        here.press("Escape")
        here.wait(lambda name=name: not here.page.locator(f"#dialog-{name}").is_visible(), "the dialog to close")
    here.page.evaluate(f"window.trame.state.update({{uploading: '{LONG}', uploaded: 40}})")
    here.page.evaluate(f"window.trame.state.update({{toast: '{LONG} was not opened. ' + 'It is damaged. '.repeat(9)}})")
    here.page.evaluate("window.trame.state.update({toast_open: true})")
    here.page.wait_for_selector("#uploading")
    here.stands()
    wrong += faults(here, "#uploading", ".v-snackbar__wrapper")
    here.page.evaluate("window.trame.state.update({uploading: '', toast_open: false})")
    here.stands()
    assert "\n".join(wrong) == ""


@pytest.mark.parametrize("size", [*SIZES, (320, 320)], ids=lambda size: f"{size[0]}x{size[1]}")
def test_what_lies_over_the_picture_is_apart(pages, size):
    here = pages
    resize(here, size, left=size[0] > 1100, right=size[0] > 1100)
    for key in ("1", "4"):
        here.press(key)
        here.rests()
        over = ".pv-tools .v-btn, .pv-edge, .pv-status, .pv-notes > *"
        boxes = here.page.evaluate(
            f"[...document.querySelectorAll('{over}')].map(p => p.getBoundingClientRect()).filter(b => b.width)"
            ".map(b => [b.left, b.right, b.top, b.bottom])"
        )
        assert len(boxes) > 8
        for k, one in enumerate(boxes):
            assert one[0] >= 0
            assert one[1] <= size[0]
            assert one[2] >= 0
            assert one[3] <= size[1]
            for other in boxes[:k]:
                across = min(one[1], other[1]) - max(one[0], other[0])
                down = min(one[3], other[3]) - max(one[2], other[2])
                assert across <= 1 or down <= 1, (one, other)


@pytest.mark.parametrize("size", [(1280, 800), (390, 844)], ids=lambda size: f"{size[0]}x{size[1]}")
def test_readouts_lie_in_one_view_beside_its_letters(visit, size):
    here = visit("lines.fiblets", width=size[0], height=size[1])
    here.page.evaluate("window.trame.state.update({left_open: false, right_open: false})")
    here.page.evaluate("window.trame.trigger('browse', ['', 'slices'])")
    here.page.click("[data-entry='head.nii.gz']")
    here.wait(lambda: here.state("slicing")["shown"], "slices")
    for layout in ("grid", "beside", "axial"):
        here.page.evaluate("(layout) => trame.trigger('set_layout', [layout])", layout)
        here.wait(lambda layout=layout: here.state("slicing")["layout"] == layout, layout)
        here.rests()
        here.stands()
        whole = here.page.locator("#pv-view").bounding_box()
        views = here.state("slicing")["boxes"]
        (view,) = [one for one in views if one["name"] == "3d" or len(views) == 1]
        left, top = whole["x"] + view["x"] * whole["width"], whole["y"] + view["y"] * whole["height"]
        right, bottom = left + view["w"] * whole["width"], top + view["h"] * whole["height"]
        middle = (left + right) / 2
        told, status = (here.page.locator(name).bounding_box() for name in ("#pv-told", ".pv-status"))
        for box in (told, status):
            assert box["x"] >= left
            assert box["x"] + box["width"] <= right
            assert box["y"] >= top
            assert box["y"] + box["height"] <= bottom
        assert told["x"] + told["width"] < middle - 10  # where the letter of the lower edge is
        assert status["x"] > middle + 10


def test_bars_that_find_no_room_are_named(pages):
    here = pages
    resize(here, (320, 200), left=False, right=False)
    here.wait(lambda: here.page.locator("[data-value=no-room]:has-text('fa')").count(), "what is not shown")
    resize(here, (800, 600), left=False, right=False)
    here.wait(lambda: not here.state("no_room"), "room for all")


def test_all_of_the_bar_is_within_reach_of_a_thumb(visit):
    here = visit("lines.fiblets", width=360, height=640, has_touch=True, is_mobile=True)
    here.wait(lambda: not here.state("left_open"), "the panels to close")
    assert "\n".join(faults(here, "header")) == ""
    bar = here.page.locator("header .pv-bar")
    assert bar.evaluate("bar => bar.scrollWidth <= bar.clientWidth")
    wanted = {button.get_attribute("data-action") for button in here.page.locator("header [data-action]").all()}
    wanted |= {f"view-{button.get_attribute('data-view')}" for button in here.page.locator("header [data-view]").all()}
    seen = {
        button.get_attribute("data-action")
        for button in here.page.locator("header [data-action]").all()
        if button.is_visible()
    }
    here.page.tap("[data-action=more-of-bar]")
    menu = here.page.locator(".v-overlay--active .v-list")
    menu.wait_for()
    here.stands()
    listed = here.page.locator("[data-menu]")
    names = {item.get_attribute("data-menu") for item in listed.all()}
    assert wanted - seen - names == {"screenshot"}  # of a key
    for item in listed.all():
        item.scroll_into_view_if_needed()
        box = item.bounding_box()
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= 360
        assert box["y"] + box["height"] <= 640
    here.page.tap("[data-menu=view-axial]")
    here.wait(lambda: here.state("edges").get("top") == "A", "the view from above")
    here.page.tap("[data-action=more-of-bar]")
    here.page.tap("[data-menu=picture]")
    here.page.wait_for_selector("#dialog-picture")
    here.stands()
    assert "\n".join(faults(here, "#dialog-picture")) == ""


def test_a_small_screen_begins_with_tools_as_icons_which_open_their_tabs(visit):
    for width, least in ((1920, 1200), (1280, 900)):
        here = visit("lines.fiblets", width=width, height=800, opened=False)
        here.page.goto(here.served.url)
        here.ready(tools=False).stands()
        assert here.page.locator("#pv-view").bounding_box()["width"] > least
    icons = here.page.locator("#right-rail [data-tab]")
    assert [icon.get_attribute("aria-label") for icon in icons.all()] == [
        "Clip", "Filter", "Selection", "Bundles", "Slices", "Info",
    ]  # fmt: skip
    here.page.click("#right-rail [data-tab=filter]")
    here.page.wait_for_selector("#tab-filter")
    here.stands()
    assert not icons.count()
    here.press("[")
    here.stands()
    layers = here.page.locator("#left-rail .v-btn")
    assert [layer.get_attribute("aria-label") for layer in layers.all()] == ["lines.fiblets"]
    layers.click()
    here.page.click("#properties [data-property=scalars] .v-field")
    here.press("Escape")
    here.press("]")
    here.stands()
    assert icons.count() == 6


SMALL = """() => [...document.querySelectorAll(
    ':is(#left, #right, .pv-matrix, .v-overlay--active, header, .pv-tools, #paint-tools) :is(.v-btn, .pv-colour)')]
    .filter((part) => part.checkVisibility({visibilityProperty: true}))
    .map((part) => [part, part.getBoundingClientRect()])
    .filter(([, box]) => box.width && Math.min(box.width, box.height) < 43.9)
    .map(([part, box]) => `${part.ariaLabel || part.innerText || part.outerHTML}: ${box.width} x ${box.height}`)"""
"""What is smaller than fingers need, 44 pixels."""


@pytest.mark.parametrize("size", [(390, 844), (1180, 820)], ids=lambda size: f"{size[0]}x{size[1]}")
def test_buttons_of_panels_are_as_wide_as_fingers(visit, size):
    here = visit("lines.fiblets", "--volume", "head.nii.gz", width=size[0], height=size[1], has_touch=True,
                 is_mobile=True)  # fmt: skip
    here.wait(lambda: here.layers() == 2, "both layers")

    def panel(name, *, left):
        opened = {"left_open": left, "right_open": not left, "tab": name}
        here.page.evaluate("(opened) => window.trame.state.update(opened)", opened)
        if not left:
            here.page.wait_for_selector(f"#tab-{name}")
        here.stands()
        return [f"{name}: {one}" for one in here.page.evaluate(SMALL)] + faults(here, "#left" if left else "#right")

    panel("clip", left=True)
    here.page.tap("[data-layer]:has-text('lines.fiblets')")
    here.wait(lambda: here.state("chosen_name") == "lines.fiblets", "the lines")
    wrong = panel("clip", left=True)
    for tab, button in (
        ("clip", "[data-cut=plane]"),
        ("filter", "[data-region=sphere]"),
        ("slices", "[data-action=slices-of-volume]"),
        ("slices", "[data-action=add-painted]"),
    ):
        panel(tab, left=False)
        here.page.tap(button)
        here.stands()
    for tab in ("clip", "filter", "selection", "bundles", "slices", "info"):
        wrong += panel(tab, left=False)
    here.page.evaluate("window.trame.state.update({left_open: false, right_open: false})")
    here.page.evaluate("document.querySelector('[data-action=matrix]').click()")
    here.page.wait_for_selector("#pv-matrix")
    here.stands()
    wrong += here.page.evaluate(SMALL) + faults(here, "#pv-matrix", "#paint-tools")
    strip, matrix = (here.page.locator(one).bounding_box() for one in ("#paint-tools", "#pv-matrix"))
    across = min(strip["x"] + strip["width"], matrix["x"] + matrix["width"]) - max(strip["x"], matrix["x"])
    down = min(strip["y"] + strip["height"], matrix["y"] + matrix["height"]) - max(strip["y"], matrix["y"])
    assert across <= 1 or down <= 1  # they are apart
    assert "\n".join(wrong) == ""


def test_tools_that_paint_leave_panes_free(visit):
    here = visit("lines.fiblets", "--volume", "head.nii.gz", width=390, height=844, has_touch=True, is_mobile=True)
    here.wait(lambda: here.layers() == 2, "both layers")
    here.page.evaluate("window.trame.state.update({right_open: true, tab: 'slices'})")
    here.page.tap("[data-action=slices-of-volume]")
    here.page.tap("[data-action=add-painted]")
    here.page.evaluate("window.trame.state.update({right_open: false})")
    for layout in ("beside", "grid", "narrow"):  # panes below the 3-D view, around it, and at its right
        if layout == "grid":
            here.page.evaluate("window.trame.trigger('set_layout', ['grid'])")
            here.wait(lambda: here.state("slicing")["layout"] == "grid", "the grid")
        elif layout == "narrow":
            here.page.evaluate("window.trame.trigger('set_layout', ['beside'])")
            here.page.evaluate("document.querySelector('[data-action=matrix]').click()")
            here.page.wait_for_selector("#pv-matrix")
            here.wait(lambda: here.state("slicing")["boxes"][0]["y"] == 0.0, "panes at the right")
        here.stands()
        picture = here.rests()
        strip, view = (here.page.locator(one).bounding_box() for one in ("#paint-tools", "#pv-view"))
        boxes = {one["name"]: one for one in here.state("slicing")["boxes"]}
        for name, box in boxes.items():
            left, top = view["x"] + box["x"] * view["width"], view["y"] + box["y"] * view["height"]
            across = min(strip["x"] + strip["width"], left + box["w"] * view["width"]) - max(strip["x"], left)
            down = min(strip["y"] + strip["height"], top + box["h"] * view["height"]) - max(strip["y"], top)
            assert (across > 1 and down > 1) is (name == "3d"), name
        height, width = picture.shape[:2]
        box = boxes["3d"]
        left, right = round(box["x"] * width) + 2, round((box["x"] + box["w"]) * width) - 2
        brain = picture[round(box["y"] * height) + 2 : round((box["y"] + box["h"]) * height) - 2]
        assert not (brain[:, [left, right - 1]] > 40).any()


def test_a_phone_shows_all_of_the_first_picture_and_buttons_as_wide_as_fingers(visit):
    """Of the ball, which is as wide as high."""
    import numpy as np

    here = visit("--mesh", "ball.ply", width=390, height=844, has_touch=True, is_mobile=True)
    here.wait(lambda: not here.state("left_open"), "the panels to close")
    for size in ((390, 844), (844, 390)):  # turned, too
        here.page.set_viewport_size({"width": size[0], "height": size[1]})
        here.stands()
        here.wait(lambda size=size: here.picture().shape[1] == size[0], "a picture of that size")
        lit = here.rests().max(axis=2) > 60
        for found, length in zip((lit.any(axis=0), lit.any(axis=1)), lit.shape[::-1], strict=True):
            first, last = np.flatnonzero(found)[[0, -1]]
            assert first > 0
            assert last < length - 1
        reach = max(np.ptp(np.flatnonzero(lit.any(axis=axis))) / lit.shape[1 - axis] for axis in (0, 1))
        assert reach > 0.5  # and no smaller than it must be
    here.page.set_viewport_size({"width": 390, "height": 844})
    here.stands()
    for button in here.page.locator("header .v-btn, .pv-tools .v-btn").all():
        if button.is_visible():
            box = button.bounding_box()
            assert min(box["width"], box["height"]) >= 44.0, button.get_attribute("aria-label")


def test_a_panel_of_a_phone_leaves_the_upper_half_to_the_picture(visit):
    import numpy as np

    here = visit("--mesh", "ball.ply", width=390, height=844, has_touch=True, is_mobile=True)
    here.wait(lambda: not here.state("left_open"), "the panels to close")
    closed = here.rests()
    for side, other in (("left", "right"), ("right", "left")):
        here.page.tap(f"header .v-btn:has(.mdi-dock-{side})")
        here.wait(lambda side=side, other=other: here.state(f"{side}_open") and not here.state(f"{other}_open"),
                  "one panel alone")  # fmt: skip
        here.stands()
        panel, view = (here.page.locator(one).bounding_box() for one in (f"#{side}", "#pv-view"))
        assert panel["height"] <= 0.5 * 844 + 1
        assert (panel["width"], panel["y"] + panel["height"]) == (390, 844)
        assert view["y"] + view["height"] <= panel["y"] + 1
        assert view["height"] >= 0.4 * 844
        here.wait(lambda: here.picture().shape[0] < 0.5 * 844, "a picture of that height")
        lit = here.rests().max(axis=2) > 60
        for found, length in zip((lit.any(axis=0), lit.any(axis=1)), lit.shape[::-1], strict=True):
            first, last = np.flatnonzero(found)[[0, -1]]
            assert first > 0
            assert last < length - 1
        at = here.page.evaluate(
            "([x, y]) => !!document.elementFromPoint(x, y).closest('#pv-view')",
            [view["x"] + view["width"] / 2, view["y"] + view["height"] / 2],
        )
        assert at  # nothing lies over it
    here.page.tap("header .v-btn:has(.mdi-dock-right)")
    here.wait(lambda: here.picture().shape == closed.shape, "the whole picture again")
    here.stands()
    assert all(here.page.locator(side).bounding_box()["y"] >= 844 for side in ("#left", "#right"))
    here.page.evaluate("window.trame.trigger('browse', ['', 'slices'])")
    here.page.tap("[data-entry='head.nii.gz']")
    here.wait(lambda: here.state("slicing")["shown"], "slices")
    here.page.evaluate("window.trame.state.set('right_open', true)")
    here.stands()
    here.rests()
    tools, told = (here.page.locator(one).bounding_box() for one in (".pv-tools", "#pv-told"))
    assert tools["x"] + tools["width"] <= told["x"] or tools["y"] + tools["height"] <= told["y"]


def test_a_narrow_page_begins_with_the_picture_and_none_is_stretched_by_a_new_size(visit):
    """Of the ball, which is round: at each moment after a resize it is as wide as high on the page."""
    import numpy as np

    here = visit("--mesh", "ball.ply", width=820, height=720)
    here.wait(lambda: not here.state("right_open"), "the panels to close")
    assert "\n".join(faults(here, "header")) == ""
    here.press("1")
    here.rests()
    for size in ((1280, 560), (640, 700), (700, 900)):
        here.page.evaluate(EACH_FRAME)
        here.page.set_viewport_size({"width": size[0], "height": size[1]})
        here.stands()
        view = here.page.locator("#pv-view").bounding_box()
        whole = (round(view["height"]), round(view["width"]))
        here.wait(lambda whole=whole: here.picture().shape[:2] == whole, "a picture of the new size")
        assert here.page.evaluate("[...window.fits]") == ["contain"]
        image = here.rests().max(axis=2) > 30
        rows, columns = np.flatnonzero(image.any(axis=1)), np.flatnonzero(image.any(axis=0))
        assert np.ptp(rows) == pytest.approx(np.ptp(columns), rel=0.02)
