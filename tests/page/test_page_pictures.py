"""What a page draws beside the engine's picture of the same scene."""

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPlane

import pvfiblets
from pvfiblets.codec.layout import SPLINE, coded_kind
from pvfiblets.page import writing
from pvfiblets.page.scene import PageScene, fiblet_layer
from pvfiblets.page.writing import write_page
from pvfiblets.plotting.page.page_scene import add_all, page_of
from pvfiblets.regions import Box, Plane, Slab, Sphere
from pvfiblets.synthetic import brain_streamlines
from tests.page.pages import differing


@pytest.fixture(scope="module")
def fiblets():
    """Return a set whose fiblets are of all kinds: even and uneven steps, and a single point."""
    lines = list(brain_streamlines(150, seed=3))
    rng = np.random.default_rng(5)
    lines += [np.cumsum(rng.normal(size=(n, 3)) * 3.0, axis=0) for n in (1, 2, 3, 58, 59, 60, 61, 62, 100)]
    values = np.concatenate([np.linspace(0.0, 1.0, len(line)) for line in lines])
    values[:40] = np.nan
    streamlines = pvfiblets.Streamlines.from_list(
        lines, per_point={"share": values}, per_streamline={"number": np.arange(float(len(lines)))},
        groups={"first": np.arange(80), "last": np.arange(80, len(lines))},
    )  # fmt: skip
    return pvfiblets.compress(streamlines, per_point=["share"])


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.set_background("white")
    yield plotter
    plotter.close()


CASES = {
    "direction": {},
    "wide": {"line_width": 5.0},
    "thinner than a pixel": {"line_width": 0.4},
    "one colour, without light": {"color": "red", "lighting": False, "line_width": 2.0},
    "groups": {"scalars": "group", "show_scalar_bar": False},
    "values of streamlines": {"scalars": "number", "cmap": "viridis", "n_colors": 7, "show_scalar_bar": False},
    "values of points": {"scalars": "share", "cmap": "plasma", "clim": (0.2, 0.7), "show_scalar_bar": False},
    "computed values": {"scalars": "curvature", "log_scale": True, "show_scalar_bar": False},
    "ends": {"style": "ends", "point_size": 7.0},
    "illuminated": {"illuminated": True, "line_width": 3.0},
}


@pytest.mark.few(1)
@pytest.mark.parametrize("case", CASES)
def test_page_shows_what_the_engine_shows(case, plotter, fiblets, visit, tmp_path):
    settings = dict(CASES[case])
    illuminated = settings.pop("illuminated", False)
    actor = plotter.add_fiblets(fiblets, **settings)
    actor.illuminated = illuminated
    plotter.picture.antialias = "coverage"
    plotter.camera_position = "xz"
    plotter.camera.azimuth, plotter.camera.elevation = 25.0, 20.0
    plotter.camera.zoom(1.4)
    expected = plotter.screenshot(return_img=True)
    plotter.fiblets.export_page(tmp_path / "figure.html")
    wrong, drawn = differing(visit(tmp_path / "figure.html").picture(), expected)
    assert drawn > 0.2
    assert wrong < 0.01


def test_splines_are_drawn_as_the_engine_draws_them(plotter, visit, tmp_path):
    streamlines = brain_streamlines(150, step=0.2, seed=3)
    small = pvfiblets.compress(streamlines, exact=False, effort="small")
    assert (coded_kind(small.decoding) == SPLINE).mean() > 0.9
    plotter.add_fiblets(small, line_width=2.0)
    plotter.picture.antialias = "coverage"
    plotter.camera_position = "xz"
    expected = plotter.screenshot(return_img=True)
    shown = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0]).picture()
    wrong, drawn = differing(shown, expected)
    assert drawn > 0.1
    assert wrong < 0.01


def test_packed_data_draw_the_same_page_in_fewer_bytes(plotter, fiblets, visit, tmp_path, monkeypatch):
    plotter.add_fiblets(fiblets, scalars="share", show_scalar_bar=False)
    plotter.camera_position = "xz"
    plotter.fiblets.export_page(tmp_path / "plain.html")
    monkeypatch.setattr(writing, "SMALL_FROM", 0)
    plotter.fiblets.export_page(tmp_path / "small.html")
    sizes = [(tmp_path / f"{name}.html").stat().st_size for name in ("plain", "small")]
    assert sizes[0] - sizes[1] > fiblets.nbytes / 5
    plain, small = (visit(tmp_path / f"{name}.html").picture() for name in ("plain", "small"))
    np.testing.assert_array_equal(plain, small)


def test_lines_of_a_page_keep_their_colours_in_dim_and_coloured_light(plotter, fiblets, visit, tmp_path):
    plotter.remove_all_lights()
    plotter.add_light(pv.Light(position=(40.0, -300.0, 90.0), light_type="scene light", color="red", intensity=0.3))
    plotter.add_light(pv.Light(light_type="headlight", intensity=0.2))
    plotter.add_fiblets(fiblets, color="white", line_width=3.0)
    plotter.set_background("black")
    plotter.picture.antialias = "coverage"
    plotter.camera_position = "xz"
    plotter.camera.zoom(1.4)
    expected = plotter.screenshot(return_img=True)
    shown = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0]).picture()
    wrong, drawn = differing(shown, expected)
    assert drawn > 0.1
    assert wrong < 0.01
    assert shown.max() == 255
    assert np.ptp(shown, axis=2).max() <= 2


def test_values_that_are_sent_alone_colour_as_those_in_the_file_do(plotter, fiblets, visit, tmp_path):
    """Both those that are stored, in 8 bits, and those that are computed, in 16."""
    plotter.add_fiblets(fiblets, scalars="share", cmap="plasma", line_width=3.0)
    plotter.add_fiblets(fiblets, scalars="curvature", user_matrix=np.diag([1.0, 1.0, 1.5, 1.0]))
    apart = PageScene("Apart", values_apart=True)
    add_all(apart, plotter)
    apart.camera = page_of(plotter).camera
    assert [layer["colours"]["codes"]["bits"] for layer in apart.layers] == [8, 16]
    page = visit(write_page(apart, tmp_path / "apart.html")[0])
    expected = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0]).picture()
    assert (expected != 255).any(axis=2).mean() > 0.1
    np.testing.assert_array_equal(page.picture(), expected)


def test_slices_of_images_and_scales_are_shown_before_anything_was_drawn(plotter, fiblets, visit, tmp_path):
    values = np.zeros((40, 40, 40), np.float32)
    values[:20] = 1.0
    values[:, :20] += 2.0
    affine = np.array([[2, 0, 0, -40], [0, 2, 0, -40], [0, 0, 2, -40], [0, 0, 0, 1]], float)
    plotter.add_slices((values, affine), planes="axial", clim=(0.0, 3.0), cmap="viridis")
    plotter.add_fiblets(fiblets, scalars="number", cmap="plasma", clim=(0.0, 150.0))
    plotter.view_xy()
    page = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0])
    assert [layer["kind"] for layer in page.page.evaluate("pvfiblets.scene.layers")] == ["image", "fiblets"]
    page.page.evaluate("pvfiblets.scene.layers[1].visible = false, pvfiblets.change()")
    picture = page.picture()
    for x, y, colour in (  # matplotlib's viridis at 0, 1/3, 2/3 and 1; the view is from above
        (112, 56, (68, 1, 84)), (88, 56, (49, 104, 142)), (112, 80, (53, 183, 121)), (88, 80, (253, 231, 37)),
    ):  # fmt: skip
        assert np.abs(picture[y, x] - colour).max() <= 3
    bar = page.page.locator(".bar")
    assert bar.locator("figcaption").inner_text() == "number"
    assert bar.locator(".ticks span").all_inner_texts() == ["0", "75", "150"]
    ends = bar.locator("canvas").evaluate(
        "(strip) => [0, strip.width - 1].map((x) => [...strip.getContext('2d').getImageData(x, 0, 1, 1).data])"
    )
    np.testing.assert_allclose(ends, [[13, 8, 135, 255], [240, 249, 33, 255]], atol=2)  # of matplotlib's plasma


@pytest.mark.parametrize("opacity", [1.0, 0.6])
def test_slices_hide_lines_as_the_engines_do(opacity, plotter, fiblets, visit, tmp_path):
    """Enlarged, so that colours between pixels count, and moved."""
    x, y, z = np.meshgrid(*3 * [np.linspace(-1.0, 1.0, 12)], indexing="ij")
    affine = np.array([[12, 0, 0, -66], [0, 12, 0, -66], [0, 0, 12, -66], [0, 0, 0, 1]], float)
    image = np.float32(x * y + z), affine
    slices = plotter.add_slices(image, planes=["axial", "sagittal"], cmap="viridis", opacity=opacity)
    slices.user_matrix = pv.Transform().rotate_z(20.0).translate((0.0, 0.0, 9.0)).matrix
    plotter.add_fiblets(fiblets, line_width=2.0)
    plotter.picture.antialias = "coverage"
    plotter.disable_anti_aliasing()  # of the slices' edges
    plotter.camera_position = "xz"
    plotter.camera.azimuth, plotter.camera.elevation = 25.0, 35.0
    expected = plotter.screenshot(return_img=True)
    page = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0])
    wrong, drawn = differing(page.picture(), expected)
    assert drawn > 0.1
    assert wrong < 0.01


def test_page_cuts_moves_selects_and_leaves_out_as_the_actor_does(plotter, fiblets, visit, tmp_path):
    actor = plotter.add_fiblets(fiblets, line_width=3.0)
    actor.select(range(60))
    actor.selection_style(color="gold", dim=0.6)
    actor.criterion("number", (20, 140))
    plane = vtkPlane()
    plane.SetNormal(1.0, 0.3, 0.0)
    plane.SetOrigin(-5.0, 0.0, 0.0)
    actor.mapper.AddClippingPlane(plane)
    actor.user_matrix = np.array([[0, -2, 0, 9], [1, 0, 0, 0], [0, 0, 1, 5], [0, 0, 0, 1]], float)
    plotter.enable_parallel_projection()
    plotter.picture.antialias = "off"
    plotter.view_xy()
    expected = plotter.screenshot(return_img=True)
    plotter.fiblets.export_page(tmp_path / "figure.html")
    wrong, drawn = differing(visit(tmp_path / "figure.html").picture(), expected)
    assert drawn > 0.1
    assert wrong < 0.01


BALL, BOX = Sphere((-10.0, 0.0, 5.0), 45.0), Box(center=(-15.0, 5.0, 0.0), size=(40.0, 60.0, 50.0))
TURNED = pv.Transform().rotate_z(30.0).rotate_x(20.0).matrix
BESIDE = Slab((0, 0, 1), (0, 0, -40), 20.0) & ~Plane((1, 0, 0))
CUTS = {
    "a ball": (BALL, 1.0),
    "outside of a turned ellipsoid": (~BALL.moved(TURNED @ np.diag([1.2, 0.8, 0.5, 1.0])), 3.0),
    "any or none of several": ((BALL - BOX.moved(TURNED)) | BESIDE, 2.0),
}


@pytest.mark.few(1)
@pytest.mark.parametrize("case", CUTS)
@pytest.mark.parametrize("near", [False, True])
def test_regions_cut_lines_where_the_engine_cuts_them(near, case, plotter, fiblets, visit, tmp_path):
    """From far, and with an eye in the midst of the shapes, where they begin behind it."""
    region, width = CUTS[case]
    actor = plotter.add_fiblets(fiblets, line_width=width, user_matrix=np.diag([1.0, -1.0, 1.2, 1.0]))
    actor.clip(region)
    plotter.picture.antialias = "coverage"
    plotter.camera_position = "xz"
    plotter.camera.azimuth, plotter.camera.elevation = 25.0, 20.0
    if near:
        plotter.camera.position, plotter.camera.view_angle = (-15.0, -20.0, 0.0), 70.0
        plotter.camera.focal_point = (5.0, 20.0, 10.0)
        plotter.reset_camera_clipping_range()
    expected = plotter.screenshot(return_img=True)
    page = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0])
    wrong, drawn = differing(page.picture(), expected)
    assert drawn > 0.03
    assert wrong < 0.01


def test_a_page_without_regions_has_nothing_of_them(plotter, fiblets, visit, tmp_path):
    actor = plotter.add_fiblets(fiblets)
    actor.clip(BOX)  # planes are no region
    page = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0]).settled()
    programs = page.page.evaluate("[...pvfiblets.programs.keys()]")
    assert page.page.evaluate("pvfiblets.raysBlock") is None
    assert any("CLIP_PLANES" in key for key in programs)
    assert not any("REGION" in key for key in programs)


@pytest.mark.few(1)
@pytest.mark.parametrize("width", [1.0, 4.0])
def test_page_draws_the_points_that_are_chosen(width, plotter, fiblets, visit, tmp_path):
    actor = plotter.add_fiblets(fiblets, line_width=width)
    actor.criterion("share", (0.25, 0.6))
    plotter.picture.antialias = "coverage"
    plotter.camera_position = "xz"
    plotter.camera.zoom(1.4)
    expected = plotter.screenshot(return_img=True)
    plotter.fiblets.export_page(tmp_path / "figure.html")
    wrong, drawn = differing(visit(tmp_path / "figure.html").picture(), expected)
    assert drawn > 0.1
    assert wrong < 0.02  # lines of about equal depth may be in another order


def test_empty_tiles_are_left_out_and_no_edge_of_a_line_with_them(visit, tmp_path):
    """A line on the border of tiles has half of its pixels in the next one: all are as if no tile were left out."""
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.set_background("white")
    plotter.enable_parallel_projection()
    x = np.linspace(-90.0, 90.0, 361)
    lines = [np.stack([x, np.full_like(x, y), np.zeros_like(x)], axis=1) for y in (0.2, 16.4, 31.6, 48.1)]
    plotter.add_fiblets(pvfiblets.compress(pvfiblets.Streamlines.from_list(lines)), color="black", lighting=False)
    plotter.picture.antialias = "coverage"
    plotter.camera_position = [(0.0, 0.0, 200.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    plotter.camera.parallel_scale = 80.0  # a pixel for each mm
    expected = plotter.screenshot(return_img=True)
    plotter.fiblets.export_page(tmp_path / "figure.html")
    plotter.close()
    page = visit(tmp_path / "figure.html")
    wrong, drawn = differing(page.picture(), expected)
    assert 0.02 < drawn < 0.1
    assert wrong < 0.01
    tiles = page.page.evaluate(
        """() => {
            const gl = pvfiblets.gl, found = new Uint32Array(4 * 13 * 10);
            gl.bindFramebuffer(gl.FRAMEBUFFER, pvfiblets.buffers.tiles);
            gl.readPixels(0, 0, 13, 10, gl.RGBA_INTEGER, gl.UNSIGNED_INT, found);
            return [...found].filter((_, i) => i % 4 === 0);
        }"""
    )
    assert 0.3 < np.mean(tiles) < 0.9


def test_surfaces_hide_lines_and_are_hidden(plotter, fiblets, visit, tmp_path):
    plotter.add_fiblets(fiblets)
    plotter.add_mesh(pv.Sphere(radius=40.0), color="tan", smooth_shading=True, specular=0.5, specular_power=12.0)
    cube = pv.Cube(center=(0.0, 60.0, 0.0), x_length=40.0, y_length=20.0, z_length=50.0).triangulate()
    cube["height"] = cube.points[:, 2]
    plotter.add_mesh(cube, scalars="height", cmap="coolwarm", show_scalar_bar=False)
    plotter.picture.antialias = "off"
    plotter.disable_anti_aliasing()
    plotter.view_yz()
    plotter.camera.zoom(1.5)
    expected = plotter.screenshot(return_img=True)
    plotter.fiblets.export_page(tmp_path / "figure.html")
    wrong, drawn = differing(visit(tmp_path / "figure.html").picture(), expected)
    assert drawn > 0.2
    assert wrong < 0.02  # of which most are edges of surfaces


@pytest.mark.more
@pytest.mark.parametrize("width", [1.0, 3.0])
def test_lines_that_others_hide_are_left_out_and_no_pixel_with_them(width, visit, tmp_path):
    """From far, from near, and from within, where lines pass the eye on both sides."""
    scene = PageScene("Dense")
    fiblets = pvfiblets.compress(brain_streamlines(600, seed=3))
    fiblet_layer(scene, fiblets, line_width=width, matrix=np.diag([1.5, -1.0, 1.0, 1.0]))
    page = visit(write_page(scene, tmp_path / "figure.html")[0])
    drawn = "[pvfiblets.change(), pvfiblets.settled()][1]"
    hides = """pvfiblets.lines[0].set.blocks.reduce((sum, block) => sum + block.likelies / block.items, 0)
               / pvfiblets.lines[0].set.blocks.length"""
    for nearer in (1.0, 2.0, 10.0):
        page.page.evaluate(f"pvfiblets.camera.dolly({nearer}), pvfiblets.camera.rotate(0.1, 0)")
        for _ in range(2):  # at first by what was seen from elsewhere
            page.page.evaluate(f"pvfiblets.few = 0, {drawn}")
        found, hidden = page.picture(), page.page.evaluate(hides)
        page.page.evaluate(f"pvfiblets.few = 1e9, {drawn}")
        wrong, covered = differing(found, page.picture())
        assert covered > 0.05
        assert wrong < 1e-3  # of two lines at the same depth either may be drawn
        assert 0.0 < hidden < 0.98


def test_a_connectome_is_drawn_as_the_engine_draws_it(plotter, visit, tmp_path):
    places = np.array([(0.0, 0.0, 0.0), (40.0, 0.0, 10.0), (40.0, 40.0, -10.0), (0.0, 40.0, 0.0)])
    weights = np.array([[0, 1, 3, 2], [1, 0, 2, 0], [3, 2, 0, 1.5], [2, 0, 1.5, 0]])
    plotter.add_connectome(weights, places, radius=3.0, node_radius=6.0, show_scalar_bar=False)
    plotter.camera_position = "xy"
    plotter.camera.zoom(1.4)
    expected = plotter.screenshot(return_img=True)
    shown = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0]).picture()
    wrong, drawn = differing(shown, expected)
    assert drawn > 0.2
    assert wrong < 0.1  # tubes and balls have flat sides
