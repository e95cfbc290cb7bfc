"""What ``add_volume`` calls otherwise, and what it takes: blending, resolution, uneven grids."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
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


@pytest.mark.parametrize("word", ["minimum", "average"])
def test_they_look_as_in_add_volume(noise, word):
    pictures = []
    for add in ("add_raycast_volume", "add_volume"):
        plotter = pv.Plotter(off_screen=True, window_size=(80, 60))
        plotter.set_background("black")
        more = {"step": 0.2} if add == "add_raycast_volume" else {"mapper": "gpu"}
        opacity = np.full(256, 255, np.uint8)
        shown = getattr(plotter, add)(noise.copy(), blending=word, clim=(0, 1), cmap="gray", opacity=opacity,
                                      show_scalar_bar=False, **more)  # fmt: skip
        if add == "add_volume":
            shown.mapper.SetAutoAdjustSampleDistances(0)
            shown.mapper.SetSampleDistance(0.2)
            shown.prop.interpolation_type = "linear"
        plotter.camera_position = "yz"
        pictures.append(np.array(plotter.screenshot(return_img=True))[20:40, 30:50, 0].astype(int))
        plotter.close()
    assert np.abs(pictures[0] - pictures[1]).mean() < 4
    assert pictures[1].mean() > 3


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


def test_words_that_contradict_or_have_no_meaning(plotter, noise):
    for words, message in (
        ({"blending": "maximum", "mode": "mip"}, "give one of the two"),
        ({"blending": "additive"}, "mode 'average'"),
        ({"blending": "sum"}, "choose one of"),
        ({"resolution": 2.0, "spacing": 2.0}, "give one of the two"),
    ):
        with pytest.raises(ValueError, match=message):
            plotter.add_raycast_volume(noise, **words)
    actor = plotter.add_raycast_volume(np.zeros((3, 4, 5)), resolution=(1, 2, 3))
    assert np.allclose(actor.volume.spacing, (1, 2, 3))


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
