"""Files of pages: what they hold, what they forbid, and the script in them."""

import base64
import hashlib
import importlib.util
import json
import re
import shutil
import warnings
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets import regions
from pvfiblets.cli.command import main
from pvfiblets.codec.files.archive import open_archive
from pvfiblets.page.scene import PageScene, fiblet_layer
from pvfiblets.page.writing import write_page
from pvfiblets.plotting.page.page_scene import page_of
from tests.page.pages import differing

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def fiblets():
    lines = [np.cumsum(np.full((n, 3), 0.5), axis=0) for n in (1, 40, 200)]
    return pvfiblets.compress(pvfiblets.Streamlines.from_list(lines))


@pytest.fixture(scope="module")
def client():
    spec = importlib.util.spec_from_file_location("page_client", ROOT / "scripts" / "page_client.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_script_is_made_of_these_sources(client):
    text = client.BUNDLE.read_text()
    assert text.splitlines()[0] == client.first_line(), "run: make client"
    assert len(text.encode()) <= client.LARGEST
    assert "eval(" not in text
    assert "new Function" not in text
    if shutil.which("npm") and (client.CLIENT / "node_modules").is_dir():  # no other test needs node
        assert text == client.build()


def test_one_file_with_all_its_data(fiblets, tmp_path):
    scene = PageScene("A title </script> & <b>")
    fiblet_layer(scene, fiblets, name="</script><img src=x onerror=alert(1)>")
    (path,) = write_page(scene, tmp_path / "figure.html")
    text = path.read_text()
    assert text.count("</script>") == text.count("<script") == 3
    assert "<img" not in text
    assert "<title>A title &lt;/script&gt; &amp; &lt;b&gt;</title>" in text
    data = re.search(r'id="data-0">([^<]*)<', text)[1]
    (tmp_path / "inside.fiblets").write_bytes(base64.b64decode(data))
    header, arrays = open_archive(tmp_path / "inside.fiblets")
    assert header["n_points"] == 241
    np.testing.assert_array_equal(arrays["codes.npy"], fiblets.codes)
    np.testing.assert_array_equal(arrays["decoding.npy"], fiblets.decoding)


def test_policy_allows_its_own_script_and_style_alone(fiblets, tmp_path):
    scene = PageScene("Lines")
    fiblet_layer(scene, fiblets)
    text = write_page(scene, tmp_path / "figure.html")[0].read_text()
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)[1]
    allowed = dict(part.strip().split(" ", 1) for part in policy.split(";"))
    script = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)[-1]
    style = re.search(r"<style>(.*?)</style>", text, re.DOTALL)[1]
    assert allowed["default-src"] == allowed["connect-src"] == "'none'"
    for kind, body in (("script-src", script), ("style-src", style)):
        digest = base64.b64encode(hashlib.sha256(body.encode()).digest()).decode()
        assert allowed[kind] == f"'sha256-{digest}'"
    assert not re.search(r"https?://(?!www\.w3\.org)", text)


def test_much_data_lies_beside_the_page(fiblets, tmp_path):
    scene = PageScene("Lines")
    fiblet_layer(scene, fiblets)
    page, data = write_page(scene, tmp_path / "figure.html", largest_file=100)
    assert data == tmp_path / "figure_data" / "0.fiblets"
    said = json.loads(re.search(r'id="scene">(.*?)</script>', page.read_text())[1])
    assert said["data"] == [{"bytes": data.stat().st_size, "file": "figure_data/0.fiblets"}]
    index, inside = write_page(scene, tmp_path / "folder")
    assert (index, inside) == (tmp_path / "folder" / "index.html", tmp_path / "folder" / "0.fiblets")


def test_nothing_to_show_and_wrong_names_are_errors(fiblets, tmp_path):
    with pytest.raises(ValueError, match="a page needs streamlines or surfaces"):
        write_page(PageScene("Empty"), tmp_path / "figure.html")
    scene = PageScene("Lines")
    fiblet_layer(scene, fiblets)
    with pytest.raises(ValueError, match=r"figure\.png: a page is written as \.html"):
        write_page(scene, tmp_path / "figure.png")
    assert not list(tmp_path.iterdir())


def test_what_a_page_cannot_draw_is_named(fiblets, tmp_path):
    plotter = pv.Plotter(off_screen=True, window_size=(100, 80))
    actor = plotter.add_fiblets(fiblets, name="lines")
    actor.tube_radius = 0.4
    plotter.add_volume(np.ones((4, 4, 4)), name="scan")
    with pytest.warns(UserWarning, match="the page leaves out tubes of 'lines', 'scan': it cannot draw them"):
        plotter.fiblets.export_page(tmp_path / "figure.html")
    plotter.remove_actor(actor)
    with pytest.raises(ValueError, match="a page cannot draw 'scan'; add streamlines or surfaces, or export an image"):
        plotter.fiblets.export_page(tmp_path / "figure.html")
    plotter.close()


def test_tubes_have_their_colour_and_their_effects_are_named(tmp_path):
    plotter = pv.Plotter(off_screen=True, window_size=(100, 80))
    vessel = pv.Spline([(0, -10, 0), (20, -14, 5), (40, -10, 0)], 9)
    vessel["radius"] = np.linspace(1.0, 3.0, 9)
    actor = plotter.add_spline_tubes(vessel, name="vessel", color="red", opacity=0.5)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plotter.fiblets.export_page(tmp_path / "figure.html")
    (layer,) = page_of(plotter).layers
    assert not {"values", "colours"} & layer.keys()  # of one colour
    assert layer["colour"] == actor.prop.color.float_rgb
    actor.depth_cue = True
    with pytest.warns(UserWarning, match="the page leaves out depth_cue of 'vessel': it cannot draw them"):
        plotter.fiblets.export_page(tmp_path / "figure.html")
    plotter.close()


def floats(scene, blob):
    return np.frombuffer(scene.blobs[blob], "<f4").reshape(-1, 3)


def test_a_connectome_is_surfaces_of_its_nodes_and_of_the_edges_that_are_shown():
    plotter = pv.Plotter(off_screen=True, window_size=(100, 80))
    places = np.array([(0.0, 0.0, 0.0), (40.0, 0.0, 0.0), (40.0, 40.0, 0.0)])
    weights = np.array([[0.0, 1.0, 0.2], [1.0, 0.0, 2.0], [0.2, 2.0, 0.0]])
    plotter.add_connectome(weights, places, radius=2.0, node_radius=5.0, threshold=0.5, edges="tubes", name="net")
    scene = page_of(plotter)
    nodes, edges = scene.layers
    assert [layer["name"] for layer in scene.layers] == ["net nodes", "net edges"]
    found = floats(scene, nodes["places"])
    gaps = np.linalg.norm(found[:, None] - places, axis=2)
    np.testing.assert_allclose(gaps.min(axis=1), 5.0, rtol=1e-4)
    assert set(gaps.argmin(axis=1)) == {0, 1, 2}
    outward = (found - places[gaps.argmin(axis=1)]) / 5.0
    np.testing.assert_allclose((floats(scene, nodes["normals"]) * outward).sum(axis=1), 1.0, atol=0.02)
    found = floats(scene, edges["places"])
    along_y = abs(found[:, 0] - 40.0) < 2.5
    along_x = (abs(found[:, 1]) < 1.5) & (found[:, 0] < 36.0)
    assert (along_x | along_y).all()  # the third pair is below the threshold
    np.testing.assert_allclose(abs(found[along_x][:, 2]).max(), 1.0, rtol=0.04)  # radius by weight of the strongest
    np.testing.assert_allclose(abs(found[along_y][:, 2]).max(), 2.0, rtol=0.04)
    assert [(bar["title"], bar["clim"]) for bar in scene.bars] == [("weight", (0.2, 2.0))]
    plotter.close()


def test_cuts_go_along_but_for_closed_surfaces_which_are_named(fiblets, tmp_path):
    plotter = pv.Plotter(off_screen=True, window_size=(100, 80))
    actor = plotter.add_fiblets(fiblets, name="lines")
    actor.clip(regions.Plane((0.0, 0.0, 1.0), (0.0, 0.0, 2.0)))
    (layer,) = page_of(plotter).layers
    np.testing.assert_allclose(layer["planes"], [[0.0, 0.0, 1.0, -2.0]])
    assert "cut" not in layer
    actor.clip(~(regions.Sphere((1.0, 2.0, 3.0), 5.0) & regions.Plane((1.0, 0.0, 0.0), (4.0, 0.0, 0.0))), name="any")
    (layer,) = page_of(plotter).layers
    assert len(layer["planes"]) == 1
    ball, plane = layer["cut"]["leaves"]
    np.testing.assert_allclose(ball["ball"], [[0.2, 0, 0, -0.2], [0, 0.2, 0, -0.4], [0, 0, 0.2, -0.6]])
    np.testing.assert_allclose(plane["planes"], [[1.0, 0.0, 0.0, -4.0]])
    assert (ball["centre"], layer["cut"]["program"]) == ([1.0, 2.0, 3.0], [0, 1, -1, -3])
    actor.clip(regions.Box((0.0, 4.0, 0.0, 4.0, 0.0, 4.0)), name="any")
    (layer,) = page_of(plotter).layers
    assert len(layer["planes"]) == 1  # two of eight places are left for the reader's slab
    assert len(layer["cut"]["leaves"][0]["planes"]) == 6
    actor.clip(pv.Sphere(radius=5.0), name="any")
    with pytest.warns(UserWarning, match="leaves out the cut of 'lines' by a closed surface: it cannot draw them"):
        plotter.fiblets.export_page(tmp_path / "figure.html")
    plotter.close()


def test_a_camera_that_was_set_goes_along_and_else_the_page_chooses_the_first_view(fiblets):
    plotter = pv.Plotter(off_screen=True, window_size=(60, 40))
    plotter.add_fiblets(fiblets)
    assert page_of(plotter).camera is None
    assert not plotter.camera_set  # what is added later is still brought into view
    plotter.view_yz()
    seen, shown = page_of(plotter).camera, plotter.camera
    assert np.allclose(seen.position, shown.position)
    assert np.allclose(seen.focal_point, shown.focal_point)
    assert np.allclose(seen.up, shown.up)
    plotter.close()


def test_ranges_are_of_numbers_and_not_of_groups_or_flags(fiblets):
    plotter = pv.Plotter(off_screen=True, window_size=(60, 40))

    def ranges(scalars):
        plotter.add_fiblets(fiblets, scalars=scalars, name="lines", show_scalar_bar=False)
        (layer,) = page_of(plotter).layers
        return [control["name"] for control in layer["controls"]]

    n = fiblets.n_streamlines
    usual = ranges(None)
    assert usual in ([], ["length [mm]"])
    assert ranges(np.arange(n) % 2) == usual
    assert ranges(np.arange(n) % 2 == 0) == usual
    assert ranges(np.array(["left", "right"])[np.arange(n) % 2]) == usual
    assert len(ranges(np.arange(n) / 7.0)) == 1 + len(usual)
    plotter.close()


def test_bars_are_those_that_the_plotter_shows(fiblets):
    plotter = pv.Plotter(off_screen=True, window_size=(60, 40))
    lengths = {"scalars": np.arange(3.0), "show_scalar_bar": True}
    plotter.add_fiblets(fiblets, name="a", **lengths, scalar_bar_args={"title": "Length (mm)"})
    plotter.add_fiblets(fiblets, name="b", **lengths | {"show_scalar_bar": False})
    mesh = pv.Sphere()
    mesh["height"] = mesh.points[:, 2]
    plotter.add_mesh(mesh, scalars="height", scalar_bar_args={"title": "Height"})
    assert [bar["title"] for bar in page_of(plotter).bars] == ["Length (mm)", "Height"]
    plotter.remove_scalar_bar("Height")
    assert [bar["title"] for bar in page_of(plotter).bars] == ["Length (mm)"]
    plotter.close()


def test_notebook_keeps_the_page(fiblets):
    plotter = pv.Plotter(off_screen=True, window_size=(100, 80))
    plotter.add_fiblets(fiblets)
    shown = plotter.fiblets.page_view(height=300)._repr_html_()
    with pytest.raises(ValueError, match="height is 0; give a whole number of pixels"):
        plotter.fiblets.page_view(height=0)
    plotter.close()
    frame = ET.fromstring(shown)
    assert frame.attrib["sandbox"] == "allow-scripts allow-downloads"
    assert frame.attrib["srcdoc"].startswith("<!DOCTYPE html>")
    assert 'id="data-0"' in frame.attrib["srcdoc"]


def test_command_writes_a_page(fiblets, tmp_path, capsys):
    fiblets.save(tmp_path / "lines.fiblets")
    assert main(["page", str(tmp_path / "lines.fiblets"), "-o", str(tmp_path / "figure.html"), "--color", "red"]) == 0
    assert "figure.html: " in capsys.readouterr().out
    said = json.loads(re.search(r'id="scene">(.*?)</script>', (tmp_path / "figure.html").read_text())[1])
    assert said["title"] == "lines.fiblets"
    assert said["layers"][0]["colours"] == {"mode": "solid", "colour": [1.0, 0.0, 0.0]}
    assert main(["page", str(tmp_path / "lines.fiblets"), "-o", str(tmp_path / "figure.png")]) == 1
    assert "a page is written as .html" in capsys.readouterr().err


CULLING = {
    "front": {"culling": "front"},
    "back": {"culling": "back"},
    "front, of a mirrored one": {"culling": "front", "user_matrix": np.diag([-1.0, 1.0, 1.0, 1.0])},
}


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.set_background("white")
    plotter.disable_anti_aliasing()
    yield plotter
    plotter.close()


def _agrees(plotter, visit, tmp_path):
    plotter.view_vector((1.0, -0.7, 0.4))
    plotter.camera.zoom(1.5)
    expected = plotter.screenshot(return_img=True)
    page = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0])
    wrong, drawn = differing(page.picture(), expected)
    assert drawn > 0.15
    assert wrong < 0.015  # of which most are where surfaces end


def test_edges_of_triangles_and_of_polygons(plotter, visit, tmp_path):
    """By values of points, by colours of cells, smooth, translucent; with edges of any width and opacity."""
    ball = pv.Sphere(radius=1.0, theta_resolution=12, phi_resolution=9)
    ball["height"] = ball.points[:, 2]
    plotter.add_mesh(ball, scalars="height", show_edges=True, edge_color="red", line_width=3, show_scalar_bar=False)
    cube = pv.Cube(center=(0.0, -2.0, 0.0))
    cube.cell_data["side"] = np.arange(6.0)
    plotter.add_mesh(cube, scalars="side", show_edges=True, edge_opacity=0.5, line_width=5, show_scalar_bar=False)
    prism = pv.Cylinder(center=(0.0, 2.0, 0.0), direction=(0.0, 0.0, 1.0), resolution=7)
    plotter.add_mesh(prism, color="tan", smooth_shading=True, show_edges=True, specular=0.6, opacity=0.7)
    _agrees(plotter, visit, tmp_path)


@pytest.mark.few(1)
@pytest.mark.parametrize("case", CULLING)
def test_culled_faces(case, plotter, visit, tmp_path):
    shell = pv.Sphere(radius=1.0, theta_resolution=24, phi_resolution=18).clip("z", value=0.4)
    plotter.add_mesh(shell, color="teal", **CULLING[case])
    _agrees(plotter, visit, tmp_path)
