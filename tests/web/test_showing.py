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
    flat.set_regions(layer.id, {"how": "stays_in", "region": box})
    np.testing.assert_array_equal(flat.actor(layer.id).shown, y <= 9)
    flat.set_regions(layer.id, {"how": "both_ends_in", "region": far})
    assert not flat.actor(layer.id).shown.any()
    flat.set_regions(layer.id, {"how": "ends_in", "region": {"kind": "labels", "path": "atlas.nii.gz", "labels": [5]}})
    np.testing.assert_array_equal(flat.actor(layer.id).shown, (ends >= 14.3) & (ends < 30.3))
    flat.set_regions(layer.id, None)
    assert flat.actor(layer.id).shown.all()


@pytest.mark.parametrize(
    "condition",
    [
        {},
        [],
        {"how": "passes"},
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
    with pytest.raises(ValueError, match="planes"):
        flat.set_clip(clip.id, kind="sphere")
    with pytest.raises(ValueError, match="VTK allows 6"):
        flat.add_clip("box", layers=[ball.id])
    flat.remove(ball.id)
    assert flat.state.clips[0].layers == ()
