"""Shading of light through volumes against VTK's own volume mapper, and where there is no gradient."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

N = 40
OPACITY = np.clip((np.linspace(0, 1, 256) - 0.25) * 3, 0, 0.6)
LOOK = {
    "cmap": "viridis", "clim": (0, 1), "opacity_unit_distance": 1.0, "shade": True, "show_scalar_bar": False,
    "specular_power": 10.0,
}  # fmt: skip

LIGHTS = {
    "beside": {"position": (1000, 200, 500), "focal_point": (20, 20, 20)},
    "behind": {"position": (-1000, -200, -500), "focal_point": (20, 20, 20)},
    "near": {"position": (75, 40, 60), "focal_point": (20, 20, 20), "positional": True, "cone_angle": 90},
    "the eye's": {"light_type": "headlight"},
    "a spot": {"position": (75, 40, 60), "focal_point": (20, 25, 20), "positional": True, "cone_angle": 12},
}


def bulge():
    x = np.linspace(-1, 1, N)
    at = np.stack(np.meshgrid(x, x, x, indexing="ij"), axis=-1)
    ball = np.clip(1.15 - np.linalg.norm(at, axis=-1) / 0.8, 0, 1)
    field = ball + 0.6 * np.exp(-(((at - [0.3, -0.5, 0.3]) ** 2).sum(axis=-1)) * 40)
    image = pv.ImageData(dimensions=field.shape)
    image["values"] = (field / field.max()).astype(np.float32).ravel(order="F")
    return image


def shot(add, lights, azimuth=30.0):
    plotter = pv.Plotter(off_screen=True, window_size=(120, 120), lighting="none")
    plotter.set_background("black")
    for light in lights:
        plotter.add_light(pv.Light(**{"light_type": "scene light", **LIGHTS[light]}))
    add(plotter)
    plotter.camera_position = "xy"
    plotter.camera.azimuth, plotter.camera.elevation = azimuth, 20.0
    plotter.camera.zoom(1.8)
    picture = np.array(plotter.screenshot(return_img=True)).astype(float)
    plotter.close()
    return picture


def ours(image, **look):
    return lambda plotter: plotter.add_raycast_volume(image, **{**LOOK, "opacity": OPACITY, **look})


def vtks(image, **look):
    def add(plotter):
        volume = plotter.add_volume(image.copy(), mapper="gpu", **{**LOOK, "opacity": 255 * OPACITY, **look})
        volume.mapper.SetAutoAdjustSampleDistances(0)
        volume.mapper.SetSampleDistance(0.25)
        volume.mapper.SetUseJittering(0)

    return add


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("lights", "reflection"),
    [
        (["beside"], (0.0, 1.0, 0.0)),
        (["behind"], (0.0, 0.7, 0.0)),
        (["near"], (0.0, 1.0, 0.0)),
        (["a spot", "behind"], (0.0, 0.8, 0.0)),
        (["beside", "near"], (0.0, 0.3, 0.3)),
        (["the eye's"], (0.5, 0.0, 0.0)),  # of other lights VTK takes an ambient colour, which they lack
    ],
)
def test_light_is_shaded_as_vtk_shades_it(lights, reflection):
    look = dict(zip(("ambient", "diffuse", "specular"), reflection, strict=True))
    image = bulge()
    found, right = shot(ours(image, **look), lights), shot(vtks(image, **look), lights)
    there = right.max(axis=-1) > 3
    assert there.mean() > 0.2
    assert np.abs(found - right)[there].mean() < (5.0 if reflection[2] else 2.5)
    assert np.quantile(np.abs(found - right)[there], 0.99) < (32 if reflection[2] else 16)
    plain = shot(ours(image, shade=False), lights)
    assert np.abs(plain - right)[there].mean() > 15


def test_without_a_gradient_light_has_its_own_colours():
    """VTK leaves such parts black but for the ambient share; noise of a thousandth casts no shadows either."""
    image = bulge()
    for level, noise in ((0.6, 0.0), (0.6, 1e-3)):
        values = level + noise * np.random.default_rng(0).random(N**3)
        image["values"] = values.astype(np.float32)
        lit, plain = (shot(ours(image, shade=shade), ["beside"]) for shade in (True, False))
        assert plain.max() > 60
        assert np.abs(lit - plain).max() <= (1 if noise == 0.0 else 6)


def test_a_matrix_of_the_actor_turns_the_gradients():
    """A volume and its mirror image show the same where the matrix takes one to the other."""
    image = bulge()
    flipped = image.copy()
    flipped["values"] = image["values"].reshape(N, N, N)[:, :, ::-1].ravel()
    matrix = np.diag([-1.0, 1.0, 1.0, 1.0])
    matrix[0, 3] = N - 1.0
    found = shot(ours(flipped, user_matrix=matrix, specular=0.3), ["beside", "near"])
    assert np.abs(found - shot(ours(image, specular=0.3), ["beside", "near"])).max() <= 4


def test_it_is_a_live_setting():
    plotter = pv.Plotter(off_screen=True, window_size=(60, 60))
    with pytest.warns(UserWarning, match=r"ambient=0\.1 changes nothing in mode 'composite': set actor\.shade"):
        actor = plotter.add_raycast_volume(bulge(), ambient=0.1)
    assert not actor.shade
    before = np.array(plotter.screenshot(return_img=True)).astype(int)
    actor.shade = True
    actor.specular, actor.specular_power = 0.4, 20.0
    assert (actor.prop.ambient, actor.prop.specular) == (0.1, 0.4)
    plotter.render()
    assert np.abs(np.array(plotter.screenshot(return_img=True)).astype(int) - before).max() > 10
    assert actor.copy().shade
    assert "VOLUME_SHADED" in actor.explain()["features"]
    with pytest.raises(ValueError, match="specular"):
        actor.specular = -1.0
    plotter.close()
