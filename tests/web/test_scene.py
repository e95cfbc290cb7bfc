"""Scenes: files become layers, settings pictures, and what is refused leaves everything as it was."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.errors import FibletsError
from pvfiblets.formats.registry import UnknownFormatError
from pvfiblets.web.loading import Cancelled
from pvfiblets.web.scene import Scene


def drawn(picture):
    return (picture > 0).any(axis=-1)


# Opening ------------------------------------------------------------------------------------------


def test_a_layer_looks_as_the_plotters_own_actor(scene, folder):
    layer = scene.open("lines.trk")
    scene.set(layer.id, "scalars", "fa")
    scene.set(layer.id, "line_width", 3)
    scene.set(layer.id, "show_bar", False)
    scene.view("coronal")
    picture = scene.screenshot()
    other = pv.Plotter(off_screen=True, window_size=(200, 160))
    other.set_background("black")
    other.disable_anti_aliasing()
    other.add_fiblets(
        folder / "lines.trk", scalars="fa", cmap="viridis", line_width=3, show_scalar_bar=False, per_point=["fa"]
    )
    other.camera_position = scene.plotter.camera_position
    other.camera.view_angle = scene.plotter.camera.view_angle
    other.renderer.reset_camera_clipping_range()
    expected = other.screenshot(return_img=True)
    other.close()
    assert drawn(picture).sum() > 500
    np.testing.assert_array_equal(picture, expected)


def test_kinds_are_found_by_file(scene):
    found = [scene.open(name).kind for name in ("lines.trk", "vessel.vtp", "head.nii.gz", "ball.ply")]
    assert found == ["tractogram", "tubes", "volume", "mesh"]
    assert scene.open("vessel.vtp", kind="tractogram").kind == "tractogram"
    assert len({layer.id for layer in scene.layers}) == len({layer.name for layer in scene.layers}) == 5
    for layer in scene.layers:
        json.dumps(scene.info(layer.id), allow_nan=False)
        json.dumps(scene.histogram(layer.id), allow_nan=False)
    json.dumps(scene.legend, allow_nan=False)
    scene.screenshot()


def test_progress_is_told_and_a_load_can_be_cancelled(scene):
    told = []
    scene.load("lines.trk", progress=lambda what, share: told.append((what, share)))
    assert {"surveying", "compressing", "measuring"} <= {what for what, _ in told}
    assert all(0.0 <= share <= 1.0 for _, share in told)
    for calls in range(1, len(told)):
        left = iter([False] * calls)
        with pytest.raises(Cancelled):
            scene.open("lines.trk", cancel=lambda left=left: next(left, True))
    assert scene.layers == ()
    assert not list((scene.root).glob(".fiblets-*"))


def test_the_error_of_a_compressed_file_is_measured(scene, lines):
    info = scene.info(scene.open("lines.trk").id)
    fiblets = scene.actor(scene.layers[0].id).fiblets
    expected = np.linalg.norm(fiblets.decompress(dtype=np.float64).points - lines.points, axis=1).max()
    assert info["error_mm"]["max"] == pytest.approx(expected, rel=0.05, abs=1e-6)
    assert info["error_mm"]["max"] <= info["promise_mm"]
    assert info["streamlines"] == {"total": 60, "shown": 60}


@pytest.mark.parametrize(
    "path", ["../secret.ply", "sub/../../secret.ply", "link.ply", "links/secret.ply", "/etc/passwd"]
)
def test_paths_do_not_lead_out_of_the_root(scene, folder, path):
    secret = folder.parent / "secret.ply"
    pv.Sphere().save(secret)
    (folder / "link.ply").symlink_to(secret)
    (folder / "links").symlink_to(folder.parent)
    (folder / "link.trk").symlink_to(folder.parent / "secret.trk")
    lines = scene.open("lines.fiblets").id
    for refused in (
        lambda: scene.open(path),
        lambda: scene.add_clip("mesh", path=path),
        lambda: scene.set_regions(lines, {"how": "passes", "region": {"kind": "mesh", "path": path}}),
        lambda: scene.export(lines, path.replace(".ply", ".trk").replace("passwd", "x.trk"), what="all"),
    ):
        with pytest.raises(PermissionError, match="outside of the folder"):
            refused()
    assert len(scene.layers) == 1
    assert not (folder.parent / "secret.trk").exists()
    for bad in ("", "a\x00b", None, 3, "x" * 5000):
        with pytest.raises(ValueError, match="path is"):
            scene.open(bad)


def test_named_files_outside_of_the_root_are_allowed(plotter, folder, tmp_path):
    outside = tmp_path / "outside.ply"
    pv.Sphere().save(outside)
    scene = Scene(plotter, folder, allowed=[outside])
    assert scene.open(outside).path == str(outside)
    with pytest.raises(PermissionError, match="outside of the folder"):
        scene.open(tmp_path / "other.ply")
    scene.close()


@pytest.mark.parametrize(
    ("name", "content", "error"),
    [
        ("a.xyz", b"", UnknownFormatError),
        ("a.trk", b"no tractogram", FibletsError),
        ("a.fiblets", b"PK\x03\x04", FibletsError),
        ("a.nii.gz", b"\x1f\x8b no", Exception),
        ("nowhere.trk", None, FileNotFoundError),
    ],
)
def test_bad_files_leave_nothing_behind(scene, folder, name, content, error):
    if content is not None:
        (folder / name).write_bytes(content)
    with pytest.raises(error):
        scene.open(name)
    assert scene.layers == ()
    assert list(scene.plotter.actors) == []


# Layers -------------------------------------------------------------------------------------------


def test_what_is_refused_changes_nothing(flat):
    (layer,) = flat.layers
    state, picture = flat.state, flat.screenshot()
    for refused in (
        lambda: flat.set(layer.id, "opacity", 7),
        lambda: flat.set("layer99", "opacity", 1.0),
        lambda: flat.set_filter(layer.id, "no such", 0, 1),
        lambda: flat.set_filter(layer.id, "length", 5, 1),
        lambda: flat.set_groups(layer.id, ["nobody"]),
        lambda: flat.set_subset(layer.id, -1),
        lambda: flat.set_regions(layer.id, {"how": "passes", "region": {"kind": "mesh", "path": "open.ply"}}),
        lambda: flat.add_clip("mesh", path="open.ply"),
        lambda: flat.add_clip("plane", normal=[0, 0, 0]),
        lambda: flat.rename(layer.id, "\n"),
        lambda: flat.set_background("no colour"),
    ):
        with pytest.raises((ValueError, KeyError)):
            refused()
        assert flat.state is state
    np.testing.assert_array_equal(flat.screenshot(), picture)


def test_a_filter_that_fails_halfway_is_taken_back(flat, monkeypatch):
    (layer,) = flat.layers
    flat.set_filter(layer.id, "length", 20, 30)
    actor, picture = flat.actor(layer.id), flat.screenshot()

    def fail(*_, **__):
        raise MemoryError("no more")

    monkeypatch.setattr(actor, "subset", fail)
    with pytest.raises(MemoryError):
        flat.set_subset(layer.id, 0.5)
    monkeypatch.undo()
    assert dict(actor.criteria) == {"length": (20.0, 30.0)}
    np.testing.assert_array_equal(flat.screenshot(), picture)


def test_layers_are_shown_hidden_duplicated_renamed_and_removed(flat):
    (layer,) = flat.layers
    before = flat.screenshot()
    flat.show(layer.id, False)
    assert not drawn(flat.screenshot()).any()
    twin = flat.duplicate(layer.id)
    flat.show(twin.id, True)
    np.testing.assert_array_equal(flat.screenshot(), before)
    flat.rename(twin.id, "twin")
    assert [other.name for other in flat.layers] == ["lines.trk", "twin"]
    assert flat.data(twin).data is flat.data(flat.layers[0]).data
    flat.remove(twin.id)
    flat.remove(layer.id)
    assert flat.layers == ()
    assert list(flat.plotter.fiblets) == []
    assert not drawn(flat.screenshot()).any()


def test_meshes_are_coloured_and_show_edges(scene):
    ball = scene.open("ball.ply")
    scene.set(ball.id, "color", "#ff0000")
    scene.set(ball.id, "lighting", False)
    picture = scene.screenshot()
    colours = {tuple(c) for c in picture[drawn(picture)].tolist()}
    assert colours == {(255, 0, 0)}
    assert scene.actor(ball.id).prop.color.hex_rgb == "#ff0000"
    scene.set(ball.id, "representation", "wireframe")
    assert 0 < drawn(scene.screenshot()).sum() < drawn(picture).sum()


def test_tubes_are_as_thick_as_they_are_told(scene):
    tubes = scene.open("vessel.vtp")
    actor, given = scene.actor(tubes.id), scene.data(tubes).data
    thin = drawn(scene.screenshot()).sum()
    scene.set(tubes.id, "radius_scale", 2.0)
    np.testing.assert_allclose(actor.tubes.radius, 2.0 * given.radius)
    assert drawn(scene.screenshot()).sum() > 1.5 * thin
    scene.set(tubes.id, "radius_scale", 1.0)
    assert drawn(scene.screenshot()).sum() == thin


def test_images_of_vtk_are_volumes(scene):
    image = pv.ImageData(dimensions=(6, 6, 6))
    image["values"] = np.linspace(0.0, 1.0, 216)
    image.save(scene.root / "image.vtk")
    layer = scene.open("image.vtk")
    assert layer.kind == "volume"
    assert scene.data(layer).data.shape == (6, 6, 6)
    assert drawn(scene.screenshot()).any()


def test_volumes_show_what_their_mode_says(scene):
    head = scene.open("head.nii.gz")
    surface = drawn(scene.screenshot())
    scene.set(head.id, "mode", "composite")
    light = drawn(scene.screenshot())
    assert 0 < surface.sum() < light.sum()  # at the middle value, and from the least on
    scene.set(head.id, "values", [0.7])
    scene.set(head.id, "mode", "isosurface")
    assert 0 < drawn(scene.screenshot()).sum() < surface.sum()


# Questions ----------------------------------------------------------------------------------------


def test_histograms_count_as_numpy_does(scene, lines):
    layer = scene.open("lines.fiblets")
    found = scene.histogram(layer.id, "length", bins=6)
    counts, edges = np.histogram(lines.lengths(), bins=6)
    np.testing.assert_allclose(found["edges"], edges, atol=0.1)
    assert found["counts"] == counts.tolist()
    assert (found["missing"], found["share"]) == (0, 1.0)
    head = scene.open("head.nii.gz")
    values = scene.data(head).data.values
    assert scene.histogram(head.id, bins=4)["counts"] == np.histogram(values, bins=4)[0].tolist()
    with pytest.raises(ValueError, match="no such"):
        scene.histogram(layer.id, "no such")


def test_bars_are_of_visible_layers_and_say_their_values(scene):
    one, two = scene.open("lines.fiblets"), scene.open("lines.trk")
    assert list(scene.plotter.scalar_bars.keys()) == []  # directions have no values
    scene.set(one.id, "scalars", "length")
    scene.set(two.id, "scalars", "length")
    scene.set(two.id, "clim", [0, 5])
    assert list(scene.plotter.scalar_bars.keys()) == ["length [mm]", "length [mm], lines.trk"]
    assert scene.actor(one.id).clim == pytest.approx((10.0, 69.0), abs=0.1)  # bars do not make layers share a range
    ranges = [bar.GetLookupTable().GetTableRange() for bar in scene.plotter.scalar_bars.values()]
    assert ranges[0] == pytest.approx((10.0, 69.0), abs=0.1)
    assert ranges[1] == (0.0, 5.0)
    scene.show(one.id, False)
    assert list(scene.plotter.scalar_bars.keys()) == ["length [mm]"]
    assert [entry["name"] for entry in scene.legend] == ["lines.trk"]
    scene.set(two.id, "show_bar", False)
    assert list(scene.plotter.scalar_bars.keys()) == []
    scene.show(one.id, True)
    scene.remove(one.id)
    assert list(scene.plotter.scalar_bars.keys()) == []


@pytest.mark.few(1)
@pytest.mark.parametrize("size", [(320, 240), (640, 690), (1600, 400)])
def test_bars_leave_the_places_of_letters_free(scene, size):
    """Letters stand at the middles of the edges, 16 pixels high, the left one behind the tools."""
    width, height = scene.plotter.window_size = size
    for values in ("length", "fa", "group", "weight"):
        layer = scene.open("lines.fiblets")
        scene.set(layer.id, "scalars", values)
        scene.set(layer.id, "opacity", 0.0)
    scene.screenshot()
    bars = drawn(scene.screenshot())
    assert bars.sum() > 500
    middle = slice(height // 2 - 12, height // 2 + 12)
    assert not bars[middle].any()
    assert not bars[:28, width // 2 - 20 : width // 2 + 20].any()
    assert not bars[:, :46].any()
    if width > 320:  # there, all four have room in one half only if they overlap
        assert bars[:, width // 2 :].sum() > 0.5 * bars.sum()


@pytest.mark.parametrize(
    ("view", "edges"),
    [("axial", "LRAP"), ("coronal", "RLSI"), ("sagittal", "APSI"), ("right", "PASI"), ("posterior", "LRSI")],
)
def test_views_know_their_sides(scene, view, edges):
    scene.open("ball.ply")
    scene.view(view)
    found = scene.edges()
    assert "".join(found[side] for side in ("left", "right", "top", "bottom")) == edges
    scene.parallel = True
    assert scene.camera()["parallel"] is True
    picture = scene.screenshot(scale=2)
    assert picture.shape == (320, 400, 3)
    with pytest.raises(ValueError, match="scale"):
        scene.screenshot(scale=100)


def test_only_pictures_render_and_views_show_what_is_visible(scene):
    """Every render of a large tractogram costs; whoever streams pictures decides when."""
    layer = scene.open("lines.fiblets")
    scene.screenshot()
    renders = []
    scene.plotter.render_window.AddObserver("StartEvent", lambda *_: renders.append(1))
    scene.view("axial")
    scene.reset()
    scene.set(layer.id, "scalars", "fa")
    scene.set_filter(layer.id, "length", 20)
    scene.add_clip("plane")
    scene.select_box(0, 0, 199, 159, through=True)
    ball = scene.open("ball.ply")
    scene.set(ball.id, "opacity", 0.5)
    scene.set_background("#101010")
    scene.info(layer.id)
    scene.show(layer.id, False)
    scene.view("coronal")
    assert renders == []
    assert scene.camera()["focal_point"] == pytest.approx([20, 18, 10], abs=0.1)
    assert scene.usual_shape("plane")["origin"] == pytest.approx([20, 18, 10], abs=0.1)


def test_distances_are_between_what_pixels_show(ball):
    scene = ball
    np.testing.assert_allclose(scene.place_at(100, 80), [20.125, 18.125, 18.0], atol=0.1)
    found = scene.measure(100 - 16, 80, 100 + 16, 80)
    assert found["mm"] == pytest.approx(8.0, abs=0.1)
    assert found["from"][2] == pytest.approx(10 + np.sqrt(64 - 16), abs=0.15)  # of facets
    assert scene.place_at(0, 0) is None
    assert scene.measure(0, 0, 100, 80) is None
    with pytest.raises(ValueError, match="x is"):
        scene.place_at(1000, 0)


def test_a_closed_scene_leaves_nothing(plotter, folder, monkeypatch, tmp_path):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    import tempfile

    monkeypatch.setattr(tempfile, "tempdir", None)
    scene = Scene(plotter, folder)
    scene.open("lines.trk")
    scene.screenshot()
    made = [name for name in os.listdir(tmp_path) if name.startswith("pvfiblets-")]
    assert len(made) == 1
    scene.close()
    scene.close()
    assert [name for name in os.listdir(tmp_path) if name.startswith("pvfiblets-")] == []
    assert list(plotter.fiblets) == []


def test_layers_are_drawn_in_their_order_whenever_they_came(flat):
    """Of two layers in one place, the first shows; also when it was taken away and came back."""
    (first,) = flat.layers
    flat.set(first.id, "color", "#ff0000")
    second = flat.duplicate(first.id)
    flat.set(second.id, "color", "#00ff00")
    state, picture = flat.state, flat.screenshot()
    bytes_before = flat.info(second.id)["gpu_bytes"]
    flat.remove(first.id)
    assert {tuple(c) for c in flat.screenshot()[drawn(picture)].tolist()} == {(0, 255, 0)}
    flat.become(state)
    np.testing.assert_array_equal(flat.screenshot(), picture)
    assert flat.info(second.id)["gpu_bytes"] >= bytes_before > 0


@pytest.mark.more
def test_documents_need_no_server():
    code = (
        "import sys; from pvfiblets.web import history, layers, scene, script, session\n"
        "assert not {'trame', 'trame_server', 'aiohttp', 'wslink'} & set(sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
