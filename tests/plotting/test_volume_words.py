"""What ``add_volume`` calls otherwise, and what it takes: blending, uneven grids, thin images, dense light."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from pyvista.plotting.tools import opacity_transfer_function
from scipy.interpolate import RegularGridInterpolator

from pvfiblets.volumes import as_raycast_volume

N = 24


@pytest.fixture
def noise():
    image = pv.ImageData(dimensions=(N, N, N))
    values = np.random.default_rng(3).random((N, N, N)).astype(np.float32)
    image["values"] = values.ravel(order="F")
    return image


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=(80, 60))
    plotter.set_background("black")
    yield plotter
    plotter.close()


def seen(plotter, actor, pixels):
    plotter.camera_position = "yz"
    plotter.show(auto_close=False)
    plotter.render()
    return [actor.pick_at(*pixel) for pixel in pixels]


PIXELS = [(40, 30), (35, 34), (45, 25)]


def along(image, hits, plotter):
    """Values at even distances along the rays of some hits, by SciPy."""
    x = np.arange(float(N))
    values = np.array(image["values"]).reshape(N, N, N, order="F")
    field = RegularGridInterpolator((x, x, x), values)
    eye = np.array(plotter.camera.position)
    for hit in hits:
        way = (hit.position - eye) / np.linalg.norm(hit.position - eye)
        far = np.linspace(0.0, 200.0, 8001)[:, None]
        places = eye + far * way
        yield field(places[((places >= 0) & (places <= N - 1)).all(axis=1)])


@pytest.mark.parametrize(("word", "mode"), [("maximum", "mip"), ("minimum", "minimum"), ("average", "average")])
def test_projections_are_those_of_a_fine_sum(plotter, noise, word, mode):
    actor = plotter.add_raycast_volume(noise, blending=word, step=0.05, opacity=1.0)
    assert actor.mode == mode
    hits = seen(plotter, actor, PIXELS)
    of = {"maximum": np.max, "minimum": np.min, "average": np.mean}[word]
    for hit, values in zip(hits, along(noise, hits, plotter), strict=True):
        assert hit.value == pytest.approx(of(values), abs=6e-3)


def test_thresholds_and_cuts_and_the_octree(plotter, noise):
    actor = plotter.add_raycast_volume(noise, mode="minimum", step=0.05, opacity=1.0, thresholds=(0.2, None))
    hits = seen(plotter, actor, PIXELS)
    for hit, values in zip(hits, along(noise, hits, plotter), strict=True):
        assert hit.value == pytest.approx(values[values >= 0.2].min(), abs=6e-3)
    whole = [hit.value for hit in hits]
    actor.octree = False
    assert [hit.value for hit in seen(plotter, actor, PIXELS)] == whole
    actor.mode, actor.thresholds = "average", None
    actor.clip(pv.Sphere(radius=8, center=(11.5, 11.5, 11.5)))
    assert all(0.35 < hit.value < 0.65 for hit in seen(plotter, actor, PIXELS))


def test_uneven_grids_are_interpolated():
    x, y, z = np.array([0.0, 1.0, 1.5, 4.0]), np.linspace(-1, 1, 5), np.array([2.0, 2.25, 3.0])
    values = np.random.default_rng(0).random((4, 5, 3))
    grid = pv.RectilinearGrid(x, y, z)
    grid["values"] = values.ravel(order="F")
    volume = as_raycast_volume(grid)
    assert volume.shape == (9, 5, 5)
    at = np.stack(np.meshgrid(*[np.arange(n) for n in volume.shape], indexing="ij"), axis=-1) * volume.spacing
    right = RegularGridInterpolator((x, y, z), values)(at + [0.0, -1.0, 2.0])
    assert np.abs(volume.values - right).max() < 1e-6
    assert np.allclose(volume.bounds, grid.bounds)


def test_even_ones_keep_their_numbers_and_others_are_bounded():
    axis = np.linspace(0, 3, 4)
    grid = pv.RectilinearGrid(axis, axis, axis)
    grid["values"] = np.arange(64, dtype=np.uint8)
    assert as_raycast_volume(grid).values.dtype == np.uint8
    fine = pv.RectilinearGrid(np.array([0.0, 1e-6, 1.0, 2.0]), axis, axis)
    fine["values"] = np.arange(64.0)
    assert as_raycast_volume(fine).shape == (16, 4, 4)
    folded = pv.RectilinearGrid(np.array([0.0, 2.0, 1.0, 3.0]), axis, axis)
    folded["values"] = np.arange(64.0)
    with pytest.raises(ValueError, match="x coordinates do not increase"):
        as_raycast_volume(folded)


def shown(plotter):
    plotter.camera_position = "iso"
    plotter.show(auto_close=False)
    plotter.render()
    return np.array(plotter.screenshot(return_img=True)).astype(int)


def test_a_time_series_is_updated_in_place_or_by_other_sources(plotter, noise):
    right = pv.Plotter(off_screen=True, window_size=(80, 60))
    right.set_background("black")
    later = noise.copy()
    later["values"] = 0.3 * np.array(noise["values"])
    look = {"clim": (0, 1), "cmap": "hot", "show_scalar_bar": False}
    right.add_raycast_volume(later, **look)
    expected = shown(right)
    right.close()
    actor = plotter.add_raycast_volume(noise, scalars="values", **look)
    first = shown(plotter)
    noise["values"][:] *= 0.3
    actor.update()
    assert np.abs(shown(plotter) - expected).max() <= 1
    noise["values"][:] /= 0.3
    actor.update(noise.copy())
    assert np.abs(shown(plotter) - first).max() <= 1
    actor.update(np.asarray(later["values"]).reshape(N, N, N, order="F"), scalars=None)
    assert np.abs(shown(plotter) - expected).max() <= 1
    with pytest.raises(ValueError, match="no voxels"):
        actor.update(np.zeros((0, 4, 4)), scalars=None)
    assert np.abs(shown(plotter) - expected).max() <= 1


def test_other_names_of_add_volume(plotter, noise):
    actor = plotter.add_raycast_volume(noise, colormap="bone", rng=(0, 2), categories=5)
    assert (actor.cmap, actor.clim, actor.n_colors) == ("bone", (0, 2), 5)
    labels = pv.ImageData(dimensions=(3, 3, 3))
    labels["a"] = np.arange(27) % 3
    labels.cell_data["a"] = np.full(8, 9.0)
    assert plotter.add_raycast_volume(labels, scalars="a", categories=True).n_colors == 3
    assert plotter.add_raycast_volume(labels, scalars="a", preference="cell", clim=(0, 9)).volume.value_range == (9, 9)
    for words, message in (
        ({"mapper": "gpu"}, "mapper of add_volume chooses among VTK's"),
        ({"culling": "back"}, "culling of add_volume"),
        ({"preference": "row"}, "preference is 'row'"),
    ):
        with pytest.raises(ValueError, match=message):
            plotter.add_raycast_volume(noise, **words)


def test_a_table_of_opacities_is_taken(plotter, noise):
    table = pv.LookupTable("viridis", scalar_range=(0.2, 0.8))
    table.apply_opacity([0, 0.2, 0.8])
    alpha = plotter.add_raycast_volume(noise, cmap=table).casting.transfer.table[:, 3]
    assert np.allclose(alpha, table.values[:, 3] / 255)
    assert np.allclose(plotter.add_raycast_volume(noise, cmap=table, opacity=0.5).casting.transfer.table[:, 3], 0.5)
    plain = pv.LookupTable("viridis", scalar_range=(0.2, 0.8))
    alpha = plotter.add_raycast_volume(noise, cmap=plain).casting.transfer.table[:, 3]
    assert np.allclose(alpha, np.linspace(0, 1, 256), atol=3e-3)


def test_one_value_that_does_not_show_is_told(plotter):
    flat = np.full((4, 4, 4), 7.0)
    with pytest.warns(UserWarning, match="all voxels have the value 7, where opacity is 0"):
        plotter.add_raycast_volume(flat)
    plotter.add_raycast_volume(flat, opacity=0.5)
    plotter.add_raycast_volume(flat, clim=(0, 10))
    plotter.add_raycast_volume(flat, mode="isosurface", values=3.0)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_slice_is_as_thick_as_its_voxels(axis):
    shape = np.insert([5, 4], axis, 1)
    numbers = np.arange(20.0).reshape(shape)
    image = pv.ImageData(dimensions=shape, spacing=(2.0, 3.0, 4.0), origin=(7.0, 8.0, 9.0))
    image["n"] = numbers.ravel(order="F")
    volume = as_raycast_volume(image)
    np.testing.assert_array_equal(volume.values, np.repeat(numbers, 2, axis))
    middle = np.array(volume.bounds).reshape(-1, 2).mean(axis=1) if np.ndim(volume.bounds) == 1 else None
    assert middle is None or middle[axis] == pytest.approx(image.center[axis])
    first, last = (volume.affine @ np.append(place, 1.0) for place in (np.zeros(3), np.array(volume.shape) - 1))
    np.testing.assert_allclose((first + last)[:3] / 2.0, image.center)
    assert (last - first)[axis] == pytest.approx(image.spacing[axis])


def test_its_values_are_seen(plotter):
    """From above, along y as many of one colour: the numbers rise along x."""
    image = pv.ImageData(dimensions=(20, 20, 1))
    image["n"] = image.points[:, 0]
    plotter.add_raycast_volume(image, cmap=["red", "blue"], n_colors=2, opacity=1.0, show_scalar_bar=False)
    plotter.view_xy()
    picture = plotter.screenshot(None)[30]
    seen = np.flatnonzero(picture.any(axis=1))
    first, last = picture[seen[3]], picture[seen[-3]]
    assert first[0] > 200 > 50 > first[2]
    assert last[2] > 200 > 50 > last[0]


def test_bytes_of_four_are_colours():
    volume = as_raycast_volume(np.full((3, 3, 1, 4), 200, np.uint8))
    assert volume.colours is not None
    assert volume.shape == volume.colours.shape[:3] == (3, 3, 2)


N_RAMP = 30


def ramp(spacing):
    image = pv.ImageData(dimensions=(N_RAMP, N_RAMP, N_RAMP), spacing=spacing)
    values = np.broadcast_to(np.linspace(0, 1, N_RAMP)[:, None, None], (N_RAMP, N_RAMP, N_RAMP)).astype(np.float32)
    image["values"] = values.ravel(order="F")
    return image


def shot_of(add, view="xy"):
    plotter = pv.Plotter(off_screen=True, window_size=(90, 90))
    plotter.set_background("black")
    add(plotter)
    plotter.camera_position = view
    plotter.enable_parallel_projection()
    picture = np.array(plotter.screenshot(return_img=True))[..., 0].astype(int)
    plotter.close()
    return picture


def both(image, opacity, view="xy", **look):
    look = {"clim": (0, 1), "cmap": ["white", "white"], "show_scalar_bar": False, **look}

    def theirs(plotter):
        volume = plotter.add_volume(image.copy(), mapper="gpu", opacity=opacity, **look)
        volume.mapper.SetAutoAdjustSampleDistances(0)
        volume.mapper.SetSampleDistance(0.25 * min(image.spacing))
        volume.mapper.SetUseJittering(0)
        volume.prop.interpolation_type = "linear"

    # PyVista lays parabolas through lists, ours are linear: its own table makes both the same.
    table = (
        opacity
        if isinstance(opacity, str)
        else opacity_transfer_function(opacity, 256, kind="linear" if len(opacity) < 3 else "quadratic")
    )
    return shot_of(lambda p: p.add_raycast_volume(image, opacity=table, **look), view), shot_of(theirs, view)


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("opacity", "unit", "spacing", "view"),
    [("linear", 1.0, (1, 1, 1), "xy"), ("linear", 10.0, (1, 1, 1), "xz"), ("sigmoid", 20.0, (1, 1, 1), "xy"),
     ("geom", 5.0, (0.5, 0.5, 0.5), "xy"), ([0, 0.5], 10.0, (1, 1, 2.5), "xz"), ([0, 0, 1], 10.0, (1, 1, 1), "xy"),
     ([0, 0.2, 0.2, 0.1], 5.0, (1, 1, 1), "xy")],
)  # fmt: skip
def test_a_table_looks_as_dense_as_in_add_volume(opacity, unit, spacing, view):
    ours, theirs = both(ramp(spacing), opacity, view, opacity_unit_distance=unit)
    there = theirs > 2
    assert there.mean() > 0.05
    # PyVista's tables are cut off to bytes, of which one is much in thin fog.
    assert np.abs(ours - theirs)[there].mean() < 5
    assert abs(ours[there].mean() - theirs[there].mean()) < 3
