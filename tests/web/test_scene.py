"""Scenes: files become layers, settings pictures, and what is refused leaves everything as it was."""

import itertools
import json
import os

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.errors import FibletsError
from pvfiblets.formats.registry import UnknownFormatError
from pvfiblets.web.scene.files.loading import Cancelled
from pvfiblets.web.scene.scalar_bar_layout import DOTS, Wanted, arrange
from pvfiblets.web.scene.scene import Scene


def drawn(picture):
    return (picture > 0).any(axis=-1)


# Opening ------------------------------------------------------------------------------------------


def test_a_layer_looks_as_the_plotters_own_actor(scene, folder):
    layer = scene.open("lines.trk")
    scene.set(layer.id, "scalars", "fa")
    scene.set(layer.id, "line_width", 3)
    scene.set(layer.id, "show_bar", False)
    scene.cameras.view("coronal")
    picture = scene.cameras.screenshot()
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
        json.dumps(scene.queries.info(layer.id), allow_nan=False)
        json.dumps(scene.queries.histogram(layer.id), allow_nan=False)
    json.dumps(scene.queries.legend, allow_nan=False)
    scene.cameras.screenshot()


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
    info = scene.queries.info(scene.open("lines.trk").id)
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
        lambda: scene.filters.add_clip("mesh", path=path),
        lambda: scene.filters.set_regions(lines, {"how": "passes", "region": {"kind": "mesh", "path": path}}),
        lambda: scene.selection.export(lines, path.replace(".ply", ".trk").replace("passwd", "x.trk"), what="all"),
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
    state, picture = flat.state, flat.cameras.screenshot()
    for refused in (
        lambda: flat.set(layer.id, "opacity", 7),
        lambda: flat.set("layer99", "opacity", 1.0),
        lambda: flat.filters.set_filter(layer.id, "no such", 0, 1),
        lambda: flat.filters.set_filter(layer.id, "length", 5, 1),
        lambda: flat.filters.set_groups(layer.id, ["nobody"]),
        lambda: flat.filters.set_subset(layer.id, -1),
        lambda: flat.filters.set_regions(layer.id, {"how": "passes", "region": {"kind": "mesh", "path": "open.ply"}}),
        lambda: flat.filters.add_clip("mesh", path="open.ply"),
        lambda: flat.filters.add_clip("plane", normal=[0, 0, 0]),
        lambda: flat.rename(layer.id, "\n"),
        lambda: flat.set_background("no colour"),
    ):
        with pytest.raises((ValueError, KeyError)):
            refused()
        assert flat.state is state
    np.testing.assert_array_equal(flat.cameras.screenshot(), picture)


def test_a_filter_that_fails_halfway_is_taken_back(flat, monkeypatch):
    (layer,) = flat.layers
    flat.filters.set_filter(layer.id, "length", 20, 30)
    actor, picture = flat.actor(layer.id), flat.cameras.screenshot()

    def fail(*_, **__):
        raise MemoryError("no more")

    monkeypatch.setattr(actor, "subset", fail)
    with pytest.raises(MemoryError):
        flat.filters.set_subset(layer.id, 0.5)
    monkeypatch.undo()
    assert dict(actor.criteria) == {"length": (20.0, 30.0)}
    np.testing.assert_array_equal(flat.cameras.screenshot(), picture)


def test_layers_are_shown_hidden_duplicated_renamed_and_removed(flat):
    (layer,) = flat.layers
    before = flat.cameras.screenshot()
    flat.show(layer.id, False)
    assert not drawn(flat.cameras.screenshot()).any()
    twin = flat.duplicate(layer.id)
    flat.show(twin.id, True)
    np.testing.assert_array_equal(flat.cameras.screenshot(), before)
    flat.rename(twin.id, "twin")
    assert [other.name for other in flat.layers] == ["lines.trk", "twin"]
    assert flat.data(twin).data is flat.data(flat.layers[0]).data
    flat.remove(twin.id)
    flat.remove(layer.id)
    assert flat.layers == ()
    assert list(flat.plotter.fiblets) == []
    assert not drawn(flat.cameras.screenshot()).any()


def test_meshes_are_coloured_and_show_edges(scene):
    ball = scene.open("ball.ply")
    scene.set(ball.id, "color", "#ff0000")
    scene.set(ball.id, "lighting", False)
    picture = scene.cameras.screenshot()
    colours = {tuple(c) for c in picture[drawn(picture)].tolist()}
    assert colours == {(255, 0, 0)}
    assert scene.actor(ball.id).prop.color.hex_rgb == "#ff0000"
    scene.set(ball.id, "representation", "wireframe")
    assert 0 < drawn(scene.cameras.screenshot()).sum() < drawn(picture).sum()


def test_tubes_are_as_thick_as_they_are_told(scene):
    tubes = scene.open("vessel.vtp")
    actor, given = scene.actor(tubes.id), scene.data(tubes).data
    thin = drawn(scene.cameras.screenshot()).sum()
    scene.set(tubes.id, "radius_scale", 2.0)
    np.testing.assert_allclose(actor.tubes.radius, 2.0 * given.radius)
    assert drawn(scene.cameras.screenshot()).sum() > 1.5 * thin
    scene.set(tubes.id, "radius_scale", 1.0)
    assert drawn(scene.cameras.screenshot()).sum() == thin


def test_images_of_vtk_are_volumes(scene):
    image = pv.ImageData(dimensions=(6, 6, 6))
    image["values"] = np.linspace(0.0, 1.0, 216)
    image.save(scene.root / "image.vtk")
    layer = scene.open("image.vtk")
    assert layer.kind == "volume"
    assert scene.data(layer).data.shape == (6, 6, 6)
    assert drawn(scene.cameras.screenshot()).any()


def test_volumes_show_what_their_mode_says(scene):
    head = scene.open("head.nii.gz")
    surface = drawn(scene.cameras.screenshot())
    scene.set(head.id, "mode", "composite")
    light = drawn(scene.cameras.screenshot())
    assert 0 < surface.sum() < light.sum()  # at the middle value, and from the least on
    scene.set(head.id, "values", [0.7])
    scene.set(head.id, "mode", "isosurface")
    assert 0 < drawn(scene.cameras.screenshot()).sum() < surface.sum()


# Questions ----------------------------------------------------------------------------------------


def test_histograms_count_as_numpy_does(scene, lines):
    layer = scene.open("lines.fiblets")
    found = scene.queries.histogram(layer.id, "length", bins=6)
    counts, edges = np.histogram(lines.lengths(), bins=6)
    np.testing.assert_allclose(found["edges"], edges, atol=0.1)
    assert found["counts"] == counts.tolist()
    assert (found["missing"], found["share"]) == (0, 1.0)
    head = scene.open("head.nii.gz")
    values = scene.data(head).data.values
    assert scene.queries.histogram(head.id, bins=4)["counts"] == np.histogram(values, bins=4)[0].tolist()
    with pytest.raises(ValueError, match="no such"):
        scene.queries.histogram(layer.id, "no such")


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
    assert [entry["name"] for entry in scene.queries.legend] == ["lines.trk"]
    scene.set(two.id, "show_bar", False)
    assert list(scene.plotter.scalar_bars.keys()) == []
    scene.show(one.id, True)
    scene.remove(one.id)
    assert list(scene.plotter.scalar_bars.keys()) == []


def test_groups_have_names_and_no_range(scene):
    layer = scene.open("lines.fiblets")
    rows = {}
    for scalars in ("length", "group"):
        scene.set(layer.id, "scalars", scalars)
        rows[scalars] = {row["name"] for row in scene.queries.properties(layer.id) if row["matters"]}
    assert rows["length"] - rows["group"] == {"clim", "log_scale", "opacity_by"}
    assert rows["group"] >= {"cmap", "nan_color", "show_bar"}
    (legend,) = scene.queries.legend
    assert legend["names"] == ["near", "far"]
    assert not {"clim", "log_scale"} & legend.keys()


@pytest.mark.few(1)
@pytest.mark.parametrize("size", [(320, 240), (640, 690), (1600, 400)])
def test_bars_leave_the_places_of_letters_free(scene, size):
    """Letters stand at the middles of the edges, 16 pixels high, the left one behind the tools."""
    width, height = scene.plotter.window_size = size
    for values in ("length", "fa", "group", "weight"):
        layer = scene.open("lines.fiblets")
        scene.set(layer.id, "scalars", values)
        scene.set(layer.id, "opacity", 0.0)
    scene.cameras.screenshot()
    bars = drawn(scene.cameras.screenshot())
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
    scene.cameras.view(view)
    found = scene.cameras.edges()
    assert "".join(found[side] for side in ("left", "right", "top", "bottom")) == edges
    scene.cameras.parallel = True
    assert scene.cameras.camera()["parallel"] is True
    picture = scene.cameras.screenshot(scale=2)
    assert picture.shape == (320, 400, 3)
    with pytest.raises(ValueError, match="scale"):
        scene.cameras.screenshot(scale=100)


def test_only_pictures_render_and_views_show_what_is_visible(scene):
    """Every render of a large tractogram costs; whoever streams pictures decides when."""
    layer = scene.open("lines.fiblets")
    scene.cameras.screenshot()
    renders = []
    scene.plotter.render_window.AddObserver("StartEvent", lambda *_: renders.append(1))
    scene.cameras.view("axial")
    scene.cameras.reset()
    scene.set(layer.id, "scalars", "fa")
    scene.filters.set_filter(layer.id, "length", 20)
    scene.filters.add_clip("plane")
    scene.selection.select_box(0, 0, 199, 159, through=True)
    ball = scene.open("ball.ply")
    scene.set(ball.id, "opacity", 0.5)
    scene.set_background("#101010")
    scene.queries.info(layer.id)
    scene.show(layer.id, False)
    scene.cameras.view("coronal")
    assert renders == []
    assert scene.cameras.camera()["focal_point"] == pytest.approx([20, 18, 10], abs=0.1)
    assert scene.filters.usual_shape("plane")["origin"] == pytest.approx([20, 18, 10], abs=0.1)


def test_distances_are_between_what_pixels_show(ball):
    scene = ball
    np.testing.assert_allclose(scene.cameras.place_at(100, 80), [20.125, 18.125, 18.0], atol=0.1)
    begin, end = (scene.measurements.place_at(100 + across, 80) for across in (-16, 16))
    assert np.linalg.norm(np.subtract(begin, end)) == pytest.approx(8.0, abs=0.1)
    assert begin[2] == pytest.approx(10 + np.sqrt(64 - 16), abs=0.15)  # of facets
    assert scene.cameras.place_at(0, 0) is None
    assert scene.measurements.place_at(0, 0) is None
    with pytest.raises(ValueError, match="x is"):
        scene.cameras.place_at(1000, 0)


def test_a_closed_scene_leaves_nothing(plotter, folder, monkeypatch, tmp_path):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    import tempfile

    monkeypatch.setattr(tempfile, "tempdir", None)
    scene = Scene(plotter, folder)
    scene.open("lines.trk")
    scene.cameras.screenshot()
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
    state, picture = flat.state, flat.cameras.screenshot()
    bytes_before = flat.queries.info(second.id)["gpu_bytes"]
    flat.remove(first.id)
    assert {tuple(c) for c in flat.cameras.screenshot()[drawn(picture)].tolist()} == {(0, 255, 0)}
    flat.become(state)
    np.testing.assert_array_equal(flat.cameras.screenshot(), picture)
    assert flat.queries.info(second.id)["gpu_bytes"] >= bytes_before > 0


def test_a_pixel_picks_the_line_that_is_there(flat):
    # From above, line 50 + j lies over those below at y = 4 j; x = 10 mm is 40 columns left of the middle.
    row = 80 + round((4 * 3 - 18) / 0.5)
    found = flat.selection.pick_at(100 + round((55 - 30) / 0.5), row)
    assert found["streamline"] == 53
    assert found["position"][0] == pytest.approx(55.0, abs=0.6)
    assert flat.layers[0].selected.array().tolist() == [53]
    other = 80 + round((4 * 7 - 18) / 0.5)
    assert flat.selection.pick_at(100, other, mode="add")["streamline"] == 57
    assert flat.layers[0].selected.array().tolist() == [53, 57]
    flat.selection.pick_at(100, row, mode="toggle")
    assert flat.layers[0].selected.array().tolist() == [57]
    assert flat.selection.pick_at(2, 2) is None
    assert flat.selection.count() == 0


def test_boxes_and_lassos_select_what_they_hold(flat, lines):
    (layer,) = flat.layers
    x0 = 100 + round((50 - 30) / 0.5)
    reach = np.array([line[-1, 0] for line in lines])
    flat.selection.select_box(x0, 0, 199, 159, through=True)
    beyond = set(np.flatnonzero(reach > 51).tolist())
    found = set(flat.layers[0].selected.array().tolist())
    assert beyond <= found <= set(np.flatnonzero(reach >= 49).tolist())
    before = flat.selection.count()
    flat.selection.select_polygon([[x0, 0], [199, 0], [199, 80], [x0, 80]], mode="remove", through=True)
    y = np.array([line[0, 1] for line in lines])
    assert set(flat.layers[0].selected.array().tolist()) == {i for i in found if y[i] > 18}
    assert 0 < flat.selection.count() < before
    flat.selection.deselect()
    assert flat.layers[0].selected is None
    assert len(flat.actor(layer.id).selection) == 0
    with pytest.raises(ValueError, match="lasso"):
        flat.selection.select_polygon([[0, 0]])
    with pytest.raises(ValueError, match="mode"):
        flat.selection.select_box(0, 0, 9, 9, mode="perhaps")


def test_the_table_says_what_is_selected(scene, lines):
    layer = scene.open("lines.fiblets")
    scene.set(layer.id, "scalars", "fa")
    scene.selection.select(layer.id, [7, 31, 59])
    table = scene.selection.table()
    assert table["total"] == 3
    assert [row["streamline"] for row in table["rows"]] == [7, 31, 59]
    np.testing.assert_allclose([row["length"] for row in table["rows"]], lines.lengths()[[7, 31, 59]], atol=0.1)
    assert [row["points"] for row in table["rows"]] == lines.counts[[7, 31, 59]].tolist()
    np.testing.assert_allclose([row["value"] for row in table["rows"]], 0.5, atol=0.01)
    assert [row["groups"] for row in table["rows"]] == [["near"], ["far"], ["far"]]
    assert [row["streamline"] for row in scene.selection.table(first=1, limit=1)["rows"]] == [31]
    json.dumps(table, allow_nan=False)
    profile = scene.selection.profile(layer.id, n=5)
    np.testing.assert_allclose(profile["mean"], [0, 0.25, 0.5, 0.75, 1], atol=0.01)
    assert (profile["name"], profile["count"]) == ("fa", 3)
    for ids in ([60], [-1], [0.5]):
        with pytest.raises(ValueError, match="streamlines are"):
            scene.selection.select(layer.id, ids)


@pytest.mark.parametrize("suffix", [".trk", ".tck", ".trx", ".vtp", ".vtk", ".fiblets"])
def test_exports_hold_what_was_selected(scene, lines, suffix):
    layer = scene.open("lines.fiblets")
    with pytest.raises(ValueError, match="nothing"):
        scene.selection.export(layer.id, f"some{suffix}")
    scene.selection.select(layer.id, [3, 10, 11, 40])
    said = scene.selection.export(layer.id, f"some{suffix}")
    assert (said["path"], said["streamlines"]) == (f"some{suffix}", 4)
    place = scene.root / f"some{suffix}"
    found = pvfiblets.FibletSet.open(place).decompress() if suffix == ".fiblets" else pvfiblets.read(place)
    assert len(found) == 4
    np.testing.assert_allclose(found.points, lines[[3, 10, 11, 40]].points, atol=0.06)
    with pytest.raises(FileExistsError):
        scene.selection.export(layer.id, f"some{suffix}")
    scene.filters.set_groups(layer.id, ["far"])
    assert scene.selection.export(layer.id, f"some{suffix}", what="shown", overwrite=True)["streamlines"] == 30
    with pytest.raises(ValueError, match="end in one of"):
        scene.selection.export(layer.id, "some.txt")


def test_what_is_selected_becomes_a_layer_of_its_own(scene, lines):
    layer = scene.open("lines.fiblets")
    scene.selection.select(layer.id, np.arange(20, 50))
    part = scene.keep_selection(layer.id)
    assert part.kind == "selection"
    scene.selection.select(part.id, [0, 5, 29], mode="replace")
    nested = scene.keep_selection(part.id)
    assert nested.source.ids.array().tolist() == [20, 25, 49]
    np.testing.assert_allclose(
        scene.actor(nested.id).fiblets.decompress().points, lines[[20, 25, 49]].points, atol=0.06
    )
    scene.remove(layer.id)
    scene.cameras.screenshot()


def test_criteria_groups_and_subsets_add_up(flat, lines):
    (layer,) = flat.layers
    length = lines.lengths()
    flat.filters.set_filter(layer.id, "length", 30.25, None)
    np.testing.assert_array_equal(flat.actor(layer.id).shown, length >= 30.25)
    flat.filters.set_filter(layer.id, "length", 30.25, 50.25)
    expected = (length >= 30.25) & (length <= 50.25)
    np.testing.assert_array_equal(flat.actor(layer.id).shown, expected)
    flat.filters.set_subset(layer.id, every=3)
    expected &= np.arange(60) % 3 == 0
    np.testing.assert_array_equal(flat.actor(layer.id).shown, expected)
    assert flat.queries.info(layer.id)["streamlines"] == {"total": 60, "shown": int(expected.sum())}
    flat.filters.remove_filter(layer.id, "length")
    np.testing.assert_array_equal(flat.actor(layer.id).shown, np.arange(60) % 3 == 0)
    flat.filters.remove_filter(layer.id)
    assert flat.actor(layer.id).shown.all()


def test_groups_of_a_file_are_shown(scene):
    layer = scene.open("lines.fiblets")
    scene.filters.set_groups(layer.id, ["far"])
    np.testing.assert_array_equal(scene.actor(layer.id).shown, np.arange(60) >= 30)
    scene.filters.set_groups(layer.id, None)
    assert scene.actor(layer.id).shown.all()


@pytest.mark.more
def test_regions_are_joined_by_and_or_not(flat, lines):
    (layer,) = flat.layers
    box = {"kind": "box", "bounds": [-1, 100, -1, 9, -1, 100]}
    far = {"kind": "plane", "normal": [1, 0, 0], "origin": [40.25, 0, 0]}
    ball = {"kind": "mesh", "path": "ball.ply"}
    y, ends = np.array([line[0, 1] for line in lines]), np.array([line[-1, 0] for line in lines])
    mesh = pv.Sphere(radius=8.0, center=(20.0, 18.0, 10.0))
    inside = pv.PolyData(lines.points.astype(float)).select_interior_points(mesh)["selected_points"].astype(bool)
    through = np.array([inside[a:b].any() for a, b in zip(lines.offsets[:-1], lines.offsets[1:], strict=True)])
    passes = {"how": "passes", "region": box}
    reaches = {"how": "ends_in", "region": far}
    hits = {"how": "passes", "region": ball}
    flat.filters.set_regions(layer.id, {"op": "and", "of": [passes, {"op": "not", "of": [reaches]}]})
    np.testing.assert_array_equal(flat.actor(layer.id).shown, (y <= 9) & ~(ends >= 40.25))
    flat.filters.set_regions(layer.id, {"op": "or", "of": [passes, hits]})
    np.testing.assert_array_equal(flat.actor(layer.id).shown, (y <= 9) | through)
    between = {"kind": "sphere", "center": [float(n) for n in lines[0][:2].mean(axis=0)], "radius": 1e-3}
    flat.filters.set_regions(layer.id, {"how": "passes", "region": between})
    assert flat.actor(layer.id).shown.sum() == 1
    flat.filters.set_regions(layer.id, {"how": "passes", "region": between, "sampling": "points"})
    assert not flat.actor(layer.id).shown.any()
    flat.filters.set_regions(layer.id, {"how": "stays_in", "region": box})
    np.testing.assert_array_equal(flat.actor(layer.id).shown, y <= 9)
    flat.filters.set_regions(layer.id, {"how": "both_ends_in", "region": far})
    assert not flat.actor(layer.id).shown.any()
    flat.filters.set_regions(
        layer.id, {"how": "ends_in", "region": {"kind": "labels", "path": "atlas.nii.gz", "labels": [5]}}
    )
    np.testing.assert_array_equal(flat.actor(layer.id).shown, (ends >= 14.3) & (ends < 30.3))
    flat.filters.set_regions(layer.id, None)
    assert flat.actor(layer.id).shown.all()


@pytest.mark.few(3)
@pytest.mark.parametrize(
    "condition",
    [
        {},
        [],
        {"how": "passes"},
        {"how": "passes", "region": {"kind": "sphere", "center": [0, 0, 0], "radius": 1}, "sampling": 0.5},
        {"how": "ends_in", "region": {"kind": "sphere", "center": [0, 0, 0], "radius": 1}, "sampling": "points"},
        {"how": "flies over", "region": {"kind": "sphere", "center": [0, 0, 0], "radius": 1}},
        {"how": "passes", "region": {"kind": "sphere", "center": [0, 0], "radius": 1}},
        {"how": "passes", "region": {"kind": "sphere", "center": [0, 0, 0], "radius": 0}},
        {"how": "passes", "region": {"kind": "box", "bounds": [1, 0, 0, 1, 0, 1]}},
        {"how": "passes", "region": {"kind": "mesh", "path": "../ball.ply"}},
        {"op": "xor", "of": []},
        {"op": "not", "of": [{}, {}]},
    ],
)
def test_conditions_that_are_none_are_refused(flat, condition):
    with pytest.raises((ValueError, PermissionError)):
        flat.filters.set_regions(flat.layers[0].id, condition)
    nested = {"how": "passes", "region": {"kind": "sphere", "center": [0, 0, 0], "radius": 1}}
    for _ in range(50):
        nested = {"op": "not", "of": [nested]}
    with pytest.raises(ValueError, match="nested"):
        flat.filters.set_regions(flat.layers[0].id, nested)


def test_cuts_leave_the_side_that_they_say(flat):
    (layer,) = flat.layers
    whole = drawn(flat.cameras.screenshot())
    clip = flat.filters.add_clip("plane", normal=[1, 0, 0], origin=[20, 0, 0])
    right = drawn(flat.cameras.screenshot())
    flat.filters.set_clip(clip.id, inside=False)
    left = drawn(flat.cameras.screenshot())
    column = 100 + round((20 - 30) / 0.5)  # of 200, at half a millimetre a pixel
    assert not right[:, : column - 1].any()
    assert not left[:, column + 2 :].any()
    assert right.any()
    assert left.any()
    assert (whole == (right | left)).mean() > 0.99
    flat.filters.set_clip(clip.id, enabled=False)
    np.testing.assert_array_equal(drawn(flat.cameras.screenshot()), whole)
    flat.filters.set_clip(clip.id, enabled=True, origin=[30.0, 0.0, 0.0])
    assert drawn(flat.cameras.screenshot())[:, 80:98].any()
    flat.filters.remove_clip(clip.id)
    np.testing.assert_array_equal(drawn(flat.cameras.screenshot()), whole)


def test_cuts_are_for_the_layers_that_they_name(flat):
    ball = flat.open("ball.ply")
    flat.show(flat.layers[0].id, False)
    whole = drawn(flat.cameras.screenshot())
    clip = flat.filters.add_clip("plane", normal=[1, 0, 0], origin=[20, 0, 0])
    np.testing.assert_array_equal(drawn(flat.cameras.screenshot()), whole)  # by default, lines only
    flat.filters.set_clip(clip.id, layers=[ball.id])
    assert 0.35 < drawn(flat.cameras.screenshot()).sum() / whole.sum() < 0.65
    flat.set(ball.id, "opacity", 0.99)  # of meshes another actor, cut all the same
    assert 0.35 < drawn(flat.cameras.screenshot()).sum() / whole.sum() < 0.65
    flat.remove(ball.id)
    assert flat.state.clips[0].layers == ()
    tubes = flat.open("vessel.vtp")
    with pytest.raises(ValueError, match="tubes are cut by planes"):
        flat.filters.set_clip(clip.id, kind="sphere", layers=[tubes.id])
    flat.filters.set_clip(clip.id, layers=[tubes.id])
    with pytest.raises(ValueError, match="VTK allows 6"):
        flat.filters.add_clip("box", layers=[tubes.id])


def test_meshes_are_cut_by_balls_boxes_and_meshes_from_either_side(flat):
    """A ball of 8 mm, 16 pixels, around (20, 18, 10), seen from above."""
    ball = flat.open("ball.ply")
    flat.show(flat.layers[0].id, False)
    whole = drawn(flat.cameras.screenshot())
    clip = flat.filters.add_clip("sphere", center=[20, 18, 18], radius=4, layers=[ball.id])
    inner = drawn(flat.cameras.screenshot())
    # Both balls meet where z - 10 = (64 + 64 - 16) / 16 = 7: a ring of sqrt(64 - 49) mm.
    assert inner.sum() == pytest.approx(np.pi * 15.0 * 4.0, rel=0.05)
    flat.filters.set_clip(clip.id, inside=False)
    outer = flat.actor(ball.id).mapper.dataset
    assert outer.area == pytest.approx(flat.data(ball).data.area - 2 * np.pi * 8.0 * 1.0, rel=0.01)
    flat.set(ball.id, "color", "#00ff00")  # another actor, cut all the same
    assert flat.actor(ball.id).mapper.dataset.area == pytest.approx(outer.area)
    flat.filters.set_clip(clip.id, kind="box", bounds=[0, 20, 0, 100, 0, 100], inside=True)
    flat.filters.add_clip("slab", inside=False, normal=[0, 1, 0], origin=[20, 18, 10], thickness=4.0, layers=[ball.id])
    left = drawn(flat.cameras.screenshot())
    assert left.sum() == pytest.approx(0.5 * whole.sum() - 4.0 * 2.0 * 8.0 * 2.0, rel=0.1)
    flat.filters.remove_clip(flat.state.clips[-1].id)
    flat.filters.set_clip(clip.id, kind="mesh", path="ball.ply", inside=False)
    flat.cameras.screenshot()
    flat.filters.set_clip(clip.id, enabled=False)
    np.testing.assert_array_equal(drawn(flat.cameras.screenshot()), whole)


def test_a_mesh_of_which_nothing_is_left_comes_back(flat):
    ball = flat.open("ball.ply")
    flat.show(flat.layers[0].id, False)
    whole = drawn(flat.cameras.screenshot())
    clip = flat.filters.add_clip("sphere", center=[500, 0, 0], radius=4, layers=[ball.id])
    assert not drawn(flat.cameras.screenshot()).any()
    flat.filters.remove_clip(clip.id)
    np.testing.assert_array_equal(drawn(flat.cameras.screenshot()), whole)


SIZES = [(760, 856), (800, 556), (320, 596), (320, 276), (276, 320), (1600, 400)]  # of pictures in pages
VALUES = ("length", "fa", "group", "weight")


def rectangle(picture):
    """Return left, right, top and bottom of what is drawn on black."""
    lit = picture.max(axis=2) > 30
    columns, rows = np.flatnonzero(lit.any(axis=0)), np.flatnonzero(lit.any(axis=1))
    return (columns[0], columns[-1] + 1, rows[0], rows[-1] + 1) if columns.size else None


def apart(one, other, least):
    """Whether two rectangles are so many pixels from each other, across or down."""
    across = max(one[0], other[0]) - min(one[1], other[1])
    down = max(one[2], other[2]) - min(one[3], other[3])
    return max(across, down) >= least


class Bars:
    """The bars of a scene, whose layers are not to be seen."""

    def __init__(self, scene, values=VALUES):
        self.scene = scene
        for name in values:
            layer = scene.open("lines.fiblets")
            scene.set(layer.id, "scalars", name)
            scene.set(layer.id, "opacity", 0.0)
        scene.cameras.screenshot()

    @property
    def shown(self):
        return {title: bar for title, bar in self.scene.plotter.scalar_bars.items() if bar.GetVisibility()}

    def alone(self, bar):
        """Return a picture of one bar alone."""
        others = [other for other in self.shown.values() if other is not bar]
        for other in others:
            other.VisibilityOff()
        try:
            return self.scene.cameras.screenshot()
        finally:
            for other in others:
                other.VisibilityOn()

    def parts(self, bar):
        """Return the rectangles of a bar's title, and of all else."""
        title, rest = bar.GetTitleTextProperty(), (bar.GetLabelTextProperty(), bar.GetAnnotationTextProperty())
        found = []
        for hidden in ((title,), (*rest, None)):
            for letters in hidden:
                letters.SetOpacity(0.0) if letters else bar.DrawColorBarOff()
            bar.SetDrawAnnotations(None not in hidden)
            found.append(rectangle(self.alone(bar)))
            for letters in hidden:
                letters.SetOpacity(1.0) if letters else bar.DrawColorBarOn()
        bar.DrawAnnotationsOn()
        return found[1], found[0]


@pytest.mark.more
@pytest.mark.parametrize(
    ("size", "dpi"),
    [*((size, 72) for size in SIZES[:1]), ((320, 276), 144),
     *(pytest.param(size, 72, marks=pytest.mark.exhaustive) for size in SIZES[1:])],
)  # fmt: skip
def test_nothing_of_a_bar_touches_anything(scene, size, dpi):
    width, height = scene.plotter.window_size = size[0] * dpi // 72, size[1] * dpi // 72
    scene.plotter.render_window.SetDPI(dpi)
    bars = Bars(scene)
    shown = bars.shown
    assert len(shown) + len(scene.bars.left_out) == 4
    assert len(shown) >= (4 if min(size) > 320 else 3)
    whole = {}
    for title, bar in shown.items():
        above, below = bars.parts(bar)
        assert apart(above, below, 2 * dpi // 72), f"the title of {title} at {above} touches what is at {below}"
        whole[title] = rectangle(bars.alone(bar))
        left, right, top, bottom = whole[title]
        scale = dpi / 72
        assert left >= 46 * scale  # where tools are
        assert right <= width - 4 * scale
        assert bottom <= height - 24 * scale  # where a line of text is
        assert top >= height / 2 + 12 * scale  # where letters are
    for one, other in itertools.combinations(shown, 2):
        assert apart(whole[one], whole[other], 6 * dpi // 72), f"{one} at {whole[one]}, {other} at {whole[other]}"


@pytest.mark.more
def test_bars_follow_the_size_of_the_window(scene):
    bars = Bars(scene)
    scene.plotter.window_size = 800, 600
    scene.cameras.screenshot()
    assert len(bars.shown) == 4
    wide = [rectangle(bars.alone(bar)) for bar in bars.shown.values()]
    scene.plotter.window_size = 200, 160
    scene.cameras.screenshot()
    assert not bars.shown
    assert scene.bars.left_out == ["length [mm]", "fa", "group", "weight"]
    assert rectangle(scene.cameras.screenshot()) is None
    scene.plotter.window_size = 800, 600
    scene.cameras.screenshot()
    assert scene.bars.left_out == []
    assert [rectangle(bars.alone(bar)) for bar in bars.shown.values()] == wide


@pytest.mark.more
def test_half_as_many_pixels_show_the_same_bars(scene):
    """As they are drawn while the camera moves: letters have half the size, too."""
    scene.plotter.window_size = 800, 600
    bars = Bars(scene, ("length", "fa"))
    whole = {title: rectangle(bars.alone(bar)) for title, bar in bars.shown.items()}
    scene.plotter.window_size = 400, 300
    scene.plotter.render_window.SetDPI(36)
    scene.cameras.screenshot()
    for title, bar in bars.shown.items():
        np.testing.assert_allclose(2 * np.array(rectangle(bars.alone(bar))), whole[title], atol=8)


def test_long_titles_are_shortened_and_no_more_bars_shown_than_fit():
    def measure(text, font):
        return 0.6 * font * len(text)

    wanted = [Wanted(f"a title of many words {k}", ("0.00", "-12.5")) for k in range(6)]
    for width, font, count in ((1600, 13, 6), (800, 13, 6), (400, 9, 6), (320, 9, 4), (120, 13, 1), (80, 0, 0)):
        places = arrange(wanted, (width, 600), 1.0, measure)
        shown = [place for place in places if place is not None]
        assert len(shown) == count
        assert places[count:] == [None] * (6 - count)  # the first layers keep theirs
        assert all(place.font >= font for place in shown)
        ends = [(place.left, place.left + place.width) for place in shown]
        assert all(start >= 48 and end <= width - 8 for start, end in ends)
        assert all(right[0] > left[1] for right, left in itertools.pairwise(ends))
        short = [place.title for place in shown if place.title.endswith(DOTS)]
        assert len(short) == (0 if width == 1600 else count)


def test_names_that_find_no_room_are_left_out():
    def measure(text, font):
        return 0.6 * font * len(text)

    def place(names, size):
        (found,) = arrange([Wanted("group", tuple(names), named=True)], size, 1.0, measure)
        return found

    assert place(["near", "far"], (320, 600)).label_font == 13
    small = place([f"part {k}" for k in range(14)], (320, 600))
    assert 7 <= small.label_font < 13
    assert place([f"part {k}" for k in range(100)], (320, 600)) is None
    assert place(["a name that is much longer than the picture is wide"], (320, 600)) is None


@pytest.mark.more
def test_enlarged_pictures_have_their_bars_where_the_page_has_them(scene):
    bars = Bars(scene, ["length"])
    scene.plotter.window_size = 400, 320
    before = np.array(rectangle(scene.cameras.screenshot()))
    after = np.array(rectangle(scene.cameras.screenshot(scale=3)))
    assert len(bars.shown) == 1
    np.testing.assert_allclose(after / 3, before, atol=3)
