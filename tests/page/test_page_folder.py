"""Pages whose data lie beside them, from servers with and without ranges of bytes."""

import re
import threading
from contextlib import ExitStack

import numpy as np
import pytest

import pvfiblets
from pvfiblets.page.scene import CameraPlace, PageScene, encoded, fiblet_layer
from pvfiblets.page.writing import write_page
from tests.page.pages import Page, Silent, serving, until

SHORT = 70_000  # more fiblets than a page asks for together
PATIENCE = 60.0


class Whole(Silent):
    """Python's own server, which notes what is asked for."""

    asked: list[str]
    go_on: threading.Event

    def do_GET(self):
        self.asked.append(self.headers.get("Range", ""))
        super().do_GET()


class Slow(Whole):
    """The same, which gives the last codes of a set, and what comes after them, only when it may."""

    def copyfile(self, source, outputfile):
        data = source.read()
        most = data.index(b"reach.npy") - 1000 if self.path.endswith(".fiblets") else len(data)
        outputfile.write(data[:most])
        outputfile.flush()
        assert most == len(data) or self.go_on.wait(PATIENCE)
        outputfile.write(data[most:])


class Ranged(Whole):
    """One with ranges; of a set's codes it gives the last only when it may."""

    def do_GET(self):
        found = re.fullmatch(r"bytes=(\d+)-(\d+)", self.headers.get("Range", ""))
        path = self.directory_path / self.path.lstrip("/")
        if not found or not self.path.endswith(".fiblets") or not path.is_file():
            super().do_GET()
            return
        self.asked.append(found[0])
        data = path.read_bytes()
        begin, end = int(found[1]), int(found[2]) + 1
        if end - begin > 10_000 and sum("-" in range_ for range_ in self.asked) > 12:
            assert self.go_on.wait(PATIENCE)
        self.send_response(206)
        self.send_header("Content-Range", f"bytes {begin}-{end - 1}/{len(data)}")
        self.send_header("Content-Length", str(end - begin))
        self.end_headers()
        self.wfile.write(data[begin:end])


@pytest.fixture(scope="module")
def scene():
    rng = np.random.default_rng(7)
    starts = rng.uniform(-40.0, 40.0, (SHORT, 1, 3))
    points = starts + np.array([[0.0, 0.0, 0.0], [0.4, 0.1, 0.0], [0.8, 0.0, 0.0]])
    streamlines = pvfiblets.Streamlines(
        points.reshape(-1, 3), np.arange(0, 3 * SHORT + 1, 3), per_point={"x": points[..., 0].ravel()}
    )
    scene = PageScene("Beside", camera=CameraPlace((0.0, 0.0, 200.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    fiblets = pvfiblets.compress(streamlines, per_point=["x"])
    assert fiblets.n_fiblets > 65_536
    table = np.repeat(np.arange(256, dtype=np.uint8)[:, None], 4, axis=1)
    table[:, 3] = 255
    colours = {"mode": "point_scalar", "values": "x", "clim": (-40, 40), "log": False}
    colours["table"] = encoded(np.concatenate([table, table[:3]]))
    fiblet_layer(scene, fiblets, colours=colours, keep=("x",))
    return scene


@pytest.fixture(scope="module")
def folder(scene, tmp_path_factory):
    folder = tmp_path_factory.mktemp("beside")
    page, data = write_page(scene, folder / "figure.html", largest_file=1000)
    assert data == folder / "figure_data" / "0.fiblets"
    write_page(scene, folder / "one.html")
    return folder


@pytest.fixture
def serve(folder):
    """Return a function that serves the folder by a handler: the address, the handler."""
    handlers, servers = [], ExitStack()

    def start(kind, *, wait=False):
        handler = type(kind.__name__, (kind,), {"asked": [], "go_on": threading.Event(), "directory_path": folder})
        if not wait:
            handler.go_on.set()
        handlers.append(handler)
        return servers.enter_context(serving(folder, handler)), handler

    with servers:
        yield start
        for handler in handlers:
            handler.go_on.set()


@pytest.fixture(scope="module")
def expected(folder, browser):
    page = Page(browser, folder / "one.html")
    picture = page.picture()
    page.context.close()
    assert (picture != 255).any(axis=2).mean() > 0.2
    return picture


def test_data_beside_a_page_are_a_file_that_python_reads(folder, scene):
    found = pvfiblets.FibletSet.open(folder / "figure_data" / "0.fiblets")
    assert (found.n_streamlines, found.n_points) == (SHORT, 3 * SHORT)
    assert len(scene.blobs) == 1


@pytest.mark.parametrize("kind", [Whole, Ranged])
def test_page_with_its_data_beside_it_is_the_page_of_one_file(kind, serve, visit, expected):
    address, handler = serve(kind)
    page = visit(f"{address}/figure.html")
    np.testing.assert_array_equal(page.picture(), expected)
    assert page.page.locator("progress").count() == 0
    asked = [one for one in handler.asked if one]
    assert len(asked) > 10 if kind is Ranged else len(asked) < 10


@pytest.mark.parametrize("kind", [Slow, Ranged])
def test_streamlines_are_shown_as_they_come(kind, serve, visit, expected):
    address, handler = serve(kind, wait=True)
    page = visit(f"{address}/figure.html")
    until(page.page, "pvfiblets.lines[0].set.blocks.length > 0")
    # 64 blocks have come, of which the last waits for the fiblet after it.
    assert page.page.evaluate("[pvfiblets.lines[0].set.blocks.length, pvfiblets.loading]") == [63, True]
    assert page.page.locator("progress").get_attribute("aria-label") == "Streamlines that have come"
    page.page.focus("#view")
    page.page.keyboard.press("ArrowUp")  # a picture that moves meanwhile
    page.page.keyboard.press("ArrowDown")
    handler.go_on.set()
    picture = page.picture()
    assert page.page.evaluate("[pvfiblets.lines[0].set.blocks.length, pvfiblets.loading]") == [-(-SHORT // 1024), False]
    assert (np.abs(picture - expected).max(axis=2) > 8).mean() < 0.02  # the camera is where it was, but for rounding


def test_regions_choose_among_streamlines_that_come_later(serve, visit):
    address, handler = serve(Slow, wait=True)
    page = visit(f"{address}/figure.html").page
    until(page, "pvfiblets.lines[0].set.blocks.length === 63")
    page.click("#panel summary")
    page.get_by_role("button", name="Add a ball").click()
    page.get_by_label("Radius, mm").fill("20")
    page.get_by_label("Radius, mm").evaluate("(slider) => slider.dispatchEvent(new Event('input'))")
    until(page, "parseInt(document.getElementById('status').textContent) > 2000")
    first = int(page.locator("#status").inner_text().split()[0])
    handler.go_on.set()
    until(page, "!pvfiblets.loading")
    starts = np.random.default_rng(7).uniform(-40.0, 40.0, (SHORT, 3))
    low, high = starts.min(axis=0), starts.max(axis=0) + (0.8, 0.1, 0.0)
    radius = float(page.get_by_label("Radius, mm").input_value())
    away = np.abs(starts + (0.4, 0.05, 0.0) - (low + high) / 2.0)
    inside = np.linalg.norm(np.maximum(away - (0.4, 0.0, 0.0), 0.0), axis=1) <= radius  # as rods of 0.8 mm
    last = int(page.locator("#status").inner_text().split()[0])
    assert last == pytest.approx(inside.sum(), rel=0.01)
    assert first < 0.96 * last


@pytest.mark.more
def test_what_is_wrong_with_data_beside_a_page_is_said(serve, visit, folder, tmp_path):
    address, _ = serve(Ranged)
    data = folder / "figure_data" / "0.fiblets"
    whole = data.read_bytes()
    try:
        data.write_bytes(whole[:-100])
        page = visit(f"{address}/figure.html")
        page.page.wait_for_selector("body[data-state=failed]")
        assert "Copy the page and its folder again" in page.message
        data.unlink()
        page = visit(f"{address}/figure.html")
        page.page.wait_for_selector("body[data-state=failed]")
        assert "cannot be read (404); it must lie beside this page" in page.message
        page.errors.clear()  # the browser itself tells of that
    finally:
        data.write_bytes(whole)
    page = visit(folder / "figure.html")
    page.page.wait_for_selector("body[data-state=failed]")
    assert 'Files beside a page need one; "python -m http.server" is enough' in page.message
    page.errors.clear()


def test_a_page_settles_with_a_picture_at_rest(folder, visit, expected):
    page = visit(folder / "one.html").settled()
    # A picture while something moves is short of lines; the one at rest follows 200 ms later.
    still = page.page.evaluate(
        """async () => {
            let rests = 0;
            pvfiblets.finished = () => { ++rests; };
            pvfiblets.rate = 1;
            for (const before = pvfiblets.frames; pvfiblets.frames === before;) {
                pvfiblets.change(true);
                await new Promise(requestAnimationFrame);
            }
            const moving = rests;
            await pvfiblets.settled();
            return [moving, rests];
        }"""
    )
    assert still == [0, 1]
    np.testing.assert_array_equal(page.picture(), expected)
