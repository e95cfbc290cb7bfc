"""A page in use: by mouse and keys, without a network, damaged, and with graphics that go and come back."""

from __future__ import annotations

import base64
import re

import numpy as np
import pytest

import pvfiblets
from pvfiblets.page.scene import CameraPlace, PageScene, fiblet_layer
from pvfiblets.page.writing import write_page


@pytest.fixture(scope="module")
def figure(tmp_path_factory):
    """Return a page with a line across the middle of the picture and one above it."""
    x = np.linspace(-40.0, 40.0, 161)
    lines = [np.stack([x, np.full_like(x, y), np.zeros_like(x)], axis=1) for y in (0.0, 20.0)]
    scene = PageScene("Two lines", camera=CameraPlace((0.0, 0.0, 200.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    fiblet_layer(scene, pvfiblets.compress(pvfiblets.Streamlines.from_list(lines)), line_width=4.0)
    return write_page(scene, tmp_path_factory.mktemp("page") / "figure.html")[0]


def test_page_opens_from_disk_without_asking_anybody(figure, visit):
    page = visit(figure)
    assert page.page.title() == "Two lines"
    assert page.requests == [figure.as_uri()]
    assert (page.picture() != 255).any()


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


def test_graphics_that_are_lost_come_back(figure, visit):
    page = visit(figure)
    before = page.picture()
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


def test_page_fills_small_and_large_windows(figure, visit):
    for size in ((320, 480), (3840, 2160)):
        page = visit(figure, size=size)
        assert page.picture().shape == (size[1], size[0], 3)
        assert page.page.evaluate("document.documentElement.scrollWidth") == size[0]


def test_click_tells_the_streamline_and_its_region(figure, visit):
    page = visit(figure)
    page.page.mouse.click(100, 80)
    status = page.page.locator("#status")
    status.wait_for(state="visible")
    said = status.inner_text()
    assert said.startswith("Streamline 0 of streamlines; at ")
    place = [float(part) for part in re.search(r"at (.*) mm", said)[1].split(", ")]
    np.testing.assert_allclose(place, (0.0, 0.0, 0.0), atol=0.6)
    before = page.picture()
    page.page.click("#panel summary")
    page.page.get_by_role("button", name="Those through the picked place").click()
    assert status.inner_text().startswith("1 streamlines pass within")
    after = page.picture()
    assert (before[20:60] != 255).any()
    assert (after[20:60] == 255).all()
    page.page.get_by_role("button", name="All", exact=True).click()
    assert (page.picture()[20:60] != 255).any()


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
