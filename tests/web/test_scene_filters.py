"""Scenes: what filters, regions and cuts leave to be seen."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv


def drawn(picture):
    return (picture > 0).any(axis=-1)


def test_criteria_groups_and_subsets_add_up(flat, lines):
    (layer,) = flat.layers
    length = lines.lengths()
    flat.set_filter(layer.id, "length", 30.25, None)
    np.testing.assert_array_equal(flat.actor(layer.id).shown, length >= 30.25)
    flat.set_filter(layer.id, "length", 30.25, 50.25)
    expected = (length >= 30.25) & (length <= 50.25)
    np.testing.assert_array_equal(flat.actor(layer.id).shown, expected)
    flat.set_subset(layer.id, every=3)
    expected &= np.arange(60) % 3 == 0
    np.testing.assert_array_equal(flat.actor(layer.id).shown, expected)
    assert flat.info(layer.id)["streamlines"] == {"total": 60, "shown": int(expected.sum())}
    flat.remove_filter(layer.id, "length")
    np.testing.assert_array_equal(flat.actor(layer.id).shown, np.arange(60) % 3 == 0)
    flat.remove_filter(layer.id)
    assert flat.actor(layer.id).shown.all()


def test_groups_of_a_file_are_shown(scene):
    layer = scene.open("lines.fiblets")
    scene.set_groups(layer.id, ["far"])
    np.testing.assert_array_equal(scene.actor(layer.id).shown, np.arange(60) >= 30)
    scene.set_groups(layer.id, None)
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
    flat.set_regions(layer.id, {"op": "and", "of": [passes, {"op": "not", "of": [reaches]}]})
    np.testing.assert_array_equal(flat.actor(layer.id).shown, (y <= 9) & ~(ends >= 40.25))
    flat.set_regions(layer.id, {"op": "or", "of": [passes, hits]})
    np.testing.assert_array_equal(flat.actor(layer.id).shown, (y <= 9) | through)
    between = {"kind": "sphere", "center": [float(n) for n in lines[0][:2].mean(axis=0)], "radius": 1e-3}
    flat.set_regions(layer.id, {"how": "passes", "region": between})
    assert flat.actor(layer.id).shown.sum() == 1
    flat.set_regions(layer.id, {"how": "passes", "region": between, "sampling": "points"})
    assert not flat.actor(layer.id).shown.any()
    flat.set_regions(layer.id, {"how": "stays_in", "region": box})
    np.testing.assert_array_equal(flat.actor(layer.id).shown, y <= 9)
    flat.set_regions(layer.id, {"how": "both_ends_in", "region": far})
    assert not flat.actor(layer.id).shown.any()
    flat.set_regions(layer.id, {"how": "ends_in", "region": {"kind": "labels", "path": "atlas.nii.gz", "labels": [5]}})
    np.testing.assert_array_equal(flat.actor(layer.id).shown, (ends >= 14.3) & (ends < 30.3))
    flat.set_regions(layer.id, None)
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
        flat.set_regions(flat.layers[0].id, condition)
    nested = {"how": "passes", "region": {"kind": "sphere", "center": [0, 0, 0], "radius": 1}}
    for _ in range(50):
        nested = {"op": "not", "of": [nested]}
    with pytest.raises(ValueError, match="nested"):
        flat.set_regions(flat.layers[0].id, nested)


def test_cuts_leave_the_side_that_they_say(flat):
    (layer,) = flat.layers
    whole = drawn(flat.screenshot())
    clip = flat.add_clip("plane", normal=[1, 0, 0], origin=[20, 0, 0])
    right = drawn(flat.screenshot())
    flat.set_clip(clip.id, inside=False)
    left = drawn(flat.screenshot())
    column = 100 + round((20 - 30) / 0.5)  # of 200, at half a millimetre a pixel
    assert not right[:, : column - 1].any()
    assert not left[:, column + 2 :].any()
    assert right.any()
    assert left.any()
    assert (whole == (right | left)).mean() > 0.99
    flat.set_clip(clip.id, enabled=False)
    np.testing.assert_array_equal(drawn(flat.screenshot()), whole)
    flat.set_clip(clip.id, enabled=True, origin=[30.0, 0.0, 0.0])
    assert drawn(flat.screenshot())[:, 80:98].any()
    flat.remove_clip(clip.id)
    np.testing.assert_array_equal(drawn(flat.screenshot()), whole)


def test_cuts_are_for_the_layers_that_they_name(flat):
    ball = flat.open("ball.ply")
    flat.show(flat.layers[0].id, False)
    whole = drawn(flat.screenshot())
    clip = flat.add_clip("plane", normal=[1, 0, 0], origin=[20, 0, 0])
    np.testing.assert_array_equal(drawn(flat.screenshot()), whole)  # by default, lines only
    flat.set_clip(clip.id, layers=[ball.id])
    assert 0.35 < drawn(flat.screenshot()).sum() / whole.sum() < 0.65
    flat.set(ball.id, "opacity", 0.99)  # of meshes another actor, cut all the same
    assert 0.35 < drawn(flat.screenshot()).sum() / whole.sum() < 0.65
    flat.remove(ball.id)
    assert flat.state.clips[0].layers == ()
    tubes = flat.open("vessel.vtp")
    with pytest.raises(ValueError, match="tubes are cut by planes"):
        flat.set_clip(clip.id, kind="sphere", layers=[tubes.id])
    flat.set_clip(clip.id, layers=[tubes.id])
    with pytest.raises(ValueError, match="VTK allows 6"):
        flat.add_clip("box", layers=[tubes.id])


def test_meshes_are_cut_by_balls_boxes_and_meshes_from_either_side(flat):
    """A ball of 8 mm, 16 pixels, around (20, 18, 10), seen from above."""
    ball = flat.open("ball.ply")
    flat.show(flat.layers[0].id, False)
    whole = drawn(flat.screenshot())
    clip = flat.add_clip("sphere", center=[20, 18, 18], radius=4, layers=[ball.id])
    inner = drawn(flat.screenshot())
    # Both balls meet where z - 10 = (64 + 64 - 16) / 16 = 7: a ring of sqrt(64 - 49) mm.
    assert inner.sum() == pytest.approx(np.pi * 15.0 * 4.0, rel=0.05)
    flat.set_clip(clip.id, inside=False)
    outer = flat.actor(ball.id).mapper.dataset
    assert outer.area == pytest.approx(flat.data(ball).data.area - 2 * np.pi * 8.0 * 1.0, rel=0.01)
    flat.set(ball.id, "color", "#00ff00")  # another actor, cut all the same
    assert flat.actor(ball.id).mapper.dataset.area == pytest.approx(outer.area)
    flat.set_clip(clip.id, kind="box", bounds=[0, 20, 0, 100, 0, 100], inside=True)
    flat.add_clip("slab", inside=False, normal=[0, 1, 0], origin=[20, 18, 10], thickness=4.0, layers=[ball.id])
    left = drawn(flat.screenshot())
    assert left.sum() == pytest.approx(0.5 * whole.sum() - 4.0 * 2.0 * 8.0 * 2.0, rel=0.1)
    flat.remove_clip(flat.state.clips[-1].id)
    flat.set_clip(clip.id, kind="mesh", path="ball.ply", inside=False)
    flat.screenshot()
    flat.set_clip(clip.id, enabled=False)
    np.testing.assert_array_equal(drawn(flat.screenshot()), whole)


def test_a_mesh_of_which_nothing_is_left_comes_back(flat):
    ball = flat.open("ball.ply")
    flat.show(flat.layers[0].id, False)
    whole = drawn(flat.screenshot())
    clip = flat.add_clip("sphere", center=[500, 0, 0], radius=4, layers=[ball.id])
    assert not drawn(flat.screenshot()).any()
    flat.remove_clip(clip.id)
    np.testing.assert_array_equal(drawn(flat.screenshot()), whole)
