"""Scenes that the browser draws (``serve --draw there``), in Chromium with WebGL 2 on the processor."""

import base64
import io
import json
from urllib.parse import urlsplit

import numpy as np
import pytest
from PIL import Image

from tests.page.conftest import WEBGL
from tests.page.pages import differing
from tests.web.browsing import ANSWER, FLAGS, LOAD, Visit, launched
from tests.web.cable import Cable

pytestmark = pytest.mark.more

TAKEN = """() => {
    const {camera, ...shown} = pvfibletsThere.scene;
    return JSON.stringify(shown) === JSON.stringify(trame.state.get('there').scene);
}"""
"""Whether the page shows the scene that it was told; data may have to come first."""


class There(Visit):
    """A page that draws by itself."""

    def ready(self):
        self.page.wait_for_selector("#pv-there", state="attached")
        self.wait(self.draws, "a picture that the browser draws")
        return self.unfold()

    def draws(self):
        return self.page.evaluate(
            "Boolean(window.pvfibletsThere?.frames && trame.state.get('there').on"
            " && document.querySelector('#pv-there').style.visibility === 'visible')"
        )

    def rests(self):
        self.wait(self.draws, "a picture that the browser draws")
        agrees(self)

    def in_step(self):
        """Wait until the server knows where the browser's camera is."""

        def known():
            here, there = self.page.evaluate("pvfibletsThere.camera.state"), self.session()["camera"]
            return all(np.allclose(here[name], there[name]) for name in ("position", "focal_point", "up"))

        self.wait(known, "the server to know the camera")

    def drawn(self):
        """Return what the browser has drawn of the scene that it was told last, finished."""
        self.wait(lambda: self.page.evaluate(TAKEN), "the scene to be taken")
        width, data = self.page.evaluate(
            """async () => {
                await pvfibletsThere.settled();
                const bytes = pvfibletsThere.pixels();
                let text = '';
                for (let i = 0; i < bytes.length; i += 32768)
                    text += String.fromCharCode(...bytes.subarray(i, i + 32768));
                return [pvfibletsThere.width, btoa(text)];
            }"""
        )
        return np.frombuffer(base64.b64decode(data), np.uint8).reshape(-1, width, 4)[..., :3].astype(np.int16)

    def of_server(self):
        """Return what the server draws of the same scene."""
        data = self.page.evaluate(
            """async () => {
                const found = await trame.trigger('picture');
                const bytes = new Uint8Array(found instanceof Blob ? await found.arrayBuffer() : found);
                let text = '';
                for (let i = 0; i < bytes.length; i += 32768)
                    text += String.fromCharCode(...bytes.subarray(i, i + 32768));
                return btoa(text);
            }"""
        )
        return np.asarray(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB")).astype(np.int16)

    def session(self):
        return json.loads(self.page.evaluate("trame.trigger('save_session')"))

    def sends(self, act):
        """Return the bytes of the largest message that comes while something is done, and what is fetched."""
        before, fetched = len(self.received), len(self.requests)
        act()
        self.in_step()
        for _ in range(2):
            self.page.evaluate(ANSWER)  # by then it is drawn; then, by then what follows from that is sent
        self.drawn()
        return max(self.received[before:], default=0), [url for url in self.requests[fetched:] if "/there/" in url]


@pytest.fixture(scope="module")
def browser():
    """Return Chromium with WebGL 2, or skip where there is none."""
    with launched([*(flag for flag in FLAGS if flag != "--disable-gpu"), *WEBGL]) as found:
        yield found


@pytest.fixture(scope="module")
def server(served):
    """Return the server of all tests here."""
    return served("lines.fiblets", "--mesh", "ball.ply", "--draw", "there")


@pytest.fixture(scope="module")
def cable(server):
    """Return the cable by which the page reaches it."""
    cable = Cable(urlsplit(server.base).port)
    yield cable
    cable.close()


@pytest.fixture(scope="module")
def _page(browser, server, cable):
    found = There(browser, server)
    found.page.goto(server.url.replace(str(urlsplit(server.base).port), str(cable.port), 1))
    yield found.ready().remember()
    found.close()


@pytest.fixture
def here(_page):
    """Return the page, which tests share; each finds it as the first one did."""
    yield _page.begin_again()
    errors, _page.errors[:] = list(_page.errors), []
    assert not errors


def agrees(page):
    """Wait until the browser's picture is the server's, of something."""

    def same():
        wrong, drawn = differing(page.drawn(), page.of_server())
        # Most of them are edges of the ball, which VTK has smooth.
        return drawn > 0.01 and wrong < 0.03

    return page.wait(same, "the server's picture")


def test_lines_and_surfaces_are_the_servers(here):
    assert agrees(here)
    assert here.state("frame") == "drawn by this browser"
    assert not here.page.locator("#pv-view img[src^=blob]").count()  # of the server there is no picture


def test_moving_sends_no_picture_and_the_session_knows_the_camera(here):
    before, camera = here.drawn(), here.session()["camera"]
    largest, fetched = here.sends(here.drag)
    assert largest < 5000
    assert not fetched
    assert np.abs(here.drawn() - before).mean() > 1.0
    now = here.session()["camera"]
    assert now != camera
    assert now["position"] == pytest.approx(here.page.evaluate("pvfibletsThere.camera.state.position"))
    assert agrees(here)
    here.tab("info")
    here.wait(lambda: here.state("info"), "the facts of the layer")
    here.press("1")  # the server moves it, too
    here.wait(lambda: here.session()["camera"]["position"] != now["position"], "the view from above")
    above = here.session()["camera"]["position"]
    here.wait(
        lambda: np.allclose(here.page.evaluate("pvfibletsThere.camera.state.position"), above),
        "the page's view from above",
    )
    assert agrees(here)


def test_filters_colours_and_selections_send_what_they_change(here):
    layer = here.state("layers")[0]["id"]
    here.page.click("[data-layer] >> nth=0")
    scene = here.state("there")["scene"]
    _, fetched = here.sends(
        lambda: [
            here.page.evaluate("trame.trigger('slide', ['criterion', '', 'length', [40.5, 80]])"),
            here.wait(lambda: here.state("there")["scene"] != scene, "another scene"),
        ]
    )
    here.page.evaluate("trame.trigger('release')")
    assert len(fetched) <= 1  # a byte for each streamline
    assert agrees(here)
    here.press("b")
    here.page.wait_for_selector("#pv-over[data-tool=box]")
    here.drag((0.15, 0.02), (0.5, 0.98))
    here.wait(lambda: here.state("selection")["count"] > 0, "a selection")
    assert 0 < here.state("selection")["count"] < 29
    assert agrees(here)
    here.page.evaluate("(id) => trame.trigger('slide', ['property', id, 'selection_dim', 0.3])", layer)
    assert agrees(here)
    here.choose("scalars", "fa")
    here.page.wait_for_selector("#pv-there-bars figcaption:has-text('fa')")


def test_a_ball_and_a_box_cut_as_the_server_cuts(here):
    seen = here.drawn()

    def changes(what):
        nonlocal seen
        before = seen
        here.wait(lambda: np.abs(here.drawn() - before).mean() > 0.05, what)
        assert agrees(here)
        seen = here.drawn()

    here.tab("clip")
    for kind in ("sphere", "box"):  # a box of which the outside stays is no planes
        here.page.click(f"[data-cut={kind}]")
        changes("what lies inside")
        here.page.click("[data-clip] [data-action=side]")
        changes("what lies outside")
        here.page.click("[data-clip] [aria-label=Remove]")
        changes("all")
    assert here.state("drawing") == ""


def test_slices_in_the_view_are_drawn_and_moved_without_the_lines(here):
    before = here.drawn()
    here.tab("slices")
    here.page.click("[data-action=open-slices]")
    here.page.click("#dialog-open .v-list-item:has-text('head.nii.gz')")
    here.wait(lambda: here.state("slicing")["shown"], "slices")
    here.page.evaluate("trame.trigger('set_layout', ['3d'])")
    here.wait(lambda: here.drawn().shape == before.shape and np.abs(here.drawn() - before).mean() > 2.0, "slices")
    assert agrees(here)
    place = here.state("slicing")["position"]
    known = len(here.requests)
    largest, fetched = here.sends(
        lambda: [
            here.page.evaluate("trame.trigger('step_slice', [0.5, 0.5, 0, 0, 2])"),
            here.wait(lambda: here.state("slicing")["position"] != place, "another slice"),
            here.wait(lambda: any("/there/" in url for url in here.requests[known:]), "its pixels"),
        ]
    )
    assert largest < 20_000
    assert len(fetched) == 1  # of three slices one
    assert agrees(here)
    place = here.state("slicing")["position"]
    box = here.page.locator("#pv-there").bounding_box()
    here.page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.45 * box["height"])
    here.wait(lambda: here.state("slicing")["position"] != place, "the place that was clicked on")
    here.drag()
    assert agrees(here)


def test_a_scene_that_is_slow_to_come_is_announced_until_it_is_drawn(here):
    """Of data that come late and are fetched by the page alone."""
    note = here.page.locator("#pv-there-progress")
    assert not note.is_visible()
    held = []
    here.page.route("**/there/*", lambda route: held.append(route))
    here.page.click("[data-layer] >> nth=0")
    here.choose("scalars", "fa")
    note.wait_for()
    assert note.inner_text() == "Drawing the scene…"
    here.wait(lambda: held, "what is fetched")
    for route in held:
        route.continue_()
    here.page.unroute("**/there/*")
    note.wait_for(state="hidden")
    assert here.page.evaluate(TAKEN)


def test_panes_are_the_servers_beside_the_browsers_view(here):
    here.tab("slices")
    here.page.click("[data-action=open-slices]")
    here.page.click("#dialog-open .v-list-item:has-text('head.nii.gz')")
    here.wait(lambda: here.state("slicing")["shown"], "slices")
    here.page.evaluate("trame.trigger('set_layout', ['beside'])")
    names = {"3d", "axial", "coronal", "sagittal"}
    here.wait(lambda: {one["name"] for one in here.state("slicing")["boxes"]} == names, "panes")

    def part(picture, name):
        height, width = picture.shape[:2]
        (box,) = (one for one in here.state("slicing")["boxes"] if one["name"] == name)
        x, y, w, h = (round(box[key] * size) for key, size in zip("xywh", (width, height, width, height), strict=True))
        return picture[y : y + h, x : x + w]

    def same():
        view, server = here.drawn(), part(here.of_server(), "3d")
        if view.shape != server.shape:
            return False
        wrong, drawn = differing(view, server)
        return drawn > 0.1 and wrong < 0.02

    def axial():
        return part(here.picture(), "axial")

    view = here.page.locator("#pv-there")
    whole, image = here.page.locator("#pv-view").bounding_box(), here.page.locator("#pv-view img[src^=blob]")
    here.wait(lambda: image.count() and axial().size and axial().max() > 60, "panes")
    here.wait(lambda: view.bounding_box()["height"] < whole["height"], "the view beside them")
    here.wait(same, "the view to be the server's")
    assert here.state("frame") == "drawn by this browser"
    before = axial()
    largest, fetched = here.sends(lambda: here.drag((0.3, 0.3), (0.5, 0.3)))  # in the 3-D view
    assert largest < 5000
    assert not fetched
    assert np.array_equal(axial(), before)
    here.wait(same, "the server to know of the camera")
    place = here.state("slicing")["position"]
    (box,) = (one for one in here.state("slicing")["boxes"] if one["name"] == "coronal")
    x, y = box["x"] + 0.6 * box["w"], box["y"] + 0.4 * box["h"]
    here.page.mouse.click(whole["x"] + x * whole["width"], whole["y"] + y * whole["height"])
    here.wait(lambda: here.state("slicing")["position"] != place, "another place")
    here.wait(lambda: not np.array_equal(axial(), before), "its slices")
    here.wait(same, "them in the view")
    here.page.evaluate("trame.trigger('set_layout', ['axial'])")
    here.told("The server draws: a browser cannot draw panes of slices.")


def test_distances_lie_over_the_picture_where_the_server_has_them(here):
    session = here.session() | {"measurements": [[[0, 0, 0], [60, 36, 20]], [[20, 18, 2], [20, 18, 40]]]}
    here.page.evaluate(LOAD, json.dumps(session))
    here.page.wait_for_selector("#pv-there-distances text >> nth=1")
    for _ in range(2):  # then from elsewhere
        assert here.page.locator("#pv-there-distances text").all_text_contents() == ["72.77 mm", "38 mm"]
        here.drawn()
        server = here.of_server()
        for line in here.page.locator("#pv-there-distances line").all():
            x1, y1, x2, y2 = (float(line.get_attribute(name)) for name in ("x1", "y1", "x2", "y2"))
            share = np.linspace(0.02, 0.98, 200)[:, None]
            x, y = np.int64((np.array([x1, y1]) + share * (x2 - x1, y2 - y1)).T)
            seen = (x > 0) & (x < server.shape[1] - 1) & (y > 0) & (y < server.shape[0] - 1)
            assert seen.sum() > 50
            yellow = np.abs(server[y[seen], x[seen]] - (255, 204, 0)).max(axis=1) < 60
            assert yellow.mean() > 0.8  # the rest is beneath letters and their shadows
        here.drag()
        here.in_step()
    assert here.state("drawing") == ""
    here.page.evaluate(LOAD, here.begun)
    here.page.wait_for_selector("#pv-there-distances svg", state="detached")


def test_spline_tubes_are_drawn_as_the_server_draws_them(here):
    here.page.evaluate("trame.trigger('browse', [''])")
    here.page.click("[data-entry='vessel.vtp']")
    here.wait(lambda: here.layers() == 3, "the tubes")
    for name in ("lines.fiblets", "ball.ply"):
        here.page.click(f"[data-layer]:has-text('{name}') [data-action=eye]")
    here.wait(lambda: [one["kind"] for one in here.state("there")["scene"]["layers"]] == ["surface"], "the tubes alone")
    here.press("r")
    here.wait(lambda: differing(here.drawn(), here.of_server())[1] > 0.01, "something of them")
    wrong, _ = differing(here.drawn(), here.of_server())
    assert wrong < 0.15  # tubes have flat sides and ends
    assert here.state("frame") == "drawn by this browser"


def test_what_the_browser_cannot_draw_the_server_draws_and_says_so(here):
    layer = here.state("layers")[0]["id"]
    picture = here.page.locator("#pv-view img[src^=blob]")
    here.page.evaluate("(id) => trame.trigger('slide', ['property', id, 'opacity', 0.5])", layer)
    here.page.evaluate("trame.trigger('release')")
    assert agrees(here)
    here.page.evaluate("(id) => trame.trigger('slide', ['property', id, 'halos', true])", layer)
    here.page.evaluate("trame.trigger('release')")
    here.wait(lambda: not here.state("there")["on"], "the server to draw")
    said = "The server draws: a browser cannot draw halos of 'lines.fiblets'."
    here.told(said)
    assert here.state("drawing") == said
    here.wait(lambda: picture.count() and here.picture().std() > 1.0, "the server's picture")
    here.page.wait_for_function("document.querySelector('#pv-there').style.visibility === 'hidden'")
    here.press("Control+z")
    here.wait(here.draws, "the browser to draw again")
    assert here.state("drawing") == ""
    assert agrees(here)


def test_a_page_that_loses_its_graphics_has_the_servers_pictures(here):
    expected = here.of_server()
    lose = "window.lost = pvfibletsThere.canvas.getContext('webgl2').getExtension('WEBGL_lose_context')"
    here.page.evaluate(f"{lose}; lost.loseContext()")
    here.wait(lambda: "lost its graphics" in here.state("drawing"), "why the server draws")
    here.told("The server draws: this browser lost its graphics.")
    assert not here.state("there")["on"]
    assert (np.abs(Visit.rests(here) - expected).max(axis=2) > 60).mean() < 0.01
    here.page.evaluate("lost.restoreContext()")
    here.wait(here.draws, "the browser to draw again")
    assert agrees(here)


def test_a_page_that_was_reloaded_or_cut_off_draws_again(here, cable):
    here.drag()
    here.in_step()
    before = here.drawn()
    here.page.reload()
    here.ready()
    here.wait(lambda: np.array_equal(here.drawn(), before), "what was drawn before")
    cable.cut()
    lost = here.page.locator("#pv-lost")
    lost.wait_for()
    assert lost.locator("canvas").evaluate_all(
        "all => all.some((one) => one.width > 300 && one.getContext('2d')?.getImageData(0, 0, one.width, one.height)"
        ".data.some((part, k) => k % 4 < 3 && part > 60))"
    )  # what was drawn is still seen
    cable.mend()
    now = "[...document.querySelectorAll('#pv-lost button')].find((one) => one.textContent === 'Try now')?.click()"
    here.page.evaluate(now)  # unless it has tried by itself meanwhile
    here.wait(lambda: lost.count() == 0, "the page again")
    here.ready()
    here.wait(lambda: np.array_equal(here.drawn(), before), "what was drawn before")
    here.drag((0.6, 0.5), (0.4, 0.5))
    assert np.abs(here.drawn() - before).mean() > 1.0
    assert agrees(here)
    assert all("ERR_" in error or "Bad Gateway" in error for error in here.errors), here.errors
    here.errors.clear()  # Chromium logs what could not be reached
