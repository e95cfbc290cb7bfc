"""A page in use: by mouse and keys, without a network, damaged, and with graphics that go and come back."""

import base64
import io
import re

import numpy as np
import pytest
import pyvista as pv
from PIL import Image

import pvfiblets
from pvfiblets.page import writing
from pvfiblets.page.scene import CameraPlace, PageScene, fiblet_layer
from pvfiblets.page.writing import write_page
from pvfiblets.plotting.viewpoints import point_camera
from pvfiblets.synthetic import brain_streamlines
from tests.page.pages import differing, until

pytestmark = pytest.mark.more


@pytest.fixture(scope="module")
def figure(tmp_path_factory):
    """Return a page with a line across the middle of the picture and one above it."""
    x = np.linspace(-40.0, 40.0, 161)
    lines = [np.stack([x, np.full_like(x, y), np.zeros_like(x)], axis=1) for y in (0.0, 20.0)]
    scene = PageScene("Two lines", camera=CameraPlace((0.0, 0.0, 200.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    fiblet_layer(scene, pvfiblets.compress(pvfiblets.Streamlines.from_list(lines)), line_width=4.0)
    return write_page(scene, tmp_path_factory.mktemp("page") / "figure.html")[0]


def test_page_opens_from_disk_without_asking_anybody_and_graphics_that_are_lost_come_back(figure, visit):
    page = visit(figure)
    assert page.page.title() == "Two lines"
    assert set(page.requests) <= {figure.as_uri()}  # Firefox does not tell of files
    before = page.picture()
    assert (before != 255).any()
    assert not page.errors
    page.page.evaluate(
        """async () => {
            const canvas = document.getElementById('view'), gl = canvas.getContext('webgl2');
            const lose = gl.getExtension('WEBGL_lose_context');
            const once = (name) => new Promise((resolve) => canvas.addEventListener(name, resolve, {once: true}));
            const lost = once('webglcontextlost'), back = once('webglcontextrestored');
            lose.loseContext();
            await lost;
            await new Promise((resolve) => setTimeout(resolve, 0));
            lose.restoreContext();
            await back;
        }"""
    )
    np.testing.assert_array_equal(page.picture(), before)
    page.errors.clear()  # the browser itself says that a context was lost


def test_drag_turns_and_wheel_zooms(figure, visit):
    page = visit(figure)
    before = page.picture()
    page.page.mouse.move(100, 80)
    page.page.mouse.down()
    page.page.mouse.move(100, 120, steps=3)
    page.page.mouse.up()
    turned = page.picture()
    assert np.abs(turned - before).max() > 100
    state = page.page.evaluate("pvfiblets.camera.state")
    assert np.linalg.norm(state["position"]) == pytest.approx(200.0)
    page.page.mouse.wheel(0, -100)
    page.settled()
    assert np.linalg.norm(page.page.evaluate("pvfiblets.camera.state.position")) < 190.0


def test_keys_do_what_the_mouse_does(figure, visit):
    page = visit(figure)
    page.page.focus("#view")
    page.page.keyboard.press("ArrowUp")
    page.page.keyboard.press("+")
    page.settled()
    place = np.array(page.page.evaluate("pvfiblets.camera.state.position"))
    assert np.linalg.norm(place) == pytest.approx(200.0 / 1.1)
    assert abs(place[1]) > 5.0


@pytest.mark.parametrize("damage", ["cut", "header", "records"])
def test_damaged_data_are_one_sentence_on_the_page(damage, figure, visit, tmp_path):
    text = figure.read_text()
    found = re.search(r'id="data-0">([^<]*)<', text)
    data = bytearray(base64.b64decode(found[1]))
    if damage == "cut":
        data = data[: len(data) // 2]
    elif damage == "header":
        at = data.index(b'"format"')
        data[at : at + 4] = b"\xff\xff\xff\xff"
    else:
        at = data.index(b"NUMPY", data.index(b"decoding.npy")) + 127
        data[at : at + 12] = b"\xff" * 12
    broken = tmp_path / "broken.html"
    broken.write_text(text[: found.start(1)] + base64.b64encode(bytes(data)).decode() + text[found.end(1) :])
    page = visit(broken)
    assert re.fullmatch(r"[A-Z][^.]*(\.json)?(\.fiblets)?[^.]*\.( [A-Z][^.]*\.)?", page.message)
    assert "again" in page.message


@pytest.fixture(scope="module")
def packed(tmp_path_factory):
    """Return the text of a page whose arrays are packed, and the bytes of its streamlines."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(writing, "SMALL_FROM", 0)
        scene = PageScene("Packed")
        fiblet_layer(scene, pvfiblets.compress(brain_streamlines(300, seed=5)))
        text = write_page(scene, tmp_path_factory.mktemp("packed") / "packed.html")[0].read_text()
    return text, base64.b64decode(re.search(r'id="data-0">([^<]*)<', text)[1])


@pytest.mark.parametrize(
    ("what", "instead"),
    [
        (rb'"streams": \[\s*\[\s*\d+,\s*\d+,\s*(\d+)', b"9" * 9),  # tables that end elsewhere
        (rb'"streams": \[\s*\[\s*\d+,\s*\d+,\s*(\d+)', b"1" + b" " * 9),
        (rb'"streams": \[\s*\[\s*\d+,\s*(\d+)', b"9"),  # a table of no size
        (rb'"packed": \{.*?"shape": \[\s*(\d+)', b"9" * 19),
        (rb'"(streams)"', b"strmeas"),
    ],
    ids=["beyond", "within", "shift", "rows", "missing"],
)
def test_damaged_packed_arrays_are_one_sentence_on_the_page(what, instead, packed, visit, tmp_path):
    text, data = packed
    (begin, end) = re.search(what, data, re.DOTALL).span(1)
    broken = tmp_path / "broken.html"
    damaged = data[:begin] + instead[: end - begin] + data[end:]
    broken.write_text(text.replace(base64.b64encode(data).decode(), base64.b64encode(damaged).decode()))
    page = visit(broken)
    assert re.fullmatch(r"The member \S+\.npy of the file is damaged\. Copy or make the file again\.", page.message)


@pytest.fixture(scope="module")
def unset(tmp_path_factory):
    """Return a page of a plotter whose camera nobody has set, and that plotter."""
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.set_background("black")
    plotter.add_fiblets(brain_streamlines(200, seed=3), show_scalar_bar=False)
    path = plotter.fiblets.export_page(tmp_path_factory.mktemp("unset") / "unset.html")[0]
    yield path, plotter
    plotter.close()


def test_the_first_view_is_the_served_pages_in_each_window_until_the_camera_is_moved(unset, visit):
    """That of `point_camera`, by VTK's camera."""
    path, plotter = unset
    page = visit(path, size=(320, 200))

    def camera():
        page.page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        return page.settled().page.evaluate("pvfiblets.camera.state")

    def expected(view="oblique"):
        point_camera(plotter, view)
        return plotter.camera

    def same(found, wanted):
        np.testing.assert_allclose(found["position"], wanted.position, rtol=1e-3, atol=0.3)
        np.testing.assert_allclose(found["focal_point"], wanted.focal_point, atol=0.3)
        np.testing.assert_allclose(found["up"], wanted.up, atol=1e-6)
        assert found["view_angle"] == pytest.approx(wanted.view_angle, rel=5e-3)

    for size in ((320, 200), (200, 320), (640, 360)):
        page.page.set_viewport_size({"width": size[0], "height": size[1]})
        plotter.window_size = size
        same(camera(), expected())
        lit = (page.picture() > 40).any(axis=2)
        assert not np.concatenate([lit[0], lit[-1], lit[:, 0], lit[:, -1]]).any()  # nothing is cut off
        reach = [np.ptp(np.flatnonzero(lit.any(axis=axis))) / lit.shape[1 - axis] for axis in (0, 1)]
        assert max(reach) > 0.6
    page.page.click("#panel summary")
    page.page.get_by_role("button", name="Left", exact=True).click()
    same(camera(), expected("sagittal"))
    page.page.get_by_role("button", name="Reset").click()
    same(camera(), expected())
    page.page.focus("#view")
    page.page.keyboard.press("ArrowLeft")
    before = camera()
    page.page.set_viewport_size({"width": 320, "height": 320})
    assert camera() == before


def test_letters_of_orientation_can_be_read_on_each_background(unset, visit):
    """By the contrast of WCAG 2.2, of the letters and what lies behind them at once, wherever they are."""

    def luminance(colour):
        red, green, blue = (float(part) / 255.0 for part in re.findall(r"[0-9.]+", colour)[:3])
        linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in (red, green, blue)]
        return float(np.dot(linear, (0.2126, 0.7152, 0.0722)))

    page = visit(unset[0], size=(320, 260))
    letters = page.page.locator(".axis").evaluate_all(
        "all => all.map((one) => { const {color, backgroundColor, opacity} = getComputedStyle(one);"
        " return [one.textContent, color, backgroundColor, opacity]; })"
    )
    assert {letter for letter, *_ in letters} == set("LRPAIS")
    shown = np.asarray(Image.open(io.BytesIO(page.page.screenshot())).convert("RGB")).astype(int)
    for one, (letter, colour, *_) in zip(page.page.locator(".axis").all(), letters, strict=True):
        box = one.bounding_box()
        around = shown[int(box["y"]) : int(box["y"] + 20), int(box["x"]) : int(box["x"] + 20)]
        own = np.array([int(part) for part in re.findall(r"\d+", colour)])
        assert (np.abs(around - own).max(axis=2) < 60).any(), letter
    for letter, colour, behind, opacity in letters:
        assert not behind.startswith("rgba"), letter  # not to be seen through
        assert opacity == "1"
        low, high = sorted((luminance(colour), luminance(behind)))
        assert (high + 0.05) / (low + 0.05) >= 4.5, letter


def test_page_fills_small_and_large_windows(figure, visit):
    for size in ((320, 480), (2560, 1440)):
        page = visit(figure, size=size)
        assert page.picture().shape == (size[1], size[0], 3)
        assert page.page.evaluate("document.documentElement.scrollWidth") == size[0]


# Browsers that would have all users alike (Firefox where it resists fingerprinting, as the Tor Browser does) promise no
# more than WebGL 2 does, and give noise for what is read of a picture.
LEAST = """
const own = WebGL2RenderingContext.prototype, {getParameter, texStorage2D} = own, most = 2048;
own.getParameter = function (name) { return name === this.MAX_TEXTURE_SIZE ? most : getParameter.call(this, name); };
own.texStorage2D = function (target, levels, format, width, height) {
    if (Math.max(width, height) <= most) texStorage2D.call(this, target, levels, format, width, height);
};
"""
NOISE = """
const own = WebGL2RenderingContext.prototype, {readPixels} = own;
own.readPixels = function (...given) {
    readPixels.apply(this, given);
    crypto.getRandomValues(given[6]);
};
"""


@pytest.fixture(scope="module")
def dense(tmp_path_factory):
    """Return a page whose data take several rows of textures, of points with values."""
    lines = list(brain_streamlines(200, seed=3))
    values = np.concatenate([np.linspace(0.0, 1.0, len(line)) for line in lines])
    fiblets = pvfiblets.compress(
        pvfiblets.Streamlines.from_list(lines, per_point={"share": values}), per_point=["share"]
    )
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.set_background("white")
    plotter.add_fiblets(fiblets, scalars="share", show_scalar_bar=False)
    path = plotter.fiblets.export_page(tmp_path_factory.mktemp("dense") / "dense.html")[0]
    plotter.close()
    return path


def test_page_draws_with_the_least_that_browsers_have(dense, visit):
    expected = visit(dense).picture()
    assert (expected != 255).any(axis=2).mean() > 0.1
    np.testing.assert_array_equal(visit(dense, before=LEAST).picture(), expected)


def test_page_that_may_not_read_its_picture_shows_it_and_says_why_clicks_tell_nothing(dense, visit):
    def shown(page):
        page.settled()
        for _ in range(2):  # what others hide is left out, by what was seen last
            page.page.evaluate("[pvfiblets.few = 0, pvfiblets.change(), pvfiblets.settled()][2]")
        data = page.page.locator("#view").screenshot()
        return np.asarray(Image.open(io.BytesIO(data)).convert("RGB")).astype(np.int16)

    page = visit(dense, before=NOISE)
    wrong, drawn = differing(shown(page), shown(visit(dense)))
    assert drawn > 0.1
    assert wrong < 1e-3  # of two lines at the same depth either may be drawn
    page.page.mouse.click(100, 80)
    said = "Your browser does not let this page read its image; allow that to pick streamlines."
    assert page.page.locator("#status").inner_text() == said
    page.page.click("#panel summary")
    page.page.get_by_role("button", name="Save image").click()
    until(page.page, "document.getElementById('status').textContent.endsWith('save images.')")


def _ink(page, rows):
    return (page.picture()[rows] != 255).any(axis=2).sum()


def test_a_click_tells_the_streamline_and_balls_and_boxes_there_choose_with_switches(figure, visit):
    page = visit(figure)
    above, middle = slice(20, 60), slice(70, 90)
    page.page.mouse.click(100, 80)  # on the line through the middle
    status = page.page.locator("#status")
    status.wait_for(state="visible")
    said = status.inner_text()
    assert said.startswith("Streamline 0 of streamlines; at ")
    place = [float(part) for part in re.search(r"at (.*) mm", said)[1].split(", ")]
    np.testing.assert_allclose(place, (0.0, 0.0, 0.0), atol=0.6)
    page.page.click("#panel summary")
    page.page.get_by_role("button", name="Add a ball").click()
    assert status.inner_text() == "1 streamlines are shown"
    assert page.page.locator("#over > svg > path").count() == 1
    assert _ink(page, above) == 0 < _ink(page, middle)
    ball = page.page.locator("details", has=page.page.locator("summary", has_text=re.compile("^Ball 1$"))).last
    ball.get_by_label("Exclude").check()
    assert _ink(page, middle) == 0 < _ink(page, above)
    ball.get_by_label("Exclude").uncheck()
    ball.get_by_label("On").uncheck()
    assert min(_ink(page, middle), _ink(page, above)) > 0
    ball.get_by_label("On").check()
    for place, count in (("10", 0), ("20", 1)):  # between the lines; on the upper one
        ball.get_by_label("y, mm").fill(place)
        until(page.page, f"document.getElementById('status').textContent.startsWith('{count} ')")
    assert _ink(page, middle) == 0 < _ink(page, above)
    page.page.get_by_role("button", name="Add a box").click()  # around the picked place: no line passes through both
    assert status.inner_text() == "0 streamlines are shown"
    box = page.page.locator("details", has=page.page.locator("summary", has_text=re.compile("^Box 2$"))).last
    box.get_by_label("Half-width y, mm").fill("20.5")
    until(page.page, "document.getElementById('status').textContent.startsWith('1 ')")
    ball.get_by_role("button", name="Remove ball 1").click()
    assert status.inner_text() == "2 streamlines are shown"
    box.get_by_role("button", name="Remove box 2").click()
    assert status.inner_text() == ""
    assert page.page.locator("#over > svg > path").count() == 0
    assert min(_ink(page, middle), _ink(page, above)) > 0


@pytest.fixture(scope="module")
def rich(tmp_path_factory):
    """Return a page with groups by colour, an image's slice, lengths, and a scale of numbers."""
    x = np.linspace(-40.0, 40.0, 161)
    lines = [np.stack([x[:n], np.full(n, y), np.zeros(n)], axis=1) for n, y in ((161, 0.0), (161, 20.0), (81, 10.0))]
    fiblets = pvfiblets.compress(
        pvfiblets.Streamlines.from_list(lines, groups={"low </li>": np.array([0]), "both": np.array([0, 1])})
    )
    plotter = pv.Plotter(off_screen=True, window_size=(320, 260))
    plotter.set_background("white")
    plotter.add_fiblets(fiblets, scalars="group", line_width=4.0, name="tracts", lighting=False)
    plotter.add_fiblets(fiblets, scalars="length", line_width=1.0, name="lengths", lighting=False)
    plane = pv.Plane(center=(0.0, -20.0, 0.0), i_size=40.0, j_size=10.0).triangulate()
    plotter.add_mesh(plane, color="black", name="plane", lighting=False)
    plotter.camera_position = [(0.0, 0.0, 200.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    path = plotter.fiblets.export_page(tmp_path_factory.mktemp("rich") / "rich.html")[0]
    plotter.close()
    return path


def test_groups_have_switches_and_names_stand_by_their_colours(rich, visit):
    page = visit(rich, size=(320, 260))
    page.page.click("#panel summary")
    page.page.get_by_label("lengths", exact=True).uncheck()
    shown = "Array.from(pvfiblets.lines[0].set.blocks).length"
    assert page.page.evaluate(shown) == 1
    names = page.page.locator(".bar li").all_inner_texts()
    assert names == ["low </li>", "both"]
    whole = _ink(page, slice(None))
    groups = page.page.locator("fieldset", has_text="Groups of tracts")
    groups.get_by_label("both").uncheck()  # the upper line goes, the lower one is in another group that is on
    upper = _ink(page, slice(None))
    assert 0 < upper < whole
    groups.get_by_label("low </li>").uncheck()  # what is in no group stays
    assert 0 < _ink(page, slice(None)) < upper
    groups.get_by_label("both").check()
    groups.get_by_label("low </li>").check()
    assert _ink(page, slice(None)) == whole


def test_sliders_choose_by_numbers_and_fade_surfaces(rich, visit):
    page = visit(rich, size=(320, 260))
    page.page.click("#panel summary")
    page.page.get_by_label("tracts", exact=True).uncheck()
    whole = _ink(page, slice(None))
    lengths = page.page.locator("fieldset", has=page.page.locator("legend", has_text=re.compile("^length"))).last
    lengths.get_by_label("Minimum").fill("60")
    fewer = _ink(page, slice(None))
    assert 0 < fewer < whole
    assert float(lengths.locator("output").first.inner_text()) == pytest.approx(60.0, abs=0.5)
    lengths.get_by_label("Minimum").fill("0")
    assert _ink(page, slice(None)) == whole
    black = (page.picture() < 40).all(axis=2).sum()
    assert black > 500
    page.page.get_by_label("Opacity").fill("0.3")
    assert (page.picture() < 40).all(axis=2).sum() < 0.1 * black


def test_letters_turn_with_the_camera(rich, visit):
    page = visit(rich, size=(320, 260))

    def place(letter):
        box = page.page.locator(".axis", has_text=re.compile(f"^{letter}$")).bounding_box()
        return np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])

    assert place("R")[0] - place("L")[0] > 50  # from above: x to the right
    assert place("P")[1] - place("A")[1] > 50
    page.page.click("#panel summary")
    page.page.get_by_role("button", name="Left").click()
    page.settled()
    assert place("I")[1] - place("S")[1] > 50
    assert abs(place("R")[0] - place("L")[0]) < 1


def test_fingers_turn_and_zoom(figure, visit):
    page = visit(figure, has_touch=True)
    touch = page.context.new_cdp_session(page.page)

    def fingers(kind, *places):
        points = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(places)]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    fingers("touchStart", (100, 80))
    fingers("touchMove", (100, 110))
    fingers("touchEnd")
    page.settled()
    turned = np.array(page.page.evaluate("pvfiblets.camera.state.position"))
    assert np.linalg.norm(turned) == pytest.approx(200.0)
    assert abs(turned[1]) > 50.0
    fingers("touchStart", (80, 80), (120, 80))
    fingers("touchMove", (60, 80), (140, 80))
    fingers("touchEnd")
    page.settled()
    state = page.page.evaluate("pvfiblets.camera.state")
    assert np.linalg.norm(np.subtract(state["position"], state["focal_point"])) == pytest.approx(100.0, rel=0.05)


def test_controls_are_as_high_as_fingers_are_wide_on_touch_screens(rich, visit):
    page = visit(rich, size=(390, 844), has_touch=True, is_mobile=True).page
    page.tap("#panel summary")
    page.get_by_role("button", name="Add a ball").tap()
    parts = page.locator("#panel").locator("button, select, label, summary").all()
    assert len(parts) > 20
    for part in parts:
        assert part.bounding_box()["height"] >= 44.0, part.inner_text()
    last = page.get_by_role("button", name="Remove ball 1")
    last.scroll_into_view_if_needed()
    last.tap()  # the scales of colours do not lie over it
    assert not last.count()


def test_keys_reach_every_control_and_all_are_named(rich, visit):
    page = visit(rich, size=(320, 260)).page
    said = page.locator("body").aria_snapshot()
    assert 'img "Interactive 3-D picture. Arrow keys turn it' in said
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "view"
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.tagName") == "SUMMARY"
    page.keyboard.press("Enter")
    reached = set()
    for _ in range(80):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("[...document.querySelectorAll('#panel *')].indexOf(document.activeElement)"))
    controls = page.evaluate(
        "[...document.querySelectorAll('#panel *')]"
        ".flatMap((one, i) => one.matches('input, select, button') ? [i] : [])"
    )
    assert set(controls) <= reached
    said = page.locator("#panel").aria_snapshot()
    for name in (
        'checkbox "tracts"',
        'slider "Line width"',
        'group "Regions"',
        'button "Add a ball"',
        'combobox "Cut across"',
    ):
        assert name in said
    assert not re.search(r"^\s*- (checkbox|slider|button|combobox)(:|$| \[)", said, re.MULTILINE)


def test_loads_leave_no_memory_behind(figure, visit):
    page = visit(figure)
    meter = page.context.new_cdp_session(page.page)

    def used():
        meter.send("HeapProfiler.collectGarbage")
        return {one["name"]: one["value"] for one in meter.send("Performance.getMetrics")["metrics"]}

    meter.send("Performance.enable")
    found = []
    for _ in range(5):
        page.page.reload()
        page.page.wait_for_selector("body[data-state=drawn]")
        found.append(used())
    assert found[-1]["JSHeapUsedSize"] < 1.1 * found[1]["JSHeapUsedSize"]
    assert found[-1]["Nodes"] <= found[1]["Nodes"]
    assert found[-1]["Documents"] <= found[1]["Documents"]


def test_slab_view_and_width_are_set_by_named_controls(figure, visit):
    page = visit(figure, size=(320, 400))
    whole = (page.picture() != 255).any(axis=2).sum()
    page.page.click("#panel summary")
    page.page.get_by_label("Cut across").select_option("left to right")
    cut = (page.picture() != 255).any(axis=2).sum()
    assert 0.05 * whole < cut < 0.25 * whole  # an eighth of the lines
    page.page.get_by_label("Cut across").select_option("nothing")
    page.page.get_by_label("Line width").fill("8")
    assert (page.picture() != 255).any(axis=2).sum() > 1.5 * whole
    page.page.get_by_role("button", name="Top").click()
    page.settled()
    place = page.page.evaluate("pvfiblets.camera.state.position")
    assert place[2] > 100.0
    unnamed = page.page.evaluate(
        "[...document.querySelectorAll('input, select, button')].filter((one) => "
        "!(one.labels && one.labels.length) && !one.textContent && !one.ariaLabel).length"
    )
    assert unnamed == 0
