"""Pages that draw by themselves and those of ``pvfiblets serve``, in Firefox: much of what is asked of Chromium."""

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.page.scene import PageScene, fiblet_layer
from pvfiblets.page.writing import write_page
from pvfiblets.synthetic import brain_streamlines
from tests.page import conftest as page_fixtures
from tests.page import test_page_browser as in_use
from tests.page import test_page_notebook as notebook
from tests.page.pages import differing, serving
from tests.web import test_browser as served_pages
from tests.web.firefox import launched_firefox
from tests.web.test_browser_drawing import There, agrees

pytestmark = pytest.mark.more

visit = page_fixtures.visit  # opens pages from files

figure, rich = in_use.figure, in_use.rich
test_graphics_come_back = in_use.test_page_opens_from_disk_without_asking_anybody_and_graphics_that_are_lost_come_back
test_drag_turns_and_wheel_zooms = in_use.test_drag_turns_and_wheel_zooms
test_keys_do_what_the_mouse_does = in_use.test_keys_do_what_the_mouse_does
test_keys_reach_every_control = in_use.test_keys_reach_every_control_and_all_are_named
test_damaged_data_are_one_sentence_on_the_page = in_use.test_damaged_data_are_one_sentence_on_the_page
test_a_click_tells_the_streamline = (
    in_use.test_a_click_tells_the_streamline_and_balls_and_boxes_there_choose_with_switches
)

plotter = notebook.plotter
test_frame_and_model_of_a_notebook_talk = notebook.test_frame_and_model_of_a_notebook_talk

test_a_served_page_opens_turns_and_rests = served_pages.test_a_page_opens_turns_and_rests
test_files_are_opened_uploaded_and_refused = served_pages.test_files_are_opened_uploaded_and_refused


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    """Return Firefox, or skip where there is none."""
    with launched_firefox(tmp_path_factory.mktemp("firefox")) as found:
        yield found


def test_page_of_all_kinds_shows_what_the_engine_shows(visit, tmp_path):
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.set_background("white")
    fiblets = pvfiblets.compress(brain_streamlines(150, seed=3))
    plotter.add_fiblets(fiblets, scalars="length", cmap="plasma", line_width=3.0)
    plotter.add_mesh(pv.Sphere(radius=30.0, center=(0.0, 0.0, 40.0)), color="tan", smooth_shading=True)
    values = np.zeros((40, 40, 40), np.float32)
    values[:20] = 1.0
    values[:, :20] += 2.0
    affine = np.array([[2, 0, 0, -40], [0, 2, 0, -40], [0, 0, 2, -40], [0, 0, 0, 1]], float)
    plotter.add_slices((values, affine), planes="axial", clim=(0.0, 3.0), cmap="viridis")
    plotter.picture.antialias = "off"
    plotter.disable_anti_aliasing()
    plotter.camera_position = "xz"
    plotter.camera.azimuth, plotter.camera.elevation = 25.0, 20.0
    plotter.camera.zoom(1.4)
    page = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0])
    bars = page.page.locator(".bar")
    assert bars.locator("figcaption").all_inner_texts() == ["length [mm]"]
    assert len(bars.locator(".ticks span").all_inner_texts()) >= 2
    ends = bars.locator("canvas").evaluate(
        "(strip) => [0, strip.width - 1].map((x) => [...strip.getContext('2d').getImageData(x, 0, 1, 1).data])"
    )
    np.testing.assert_allclose(ends, [[13, 8, 135, 255], [240, 249, 33, 255]], atol=2)  # of matplotlib's plasma
    plotter.remove_scalar_bar("length [mm]")  # the page's lies over its picture
    expected = plotter.screenshot(return_img=True)
    plotter.close()
    wrong, drawn = differing(page.picture(), expected)
    assert drawn > 0.2
    assert wrong < 0.02  # of which most are edges of surfaces


def test_data_beside_a_page_come_from_a_server_and_not_from_files(visit, tmp_path):
    """Of a page from a server Firefox asks for an icon, too, which the page's policy must not forbid."""
    scene = PageScene("Two lines")
    lines = [np.array([[0.0, 10.0 * i, 0.0], [30.0, 10.0 * i, 0.0]]) for i in range(2)]
    fiblet_layer(scene, pvfiblets.compress(pvfiblets.Streamlines.from_list(lines)), line_width=4.0)
    path, _ = write_page(scene, tmp_path / "figure.html", largest_file=100)
    with serving(tmp_path) as address:
        assert (visit(f"{address}/figure.html").picture() != 255).any()
    page = visit(path)
    page.page.wait_for_selector("body[data-state=failed]")
    assert 'Files beside a page need one; "python -m http.server" is enough' in page.message
    page.errors.clear()  # the browser itself tells of that


def test_tabs_and_dialogs_of_a_served_page_open(revisit):
    here = revisit("lines.fiblets")
    for name in ("clip", "filter", "selection", "info"):
        here.tab(name)
        assert here.page.locator(f"#tab-{name}").inner_text().strip()
    for key in ("o", "s", "?"):
        here.press(key)
        here.page.wait_for_selector(".v-overlay--active .v-card")
        here.press("Escape")
        here.page.wait_for_selector(".v-overlay--active", state="hidden")


def test_typed_numbers_and_names_are_taken(revisit):
    here = revisit("lines.fiblets")
    width = here.page.locator("[data-property=line_width] input.pv-num")
    before = here.rests()
    width.click()
    width.press("Control+a")
    here.page.keyboard.type("6")
    here.press("Tab")
    wide = here.changed(before)
    assert (wide.max(axis=2) > 40).sum() > 1.2 * (before.max(axis=2) > 40).sum()


def test_firefox_draws_by_itself(browser, served):
    here = There(browser, served("lines.fiblets", "--mesh", "ball.ply", "--draw", "there"))
    try:
        here.open()
        assert here.state("frame") == "drawn by this browser"
        assert agrees(here)
        before = here.drawn()
        largest, fetched = here.sends(here.drag)
        assert largest < 5000
        assert not fetched
        assert np.abs(here.drawn() - before).mean() > 1.0
        assert agrees(here)
        assert not here.errors
    finally:
        here.close()


def test_pictures_and_scripts_are_fetched(revisit):
    """The last one: Firefox's own window of downloads takes the keys from the page's."""
    here = revisit("lines.fiblets")
    with here.page.expect_download() as download:
        here.press("c")
    assert download.value.path().read_bytes().startswith(b"\x89PNG")
    here.page.click("[data-action=script]")
    text = here.page.locator("#script").inner_text()
    with here.page.expect_download() as download:
        here.page.click("#dialog-script button:has-text('Download')")
    assert download.value.path().read_text().split() == text.split()
