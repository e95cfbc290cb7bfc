"""PyVista's files of scenes hold what the picture shows: decoded lines, tubes, their colours; nothing goes unsaid."""

from __future__ import annotations

import base64
import io
import json
import re
import zipfile

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets import regions
from pvfiblets.mappers import readable

_TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
_WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


def gltf(plotter, folder):
    """Return points, colours (or None), indices, node matrix and base colour of each mesh of a plotter's glTF file."""
    path = folder / "scene.gltf"
    plotter.export_gltf(str(path))
    held = json.loads(path.read_text())
    blobs = [base64.b64decode(b["uri"].split(",", 1)[1]) for b in held["buffers"] or ()]

    def array(number):
        accessor = held["accessors"][number]
        view = held["bufferViews"][accessor["bufferView"]]
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        width = _WIDTHS[accessor["type"]]
        dtype = _TYPES[accessor["componentType"]]
        found = np.frombuffer(blobs[view["buffer"]], dtype, accessor["count"] * width, begin)
        return found.reshape(-1, width) if width > 1 else found

    found = []
    for node in held["nodes"] or ():
        if "mesh" not in node:
            continue
        (part,) = held["meshes"][node["mesh"]]["primitives"]
        colour = held["materials"][part["material"]]["pbrMetallicRoughness"]["baseColorFactor"]
        at = part["attributes"]
        colours = array(at["COLOR_0"]) if "COLOR_0" in at else None
        found.append((array(at["POSITION"]), colours, array(part["indices"]), node["matrix"], colour))
    return found


@pytest.fixture
def fiblets(three_lines):
    return pvfiblets.compress(three_lines, per_point=["height"])


@pytest.mark.parametrize("scalars", ["height", "weight", None])
def test_gltf_holds_what_it_holds_of_the_same_lines_by_add_mesh(plotter, fiblets, scalars, tmp_path):
    looks = {"scalars": scalars, "cmap": "jet", "show_scalar_bar": False} if scalars else {"color": "orange"}
    mesh = fiblets.decompress().to_polydata()
    other = pv.Plotter(off_screen=True)
    other.add_mesh(mesh, **looks, interpolate_before_map=False)
    (wanted,) = gltf(other, tmp_path)
    other.close()
    plotter.add_fiblets(fiblets, **looks)
    (got,) = gltf(plotter, tmp_path)
    np.testing.assert_array_equal(got[0], wanted[0])
    np.testing.assert_array_equal(got[2], wanted[2])
    np.testing.assert_allclose(got[3], wanted[3], atol=1e-12)
    if scalars is None:
        assert got[1] is None
        np.testing.assert_allclose(got[4], wanted[4], atol=1e-6)
    elif scalars == "height":
        np.testing.assert_array_equal(got[1], wanted[1])
    else:  # cell data, which VTK's exporter leaves out of add_mesh's
        each = got[1].reshape(3, -1, 4)
        assert (each == each[:, :1]).all()
        assert len(np.unique(each[:, 0], axis=0)) == 3


def test_what_is_hidden_or_cut_away_stays_out(plotter, fiblets, tmp_path):
    actor = plotter.add_fiblets(fiblets)
    ((_, colours, *_, base),) = gltf(plotter, tmp_path)
    axes = np.repeat(255 * np.eye(3, 4, dtype=np.uint8), 41, axis=0)
    axes[:, 3] = 255
    np.testing.assert_allclose(colours.astype(int), axes, atol=2)  # the codec turns directions by as much
    assert base == [1.0, 1.0, 1.0, 1.0]
    actor.scalars = "height"
    actor.show_only([0, 1])
    actor.clip(regions.Plane((1.0, 0.0, 0.0), (0.25, 0.0, 0.0)))
    actor.criterion("height", (0.0, 0.9))
    ((points, *_),) = gltf(plotter, tmp_path)
    decoded = fiblets.decompress([0])
    height = decoded.per_point["height"]
    kept = decoded.points[(decoded.points[:, 0] > 0.25) & (height <= 0.9)]
    np.testing.assert_allclose(points[1:], kept, atol=1e-6)
    np.testing.assert_allclose(points[0], [0.25, -10.0, 0.0], atol=0.02)  # where the plane cuts
    actor.visibility = False
    assert not gltf(plotter, tmp_path)


def test_places_opacities_and_renderers(fiblets, tmp_path):
    plotter = pv.Plotter(off_screen=True, shape=(1, 2))
    plotter.add_fiblets(fiblets, color="red", opacity=0.5)
    plotter.subplot(0, 1)
    moved = np.diag([2.0, 2.0, 2.0, 1.0])
    actor = plotter.add_fiblets(fiblets, opacity=np.array([0.0, 0.5, 1.0]), user_matrix=moved)
    actor.position = (1.0, 2.0, 3.0)
    plotter.subplot(0, 0)
    first, second = gltf(plotter, tmp_path)
    assert first[4] == [1.0, 0.0, 0.0, 0.5]
    np.testing.assert_array_equal(second[1][::41, 3], [0, 128, 255])
    mesh = pv.Plotter(off_screen=True)
    same = mesh.add_mesh(fiblets.decompress().to_polydata(), user_matrix=moved)
    same.position = (1.0, 2.0, 3.0)
    ((*_, matrix, _),) = gltf(mesh, tmp_path)
    np.testing.assert_allclose(second[3], matrix)
    for each in (plotter, mesh):
        each.close()


def test_obj_and_vrml_hold_decoded_points(plotter, fiblets, tmp_path):
    plotter.add_fiblets(fiblets, scalars="weight", cmap="jet", show_scalar_bar=False)
    before = plotter.screenshot()
    plotter.export_obj(tmp_path / "scene.obj")
    text = (tmp_path / "scene.obj").read_text()
    points = np.array([line.split()[1:] for line in text.splitlines() if line.startswith("v ")], float)
    np.testing.assert_allclose(points, fiblets.decompress().points, rtol=1e-6)
    plotter.export_vrml(tmp_path / "scene.wrl")
    text = (tmp_path / "scene.wrl").read_text()
    colours = re.search(r"DEF VTKcolors Color \{\s*color \[(.*?)\]", text, re.DOTALL)[1]
    colours = np.array([row.split() for row in colours.split(",") if row.strip()], float)
    assert colours.shape == (123, 3)
    assert len(np.unique(colours, axis=0)) == 3
    np.testing.assert_array_equal(plotter.screenshot(), before)


@pytest.mark.parametrize(("ground", "ink"), [("white", 0), ("black", 255)])
def test_halos_of_no_colour_have_the_ink_of_the_picture(plotter, three_lines, tmp_path, ground, ink):
    plotter.add_halo_lines(three_lines)
    plotter.background_color = "grey"
    gltf(plotter, tmp_path)
    plotter.background_color = ground
    ((_, colours, _, _, _),) = gltf(plotter, tmp_path)
    assert np.unique(colours[:, :3]).tolist() == [ink]


def test_tubes_are_surfaces_and_halos_lines(plotter, three_lines, tmp_path):
    lines = three_lines.to_polydata()
    plotter.add_spline_tubes(lines, radius=1.5, scalars="height", show_scalar_bar=False)
    halos = plotter.add_halo_lines(lines, color="blue", filter_by="height", threshold=(0.5, 1.0))
    plotter.add_halo_points(three_lines.points[:7])
    tubes, thin, dots = gltf(plotter, tmp_path)
    surface = tubes[0].astype(float)
    axis = np.abs(surface[:, None] - three_lines.points[None]).astype(float)
    apart = np.sqrt((axis**2).sum(-1)).min(1)
    assert np.quantile(apart, 0.99) < 1.53
    assert apart.max() < 1.6
    assert np.quantile(apart, 0.2) > 1.4  # but for the middles of the caps
    assert len(tubes[2]) % 3 == 0
    assert halos.filter_by == "height"
    np.testing.assert_allclose(thin[0], three_lines.points[three_lines.per_point["height"] >= 0.5], atol=1e-6)
    np.testing.assert_allclose(thin[4], [0, 0, 1, 1])
    np.testing.assert_allclose(dots[0], three_lines.points[:7], atol=1e-6)
    plotter.clear_actors()
    actor = plotter.add_fiblets(three_lines)
    actor.tube_radius = 0.7
    ((points, colours, *_),) = gltf(plotter, tmp_path)
    decoded = actor.fiblets.decompress().points
    apart = np.linalg.norm(points[:, None].astype(float) - decoded[None], axis=-1).min(1)
    assert apart.max() < 1.1 * 0.7
    assert np.quantile(apart, 0.2) > 0.9 * 0.7
    assert len(colours) == len(points)


@pytest.mark.parametrize("count", [1, 7])
def test_no_tube_of_few_is_left_out(plotter, count, tmp_path):
    lines = [np.column_stack([np.linspace(0, 10, 9), np.full(9, 5.0 * i), np.zeros(9)]) for i in range(count)]
    plotter.add_spline_tubes(lines, radius=1.0)
    ((points, *_),) = gltf(plotter, tmp_path)
    heights = np.unique(np.round(points[:, 1] / 5.0).astype(int))
    assert heights.tolist() == list(range(count))


def test_what_cannot_be_held_is_told(plotter, fiblets, tmp_path):
    plotter.add_fiblets(fiblets, scalars="density", show_scalar_bar=False)
    plotter.add_raycast_volume(np.arange(64.0).reshape(4, 4, 4), name="brain")
    view, volume = (pytest.warns(UserWarning, match=said) for said in ("depends on the view", "lacks.*'brain'"))
    with view, volume:
        (lines,) = gltf(plotter, tmp_path)
    assert len(lines[0]) == fiblets.n_points
    plotter.clear_actors()
    plotter.add_fiblets([np.linspace((0, i, 0), (9, i, 0), 10) for i in range(40)], color="red")
    with pytest.warns(UserWarning, match="100 of 400 points"), readable(plotter.render_window, most=100):
        ((points, *_),) = gltf(plotter, tmp_path)
    np.testing.assert_allclose(points[::10, 1], np.arange(0, 40, 4), atol=1e-3)


def test_an_export_that_fails_leaves_all_as_it_was(plotter, fiblets, tmp_path):
    actor = plotter.add_fiblets(fiblets)
    before, bounds = plotter.screenshot(), actor.bounds
    with pytest.raises(ValueError, match="must end with"):
        plotter.export_obj(tmp_path / "scene.txt")
    with pytest.raises(RuntimeError, match="inside"), readable(plotter.render_window):
        raise RuntimeError("inside")
    assert not actor.mapper.is_readable
    assert actor.bounds == bounds
    np.testing.assert_array_equal(plotter.screenshot(), before)
    plotter.close()
    with pytest.raises(RuntimeError, match="closed"):
        plotter.export_gltf("scene.gltf")


@pytest.mark.more
def test_browser_scenes_hold_lines_with_their_colours(plotter, fiblets):
    pytest.importorskip("trame_vtk")
    plotter.add_fiblets(fiblets, scalars="weight", show_scalar_bar=False)
    before = plotter.screenshot()
    scene = plotter.trame.export_vtksz(filename=None)
    with zipfile.ZipFile(io.BytesIO(scene)) as held:
        index = json.loads(held.read("index.json"))
    text = json.dumps(index)
    points = re.search(r'"points": {"hash": "([^"]+)"', text)[1]
    colours = re.search(r'"hash": "([^"]+)", "vtkClass": "vtkDataArray", "name": "colours"', text)[1]
    hashes = index["hashes"]
    found = np.frombuffer(base64.b64decode(hashes[points]["content"]), np.float32)
    np.testing.assert_array_equal(found.reshape(-1, 3), fiblets.decompress().points)
    rgba = np.frombuffer(base64.b64decode(hashes[colours]["content"]), np.uint8).reshape(3, 41, 4)
    assert (rgba == rgba[:, :1]).all()
    assert len(np.unique(rgba[:, 0], axis=0)) == 3
    assert '"colorMode": 2' in text
    np.testing.assert_array_equal(plotter.screenshot(), before)


def test_points_left_out_take_their_numbers_with_them(plotter):
    places = np.random.default_rng(0).uniform(-10.0, 10.0, (400, 3))
    actor = plotter.add_halo_points(places, point_size=0.5)
    plotter.render()
    with pytest.warns(UserWarning, match="100 of 400 points"), readable(plotter.render_window, most=100):
        data = pv.wrap(actor.mapper.GetInput())
    ids = np.asarray(data.cell_data["streamline"])
    assert len(ids) == 100
    np.testing.assert_allclose(data.points, places[ids], atol=1e-4)
