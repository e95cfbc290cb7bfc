"""How dense light looks beside ``add_volume``: the same table at the same unit distance looks the same."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from pyvista.plotting.tools import opacity_transfer_function

N = 30


def ramp(spacing):
    image = pv.ImageData(dimensions=(N, N, N), spacing=spacing)
    values = np.broadcast_to(np.linspace(0, 1, N)[:, None, None], (N, N, N)).astype(np.float32)
    image["values"] = values.ravel(order="F")
    return image


def shot(add, view="xy"):
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
    return shot(lambda p: p.add_raycast_volume(image, opacity=table, **look), view), shot(theirs, view)


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("opacity", "unit", "spacing", "view"),
    [
        ("linear", 1.0, (1, 1, 1), "xy"),
        ("linear", 10.0, (1, 1, 1), "xz"),
        ("sigmoid", 20.0, (1, 1, 1), "xy"),
        ("geom", 5.0, (0.5, 0.5, 0.5), "xy"),
        ([0, 0.5], 10.0, (1, 1, 2.5), "xz"),
        ([0, 0, 1], 10.0, (1, 1, 1), "xy"),
        ([0, 0.2, 0.2, 0.1], 5.0, (1, 1, 1), "xy"),
    ],
)
def test_a_table_looks_as_dense_as_in_add_volume(opacity, unit, spacing, view):
    ours, theirs = both(ramp(spacing), opacity, view, opacity_unit_distance=unit)
    there = theirs > 2
    assert there.mean() > 0.05
    # PyVista's tables are cut off to bytes, of which one is much in thin fog.
    assert np.abs(ours - theirs)[there].mean() < 5
    assert abs(ours[there].mean() - theirs[there].mean()) < 3


def test_the_unit_of_add_volume_makes_defaults_alike():
    """PyVista's default is the diagonal over the mean number of cells; ours is the mean spacing of voxels."""
    image = ramp((1, 1, 1))
    theirs = image.length / (np.mean(image.dimensions) - 1)
    assert theirs == pytest.approx(np.sqrt(3.0))
    plotter = pv.Plotter(off_screen=True)
    assert plotter.add_raycast_volume(image).opacity_unit_distance == 1.0
    plotter.close()
    ours, default = both(image, "geom")
    alike, _ = both(image, "geom", opacity_unit_distance=theirs)
    assert np.abs(alike - default).mean() < 0.5 * np.abs(ours - default).mean()
