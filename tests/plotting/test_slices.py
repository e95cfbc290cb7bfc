"""Slices of images and their glyphs lie where affines say and have the colours that their layers say."""

from __future__ import annotations

import gc
import weakref

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv

import pvfiblets.plotting  # noqa: F401 - registers the components
from pvfiblets.plotting.slices.resampling import Resampler
from pvfiblets.slices.frames import covered, grid_of, plane_axes
from pvfiblets.slices.image import SliceImage, as_slice_image

SHEARED = np.array([[2.0, 0.7, 0.3, -20.0], [-0.4, 1.5, 0.2, 5.0], [0.1, 0.5, 3.0, 9.0], [0.0, 0.0, 0.0, 1.0]])
MIRRORED = np.diag([-2.0, 1.5, 2.5, 1.0])
SHAPE = (12, 14, 9)


def ramp(affine, weights=(0.03, -0.02, 0.05), shape=SHAPE):
    """Return numbers that grow evenly in mm: linear interpolation gives them exactly at every position."""
    at = nib.affines.apply_affine(affine, np.stack(np.mgrid[: shape[0], : shape[1], : shape[2]], axis=-1))
    return (at @ np.array(weights)).astype(np.float32)


def in_the_middle(affine, positions, shape=SHAPE, margin=0.0):
    """Return which positions lie within the centres of the outer voxels."""
    voxels = nib.affines.apply_affine(np.linalg.inv(affine), positions)
    return ((voxels >= margin) & (voxels <= np.array(shape) - 1 - margin)).all(axis=-1)


@pytest.mark.parametrize("affine", [SHEARED, MIRRORED], ids=["sheared", "mirrored"])
@pytest.mark.parametrize("orientation", ["axial", "coronal", "sagittal"])
@pytest.mark.parametrize("interpolation", ["nearest", "linear", "cubic"])
def test_values_on_a_plane_are_those_at_nibabels_coordinates(affine, orientation, interpolation):
    values = np.random.default_rng(0).normal(size=SHAPE).astype(np.float32)
    image = SliceImage(values[..., None], affine)
    along, up = plane_axes(np.eye(3), orientation)
    position = image.center + (0.31, -0.22, 0.43)
    grid = grid_of(covered([image.corners], position, along, up), position, along, up, 0.41)
    found = Resampler(values, image.inverse).at(grid, interpolation)
    voxels = nib.affines.apply_affine(np.linalg.inv(affine), grid.positions())
    inside = ((voxels > -0.5) & (voxels < np.array(SHAPE) - 0.5)).all(axis=-1)
    assert inside.sum() > 500
    np.testing.assert_array_equal(np.isfinite(found), inside)
    middle = in_the_middle(affine, grid.positions(), margin=1.0)
    wanted = _interpolated(values, voxels[middle], interpolation)
    np.testing.assert_allclose(found[middle], wanted, atol=2e-4)


def _interpolated(values, voxels, how):
    """Return values between voxels in float64: the nearest, linear, or cubic after Catmull and Rom."""
    if how == "nearest":
        return values[tuple(np.floor(voxels + 0.5).astype(int).T)]
    base = np.floor(voxels).astype(int)
    t = voxels - base
    if how == "linear":
        weights = np.stack([1 - t, t], axis=-1)
        first = 0
    else:
        weights = 0.5 * np.stack(
            [-(t**3) + 2 * t**2 - t, 3 * t**3 - 5 * t**2 + 2, -3 * t**3 + 4 * t**2 + t, t**3 - t**2], axis=-1
        )
        first = -1
    out = np.zeros(len(voxels))
    n = weights.shape[-1]
    for i, j, k in np.ndindex(n, n, n):
        share = weights[:, 0, i] * weights[:, 1, j] * weights[:, 2, k]
        at = np.clip(base + np.array([i, j, k]) + first, 0, np.array(values.shape) - 1)
        out += share * values[tuple(at.T)]
    return out


@pytest.mark.parametrize("affine", [SHEARED, MIRRORED], ids=["sheared", "mirrored"])
@pytest.mark.parametrize("orientation", ["axial", "coronal", "sagittal"])
def test_pixels_of_the_window_show_what_lies_at_their_positions(plotter, affine, orientation):
    values = ramp(affine)
    low, high = float(values.min()), float(values.max())
    slices = plotter.add_slices((values, affine), planes=orientation, clim=(low, high))
    {"axial": plotter.view_xy, "coronal": plotter.view_xz, "sagittal": plotter.view_yz}[orientation]()
    plotter.enable_parallel_projection()
    plotter.show(auto_close=False)
    picture = plotter.screenshot(return_img=True)[::-1].astype(float)
    camera = plotter.camera
    height = 2.0 * camera.parallel_scale
    toward = np.array(camera.focal_point) - np.array(camera.position)
    toward /= np.linalg.norm(toward)
    up = np.array(camera.up)
    right = np.cross(toward, up)
    y, x = np.mgrid[:200, :200]
    step = height / 200.0
    at = np.array(camera.focal_point) + ((x - 99.5) * step)[..., None] * right + ((y - 99.5) * step)[..., None] * up
    at = at - ((at - slices.position) @ toward)[..., None] * toward
    middle = in_the_middle(affine, at, margin=0.5)
    assert middle.sum() > 2000
    wanted = 255.0 * (at @ (0.03, -0.02, 0.05) - low) / (high - low)
    assert abs(picture[middle][:, 0] - wanted[middle]).max() < 4.0
    outside = ~in_the_middle(affine, at, margin=-1.2)
    assert not picture[outside].any()


def test_a_slice_hides_what_is_behind_it_only_where_it_shows_something(plotter):
    values = np.zeros(SHAPE)
    values[:6] = 1.0
    slices = plotter.add_slices(values, planes="axial", below=0.5, clim=(0, 1), interpolation="nearest")
    plotter.add_mesh(pv.Plane(center=(5.5, 6.5, 1.0), i_size=40, j_size=40), color="red", lighting=False)
    plotter.view_xy()
    plotter.camera.zoom(3)
    plotter.show(auto_close=False)
    picture = plotter.screenshot(return_img=True)
    colours, counts = np.unique(picture.reshape(-1, 3), axis=0, return_counts=True)
    assert {tuple(c) for c in colours.tolist()} == {(255, 0, 0), (255, 255, 255)}
    assert counts.min() > 200
    slices.layers[0].opacity = 0.5
    plotter.render()
    picture = plotter.screenshot(return_img=True)
    assert (abs(picture.astype(int) - (255, 128, 128)).max(axis=2) <= 1).sum() > 200


def test_the_window_is_of_percentiles_and_follows_the_volume(plotter):
    rng = np.random.default_rng(0)
    values = np.concatenate([np.zeros((2, 20, 20, 3)), rng.normal(100, 10, (18, 20, 20, 3)) * [1, 2, 3]])
    slices = plotter.add_slices((values, np.eye(4)), percentiles=(2, 98))
    layer = slices.layers[0]
    for index in range(3):
        layer.index = index
        wanted = np.percentile(values[2:, ..., index], (2, 98))
        np.testing.assert_allclose(layer.clim, wanted)
        at = slices.values()["image"]
        np.testing.assert_allclose(at, values[9:11, 9:11, 9:11, index].mean(), rtol=1e-6)
    layer.clim = 7
    assert layer.clim == (-7.0, 7.0)
    with pytest.raises(ValueError, match="index is 3; image has 3 volumes"):
        layer.index = 3


def test_labels_have_names_and_colours_and_are_never_mixed(plotter):
    values = np.zeros((10, 10, 10), np.int32)
    values[2:5], values[5:8] = 17, 2_000_000_011
    slices = plotter.add_slices(
        values,
        labels={17: ("hippocampus", "yellow"), 2_000_000_011: ("far", (0, 0, 255))},
        planes="axial",
        position=(3, 4, 5),
    )
    assert slices.values() == {"image": (17, "hippocampus")}
    pixels = slices.pixels(slices["axial"].grid)
    found = {tuple(c) for c in pixels.reshape(-1, 4).tolist()}
    assert found == {(0, 0, 0, 0), (255, 255, 0, 255), (0, 0, 255, 255)}
    full = (pixels[..., 3] > 0).sum()
    slices.layers[0].outline = True
    assert 0 < (slices.pixels(slices["axial"].grid)[..., 3] > 0).sum() < 0.5 * full
    slices.position = (0, 0, 0)
    assert slices.values() == {"image": (0, "0")}
    with pytest.raises(ValueError, match="labels are whole numbers"):
        plotter.add_slices(values + 0.5, labels={1: "one"})


def test_vectors_are_colours_of_direction_brightened_by_an_image_on_another_grid(plotter):
    vectors = np.zeros((8, 8, 8, 3), np.float32)
    vectors[:4, ..., 0], vectors[4:, ..., 2] = -2.0, 1.0
    weights = np.full((4, 4, 4), 0.5), np.diag([2.0, 2.0, 2.0, 1.0]) + np.array([[0, 0, 0, 0.5]] * 3 + [[0] * 4])
    shown = {"modulate": weights, "clim": (0, 1), "planes": "axial", "interpolation": "nearest"}
    slices = plotter.add_slices((vectors, np.eye(4)), **shown)
    assert slices.layers[0].kind == "direction"
    found = {tuple(c) for c in slices.pixels(slices["axial"].grid).reshape(-1, 4).tolist()}
    assert found == {(128, 0, 0, 255), (0, 0, 128, 255)}
    slices.layers[0].clim = (0.0, 0.5)
    found = {tuple(c) for c in slices.pixels(slices["axial"].grid).reshape(-1, 4).tolist()}
    assert found == {(255, 0, 0, 255), (0, 0, 255, 255)}
    slices.layers[0].below = 0.6
    assert not slices.pixels(slices["axial"].grid).any()
    np.testing.assert_array_equal(slices.values((1, 1, 1))["image"], [-2.0, 0.0, 0.0])
    values = np.zeros((6, 6, 6, 3), np.uint8)  # bytes of three are colours
    values[..., 1] = 200
    slices = plotter.add_slices((values, np.eye(4)), planes="coronal")
    assert slices.layers[0].kind == "rgb"
    assert {tuple(c) for c in slices.pixels(slices["coronal"].grid).reshape(-1, 4).tolist()} == {(0, 200, 0, 255)}
    fields = np.zeros((6, 6, 6), [("R", "u1"), ("G", "u1"), ("B", "u1")])
    fields["B"] = 9
    assert as_slice_image((fields, np.eye(4))).values[0, 0, 0].tolist() == [0, 0, 9]


def test_layers_are_laid_over_each_other_and_there_are_eight_at_most(plotter):
    slices = plotter.add_slices(np.ones((5, 5, 5)), clim=(0, 1), planes="axial")
    red = slices.add(np.ones((5, 5, 5)), cmap=["red", "red"], opacity=0.25)
    grid = slices["axial"].grid
    np.testing.assert_allclose(slices.pixels(grid)[0, 0], [255, 191, 191, 255], atol=1)
    slices.layers[0].clim, red.blend = (0, 4), "add"
    np.testing.assert_allclose(slices.pixels(grid)[0, 0], [128, 64, 64, 255], atol=1)
    red.visible = False
    np.testing.assert_allclose(slices.pixels(grid)[0, 0], [64, 64, 64, 255], atol=1)
    assert [one.name for one in slices.layers] == ["image", "image 2"]
    for _ in range(6):
        slices.add(np.ones((5, 5, 5)))
    with pytest.raises(ValueError, match="8 layers"):
        slices.add(np.ones((5, 5, 5)))
    slices.remove_layer("image 3")
    assert len(slices.layers) == 7
    with pytest.raises(KeyError, match="image 3"):
        slices.layer("image 3")


def test_slices_of_a_tilted_image_may_lie_along_its_own_axes(plotter):
    angle = np.radians(30.0)
    tilt = np.array([[1, 0, 0], [0, np.cos(angle), -np.sin(angle)], [0, np.sin(angle), np.cos(angle)]])
    affine = np.eye(4)
    affine[:3, :3] = tilt
    values = np.broadcast_to(np.arange(9.0), (7, 8, 9))
    slices = plotter.add_slices((values, affine), axes="image", clim=(0, 8))
    np.testing.assert_allclose(slices["axial"].normal, tilt[:, 2], atol=1e-12)
    picture = slices.pixels(slices["axial"].grid)
    assert np.ptp(picture[..., 0]) <= 1  # one layer of voxels throughout
    slices["axial"].normal = (0, 0, 1)
    assert np.ptp(slices.pixels(slices["axial"].grid)[..., 0]) > 60
    np.testing.assert_allclose(slices["axial"].normal, (0, 0, 1), atol=1e-12)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"clim": (1, 0)}, "clim is"), ({"clim": "all"}, "clim is"), ({"percentiles": (-1, 50)}, "percentiles is"),
        ({"below": "high"}, "below is"), ({"blend": "under"}, "blend is"), ({"interpolation": "sinc"}, "interpolation"),
        ({"opacity": 2}, "opacity is"), ({"index": 1}, "index is"), ({"cmap": "viridsi"}, "viridis"),
        ({"planes": "oblique"}, "planes has"), ({"axes": "voxels"}, "axes is"), ({"kind": "heat"}, "kind is"),
        ({"axes": np.diag([1, 1, -1])}, "axes is"), ({"position": (1, 2)}, "position is"),
        ({"kind": "rgb"}, "1 numbers per voxel"), ({"kind": "rgb", "labels": {}}, "labels are given"),
    ],
)  # fmt: skip
def test_bad_arguments_are_refused_and_nothing_is_left_behind(plotter, arguments, said):
    with pytest.raises(TypeError, match=r"add_slices\(\) takes no colormap: give cmap"):
        plotter.add_slices(np.ones((5, 5, 5)), colormap="hot")
    with pytest.raises(TypeError, match=r"add_slices\(\) got an unexpected keyword argument 'texture'"):
        plotter.add_slices(np.ones((5, 5, 5)), texture=None)
    with pytest.raises(ValueError, match=said):
        plotter.add_slices(np.ones((5, 5, 5)), **arguments)
    for source, more, error, told in (
        ({1, 2}, {}, TypeError, "a set"), (np.ones((5, 5, 5)), {"opactiy": 1}, TypeError, "opactiy"),
        (np.ones((5, 5)), {}, ValueError, r"the shape \(5, 5\)"),
        (np.ones((5, 5, 5), complex), {}, ValueError, "complex"),
    ):  # fmt: skip
        with pytest.raises(error, match=told):
            plotter.add_slices(source, **more)
    assert not plotter.actors
    assert not len(plotter.slices)


def test_images_of_pyvista_and_nibabel_lie_where_they_lie(plotter):
    image = pv.ImageData(dimensions=(4, 5, 6), spacing=(1, 2, 3), origin=(7, 8, 9))
    image["a"] = np.arange(120.0)
    found = as_slice_image(image)
    np.testing.assert_allclose(found.affine @ (1, 1, 1, 1), (8, 10, 12, 1))
    assert found.values[1, 2, 3, 0] == image["a"][1 + 4 * (2 + 5 * 3)]
    image = pv.ImageData(dimensions=(4, 5, 6))
    image.cell_data["b"] = np.arange(60.0)
    np.testing.assert_allclose(as_slice_image(image).affine[:3, 3], 0.5)
    again = as_slice_image(nib.Nifti1Image(np.ones((3, 4, 5), np.int16), SHEARED))
    np.testing.assert_allclose(again.affine, SHEARED)


def test_a_real_image_says_what_nibabel_says(plotter, shared_data):
    slices = plotter.add_slices(shared_data / "nv_MNI152_2009_template.nii.gz", interpolation="nearest")
    image = nib.load(shared_data / "nv_MNI152_2009_template.nii.gz")
    data = image.get_fdata()
    rng = np.random.default_rng(0)
    for voxel in rng.integers(0, data.shape, (20, 3)):
        position = nib.affines.apply_affine(image.affine, voxel)
        assert slices.values(position) == {"nv_MNI152_2009_template": data[tuple(voxel)]}


@pytest.mark.parametrize("add", ["add_slices", "workspace"])
def test_cleared_and_closed_plotters_leave_nothing_alive(add):
    plotter = pv.Plotter(off_screen=True, shape=(2, 2))
    slices = plotter.add_slices if add == "add_slices" else plotter.slices.workspace
    gone = weakref.ref(slices(np.ones((5, 5, 5))))
    if add == "add_slices":
        gone().position = 1.0, 1.0, 1.0
        plotter.show(auto_close=False)
        plotter.clear()
        assert list(plotter.slices) == []
        gone = weakref.ref(plotter.add_slices(np.ones((4, 4, 4))))
        assert list(plotter.slices) == [gone()]
    plotter.close()
    del slices, plotter
    gc.collect()
    assert gone() is None


def test_slices_have_a_scalar_bar(plotter):
    image = np.random.default_rng(0).random((6, 7, 8))
    bar = {"show_scalar_bar": True, "scalar_bar_args": {"title": "T1"}}
    stack = plotter.add_slices(image, cmap="hot", clim=(0.2, 0.7), **bar)
    table = plotter.scalar_bars["T1"].GetLookupTable()
    assert table.GetTableRange() == (0.2, 0.7)
    stack.layers[0].clim = 0.0, 3.0
    stack.layers[0].cmap = "viridis"
    assert table.GetTableRange() == (0.0, 3.0)
    np.testing.assert_array_equal(table.values, stack.layers[0].table())
    stack.remove()
    assert not plotter.scalar_bars.keys()
    plotter.add_slices(np.zeros((4, 4, 4), np.uint8), labels={1: ("one", "red")}, show_scalar_bar=True)
    assert not plotter.scalar_bars.keys()


def test_slices_are_moved_and_hidden_as_a_whole(plotter):
    image = np.random.default_rng(0).random((6, 7, 8))
    stack = plotter.add_slices(image, user_matrix=np.diag([2.0, 2.0, 2.0, 1.0]))
    bounds = np.array(plotter.bounds)
    np.testing.assert_allclose(bounds[1::2] - bounds[::2], [12.0, 14.0, 16.0], atol=1e-6)
    stack.user_matrix = None
    bounds = np.array(plotter.bounds)
    np.testing.assert_allclose(bounds[1::2] - bounds[::2], [6.0, 7.0, 8.0], atol=1e-6)
    second = plotter.add_slices(image, name=stack.name)  # takes its place
    assert list(plotter.slices) == [second]
    assert stack["axial"].actor not in plotter.actors.values()
    second.remove()
    second.remove()
    assert not plotter.actors
    stack = plotter.add_slices(image)
    stack.visibility = False
    assert not any(plane.actor.visibility for plane in stack)
    stack.visible = True
    assert all(plane.actor.visibility for plane in stack)
    with pytest.raises(AttributeError, match="slices have no 'opacity' to set: .*layers"):
        stack.opacity = 0.5


@pytest.fixture
def peaks():
    values = np.zeros((9, 10, 11, 6), np.float32)
    values[2:7, 3:8, 4:9, 0] = 1.0
    return values, np.diag([2.0, 2.0, 2.0, 1.0])


def test_glyphs_follow_the_slices_and_only_those_that_are_shown_are_made(plotter, peaks):
    slices = plotter.add_slices((peaks[0][..., 0], peaks[1]), position=(8.0, 10.0, 12.0))
    found = slices.add_glyphs(peaks)
    slices["coronal"].visible = slices["sagittal"].visible = False
    assert found.n_glyphs == 0
    plotter.show(auto_close=False)
    assert found.n_glyphs == 25
    slices.position = (8.0, 10.0, 2.0)
    plotter.render()
    assert found.n_glyphs == 0
    slices["sagittal"].visible = True
    plotter.render()
    assert found.n_glyphs == 25
    found.remove()
    assert len(plotter.actors) == 3


@pytest.mark.parametrize(("kind", "n"), [("peaks", 3), ("tensor", 6), ("sh", 6), ("sh", 45)])
def test_every_kind_is_seen_in_its_colour(plotter, kind, n):
    values = np.zeros((7, 7, 7, n))
    values[3, 3, 3, 0] = 1.0  # along x; of harmonics the same in all directions
    if kind == "tensor":
        values[3, 3, 3, 1:3] = 0.2
    slices = plotter.add_slices(np.zeros((7, 7, 7)), clim=(0, 1), planes="axial")
    slices.add_glyphs((values, np.eye(4)), kind, size=4.0, line_width=4)
    plotter.view_xy()
    plotter.show(auto_close=False)
    picture = plotter.screenshot(return_img=True).astype(int)
    if kind == "sh":
        assert (picture.max(axis=2) > 60).sum() > 1000
    else:
        red = (picture[..., 0] > 60) & (picture[..., 1:].max(axis=-1) < 40)
        assert 60 < red.sum() < 3000
        assert red[100].sum() > 60


def test_vectors_of_fsl_have_the_colours_and_lines_of_their_directions(plotter):
    """Right and front in the scanner's axes, on a grid whose first axis runs to the front."""
    affine = np.array([[0.0, 0, -2, 9], [2, 0, 0, 9], [0, 2, 0, 9], [0, 0, 0, 1]])  # i front, j up, k left
    assert np.linalg.det(affine[:3, :3]) < 0
    values = np.zeros((6, 6, 6, 3), np.float32)
    values[...] = np.array([0.6, 0.0, -0.8])
    made = {"kind": "direction", "planes": "axial", "interpolation": "nearest", "axes": "image"}
    slices = plotter.add_slices((values, affine), vectors="fsl", **made)
    assert set(map(tuple, slices.pixels(slices["axial"].grid).reshape(-1, 4).tolist())) == {(204, 153, 0, 255)}
    np.testing.assert_allclose(slices.values(slices.position)["image"], [0.8, 0.6, 0.0], atol=1e-6)
    np.testing.assert_array_equal(slices.layers[0].image.values, values)  # as it was given
    found = slices.add_glyphs((values, affine), vectors="fsl")
    mesh, n = found.mesh(slices.position, np.array([0.0, 0.0, 1.0]))
    ends = np.asarray(mesh.points).reshape(n, 2, 3)
    np.testing.assert_allclose(np.diff(ends, axis=1)[:, 0] / 2, np.tile([0.8, 0.6, 0.0], (n, 1)), atol=1e-6)
    with pytest.raises(ValueError, match="vectors is of direction-coded images, but kind is 'rgb'"):
        slices.add((values, affine), kind="rgb", vectors="fsl")
    with pytest.raises(ValueError, match="vectors is 'FSL'; choose"):
        slices.add_glyphs((values, affine), vectors="FSL")


def test_glyphs_of_other_numbers_are_refused(plotter, peaks):
    slices = plotter.add_slices((peaks[0][..., 0], peaks[1]))
    for arguments, said in (
        ({"kind": "tensors"}, "kind is"), ({"kind": "sh", "basis": "x"}, "basis is"), ({"size": 0}, "size is"),
        ({"kind": "tensor", "tensor": "x"}, "tensor is"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=said):
            slices.add_glyphs(peaks, **arguments)
    with pytest.raises(ValueError, match="peaks are three each"):
        slices.add_glyphs(peaks[0][..., :4])
    assert len(plotter.actors) == 3


def test_an_oblique_slice_is_where_its_widget_is(plotter):
    at = np.stack(np.mgrid[:20, :20, :20], axis=-1)
    slices = plotter.add_slices(at.sum(axis=-1).astype(np.float32), clim=(0, 57), planes=())
    plane = plotter.slices.add_oblique(normal=(1, 1, 1))
    assert np.ptp(slices.pixels(plane.grid)[..., 0][slices.pixels(plane.grid)[..., 3] > 0]) <= 8
    (widget,) = plotter.widgets.plane_widgets
    widget.SetOrigin(5.0, 5.0, 5.0)
    widget.SetNormal(0.0, 0.0, 1.0)
    widget.InvokeEvent("InteractionEvent")
    np.testing.assert_allclose(plane.normal, (0, 0, 1), atol=1e-9)
    np.testing.assert_allclose(plane.origin, (5, 5, 5))
    np.testing.assert_allclose(plane.grid.positions()[..., 2], 5.0, atol=1e-9)
    with pytest.raises(ValueError, match="another plane has"):
        plotter.slices.add_oblique()


def noisy_head(shape=(64, 72, 60)):
    """Return a head with dark ventricles in Rayleigh's noise, its neck on the lowest face, and where its tissue is."""
    rng = np.random.default_rng(0)
    i, j, k = np.mgrid[: shape[0], : shape[1], : shape[2]]
    inside = ((i - 32) / 24) ** 2 + ((j - 36) / 28) ** 2 + ((k - 34) / 22) ** 2 < 1.0
    inside |= ((i - 32) ** 2 + (j - 36) ** 2 < 100) & (k < 20)
    ventricles = (i - 32) ** 2 + (j - 36) ** 2 + (k - 34) ** 2 < 36
    signal = np.where(inside, 800.0, 0.0) * ~ventricles
    values = np.hypot(signal + rng.normal(0.0, 15.0, shape), rng.normal(0.0, 15.0, shape))
    return values.astype(np.float32), inside


@pytest.mark.parametrize("offset", [0.0, -1024.0], ids=["noise", "as of a CT"])
def test_the_outside_of_a_head_is_clear_in_the_3d_view_alone(plotter, offset):
    """Compared with the closed form of the head; its ventricles are as dark as the air and stay."""
    values, inside = noisy_head()
    slices = plotter.add_slices(values + offset, planes="axial", interpolation="nearest")
    plotter.show(auto_close=False)
    (layer,) = slices.layers
    assert 45.0 < layer.outside - offset < 200.0  # 3 standard deviations of the noise, and a quarter of the signal
    for k in (8, 34):  # through the neck, and the ventricles
        slices.position = 32, 36, k
        grid = slices["axial"].grid
        at = np.rint(grid.positions()).astype(int)
        wanted = inside[at[..., 0], at[..., 1], at[..., 2]]
        assert (slices.pixels(grid)[..., 3] == 255).all()  # as panes show it
        plotter.render()
        np.testing.assert_array_equal(slices["axial"].actor.pixels[..., 3] > 0, wanted)
    layer.outside = -np.inf
    plotter.render()
    assert (slices["axial"].actor.pixels[..., 3] == 255).all()
    layer.outside = offset + 900.0  # above all tissue
    plotter.render()
    assert not slices["axial"].actor.pixels.any()
    layer.outside = None
    assert layer.outside - offset < 200.0


def test_lines_are_seen_through_the_outside_of_a_head(plotter):
    values, _ = noisy_head()
    plotter.add_slices(values, planes="coronal")
    line = pv.Line((2, 70, 56), (2, 70, 2))  # behind the plane, beside the head
    plotter.add_mesh(line, color="red", line_width=3, lighting=False)
    plotter.view_xz()
    red = plotter.screenshot()[..., 0].astype(int) - plotter.screenshot()[..., 1]
    assert (red > 200).sum() > 100


def test_images_without_an_outside_are_shown_whole():
    rng = np.random.default_rng(0)
    assert SliceImage(rng.random((9, 9, 9, 1)), np.eye(4)).outside() is None
    signed = rng.normal(size=(32, 32, 32, 1))  # a map of statistics: nothing around it is dark
    signed[[0, 1, -1, -2]] = signed[:, [0, 1, -1, -2]] = signed[:, :, [0, 1, -1, -2]] = 0.0
    assert SliceImage(signed, np.eye(4)).outside() is None
    assert SliceImage(np.full((4, 4, 4, 1), np.nan), np.eye(4)).outside() is None


def test_colours_and_directions_have_an_outside_too(plotter):
    ball = (np.stack(np.mgrid[-8:9, -8:9, -8:9], axis=-1) ** 2).sum(axis=-1) < 36
    rgb = np.where(ball, 200, 0).astype(np.uint8)[..., None].repeat(3, axis=-1)
    vectors = np.where(ball[..., None], (0.0, 0.6, 0.8), 0.0)
    fa = np.where(ball, 0.7, 0.01)
    for source, options in ((rgb, {}), (vectors, {"kind": "direction"}), (vectors, {"modulate": fa})):
        slices = plotter.add_slices(source, planes="sagittal", interpolation="nearest", name="one", **options)
        plotter.show(auto_close=False)
        plotter.render()
        grid = slices["sagittal"].grid
        at = np.rint(grid.positions()).astype(int)
        np.testing.assert_array_equal(
            slices["sagittal"].actor.pixels[..., 3] > 0, ball[at[..., 0], at[..., 1], at[..., 2]]
        )
