"""Lines of pages that one looks through, and surfaces before and behind them, beside the engine's picture."""

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets import regions
from pvfiblets.plotting.page.page_scene import page_of
from pvfiblets.synthetic import brain_streamlines
from tests.page.pages import differing


@pytest.fixture(scope="module")
def fiblets():
    lines = list(brain_streamlines(300, seed=3))
    values = np.concatenate([np.linspace(0.0, 1.0, len(line)) for line in lines])
    values[:40] = np.nan
    streamlines = pvfiblets.Streamlines.from_list(
        lines, per_point={"share": values}, per_streamline={"number": np.arange(float(len(lines)))}
    )
    return pvfiblets.compress(streamlines, per_point=["share"])


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.set_background("white")
    plotter.picture.antialias = "coverage"
    yield plotter
    plotter.close()


def _look(plotter):
    plotter.camera_position = "xz"
    plotter.camera.azimuth, plotter.camera.elevation = 25.0, 20.0
    plotter.camera.zoom(1.4)


def _agrees(plotter, visit, tmp_path, share=0.01):
    """Have a page shown, and compare it with the engine's picture."""
    expected = plotter.screenshot(return_img=True)
    page = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0])
    wrong, drawn = differing(page.picture(), expected)
    assert drawn > 0.15
    assert wrong < share
    return page


CASES = {
    "of all lines, thinner than a pixel, dark, without light": {
        "opacity": 0.1, "line_width": 0.4, "color": "navy", "lighting": False,
    },
    "of streamlines": {"opacity": np.random.default_rng(1).random(300)},
    "of streamlines' colours": {"scalars": "number", "cmap": "viridis", "opacity": "sigmoid"},
    "of points, wide": {"opacity": "share", "line_width": 2.0},
    "of ends": {"opacity": 0.3, "style": "ends", "point_size": 9.0, "color": "navy", "lighting": False},
    "of points' colours": {"scalars": "share", "opacity": "linear"},
}  # fmt: skip


@pytest.mark.few(1)
@pytest.mark.parametrize("case", CASES)
def test_opacity(case, plotter, fiblets, visit, tmp_path):
    more = {"show_scalar_bar": False} if "scalars" in CASES[case] else {}
    plotter.add_fiblets(fiblets, **CASES[case], **more)
    _look(plotter)
    _agrees(plotter, visit, tmp_path)


def test_only_the_nearest_line_where_nothing_else_is_to_show_through(plotter, fiblets, visit, tmp_path):
    actor = plotter.add_fiblets(fiblets, opacity=0.4)
    actor.transparency = None
    _look(plotter)
    page = _agrees(plotter, visit, tmp_path)
    assert page.page.evaluate("[...pvfiblets.translucent.held.values()].map((held) => held.sums.length)") == [0]


@pytest.mark.few(1)
@pytest.mark.parametrize("width", [1.0, 3.0])
def test_what_is_opaque_and_what_is_translucent_before_and_behind(width, plotter, fiblets, visit, tmp_path):
    """Two sets of lines, one of which is opaque and cut, a mesh that hides lines and two that show them."""
    lines = plotter.add_fiblets(fiblets, opacity=0.3, line_width=width, name="through")
    lines.select(range(100))
    plotter.add_fiblets(fiblets, color="orange", name="opaque").clip(regions.Box((-90, 90, -90, 90, 30, 90)))
    plotter.add_fiblets(fiblets, color="teal", opacity=0.1, user_matrix=np.diag([1.0, 0.6, 1.3, 1.0]))
    plotter.add_mesh(pv.Sphere(radius=25.0, theta_resolution=60, phi_resolution=60), color="tan")
    for place, colour in (((0.0, -70.0, 0.0), "red"), ((20.0, 70.0, 20.0), "lime")):
        plotter.add_mesh(pv.Sphere(radius=28.0, center=place), color=colour, opacity=0.4)
    plotter.disable_anti_aliasing()
    _look(plotter)
    _agrees(plotter, visit, tmp_path, 0.015)  # of which most are edges of surfaces


def test_graphics_with_half_precision_or_none(plotter, fiblets, visit, tmp_path):
    actor = plotter.add_fiblets(fiblets, opacity=0.2)
    _look(plotter)
    page = _agrees(plotter, visit, tmp_path)
    exact = page.picture()
    lacks = """(names) => {
        const ask = WebGL2RenderingContext.prototype.getExtension;
        WebGL2RenderingContext.prototype.getExtension = function (name) {
            return names.includes(name) ? null : ask.call(this, name);
        };
    }"""

    def without(*names):
        page.page.add_init_script(f"({lacks})({list(names)})")
        page.page.reload()
        page.page.wait_for_selector("body:not([data-state=loading])")
        return page.picture()

    assert differing(without("EXT_float_blend"), exact)[0] < 0.01
    opaque = without("EXT_color_buffer_float", "EXT_color_buffer_half_float")
    assert page.page.locator("#status").inner_text() == (
        "This browser draws translucent lines opaque: its graphics cannot add up colours of lines that one looks "
        "through."
    )
    actor.opacity = 1.0
    plotter.render()
    assert differing(opaque, plotter.screenshot(return_img=True))[0] < 0.01


def test_lines_are_picked_and_nothing_is_kept_when_they_are_opaque_again(plotter, fiblets, visit, tmp_path):
    plotter.add_fiblets(fiblets, opacity=0.2, line_width=3.0)
    _look(plotter)
    page = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0])
    dark = np.argwhere((page.picture() < 200).any(axis=2))
    y, x = dark[len(dark) // 2]
    assert 0 <= page.page.evaluate(f"pvfiblets.pick({x}, {y}).streamline") < 300
    moving = page.page.evaluate("pvfiblets.rate = 20, pvfiblets.change(true), pvfiblets.settled()")
    assert moving is None
    page.page.evaluate("pvfiblets.lines[0].layer.visible = false, pvfiblets.change(), pvfiblets.settled()")
    assert page.page.evaluate("pvfiblets.translucent") is None


def test_opaque_scenes_make_no_program_and_no_texture_for_it(plotter, fiblets, visit, tmp_path):
    plotter.add_fiblets(fiblets)
    assert "through" not in page_of(plotter).layers[0]
    page = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0]).settled()
    assert page.page.evaluate("pvfiblets.translucent") is None
    programs = page.page.evaluate("[...pvfiblets.programs.keys()]")
    assert not [name for name in programs if "sum" in name or "through" in name or "mixed" in name]


@pytest.mark.more
def test_layers_that_are_asked_for_are_named(plotter, fiblets, tmp_path):
    actor = plotter.add_fiblets(fiblets, opacity=0.2, name="lines")
    actor.transparency = "layers"
    with pytest.warns(UserWarning, match="leaves out the layers of 'lines'"):
        plotter.fiblets.export_page(tmp_path / "figure.html")
    actor.opacity = 1.0
    plotter.fiblets.export_page(tmp_path / "figure.html")
