"""Colours from a volume are those that NumPy finds in it at the streamlines' points."""

from __future__ import annotations

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv

from .test_colours import FLAT, close_to, mapped

RAMP = np.fromfunction(lambda i, j, k: i + 0.0 * j + 0.0 * k, (41, 5, 5))
PLACE = np.array([[0.5, 0, 0, -10], [0, 20, 0, -40], [0, 0, 20, -40], [0, 0, 0, 1.0]])
"""Voxel i lies at x = i / 2 - 10 mm: the value there is 2 x + 20."""


def image_of(values=RAMP, affine=PLACE, cells=False, rgb=None):
    """The same volume as VTK has it, its indices not starting at zero."""
    axes = affine[:3, :3] / np.linalg.norm(affine[:3, :3], axis=0)
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    extent = [end for n in values.shape for end in (3, n + 2 + cells)]
    image = pv.ImageData(spacing=spacing, direction_matrix=axes)
    image.extent = extent
    image.origin = affine[:3, 3] - affine[:3, :3] @ (np.full(3, 3.0) + (0.5 if cells else 0.0))
    (image.cell_data if cells else image.point_data)["fa"] = values.ravel(order="F")
    image.set_active_scalars("fa")
    if rgb is not None:
        image["rgb"] = rgb
        image.set_active_scalars("rgb")
    return image


@pytest.fixture
def line():
    """From x = -15 to 15 mm, beyond both ends of the ramp."""
    return np.linspace((-15, 0, 0), (15, 0, 0), 241)


def row_of(plotter):
    """Brightness along the line, a pixel a number, and x in mm of each pixel's centre."""
    plotter.camera_position = [(0, 0, 100), (0, 0, 0), (0, 1, 0)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 20.0
    picture = plotter.screenshot(None)
    width, height = plotter.window_size
    return picture[height // 2].astype(int), (np.arange(width) + 0.5) * 40.0 / width - 20.0


def source_of(kind, tmp_path):
    if kind == "image":
        return image_of()
    if kind == "cells":
        return image_of(cells=True)
    if kind == "array":
        return RAMP, PLACE
    image = nib.Nifti1Image(RAMP.astype(np.float32)[..., None], PLACE)
    if kind == "nibabel":
        return image
    path = tmp_path / "ramp.nii.gz"
    nib.save(image, path)
    return str(path) if kind == "text" else path


@pytest.mark.few(3)
@pytest.mark.parametrize("kind", ["image", "cells", "array", "nibabel", "text", "path"])
def test_a_ramp_runs_through_the_colour_map(plotter, line, kind, tmp_path):
    actor = plotter.add_fiblets([line], scalars=source_of(kind, tmp_path), cmap="gray", nan_color="red", **FLAT)
    assert actor.clim == (0.0, 40.0)
    colours, x = row_of(plotter)
    inside, outside = abs(x) < 9.9, (abs(x) > 10.5) & (abs(x) < 14.5)
    # Where fiblets join, a round brush of 5 pixels (1 mm) shows its end's value half a width further on.
    assert np.abs(colours[inside][:, 0] - (2 * x[inside] + 20) / 40 * 255).max() < 7
    assert (colours[outside] == (255, 0, 0)).all()


def test_it_moves_with_the_actor_and_can_be_set_later(plotter, line):
    actor = plotter.add_fiblets([line], color="blue", **FLAT)
    actor.user_matrix = np.diag([0.5, 1, 1, 1]) + np.array([[0, 0, 0, 2.0]] + [[0] * 4] * 3)
    actor.scalars = RAMP, PLACE
    actor.cmap = "gray"
    colours, x = row_of(plotter)
    data = (x - 2) / 0.5
    inside = abs(data) < 9.5
    assert np.abs(colours[inside][:, 0] - (2 * data[inside] + 20) / 40 * 255).max() < 13
    assert actor.copy().scalars is actor.scalars


def test_labels_keep_their_colours(plotter, line, colours_in):
    labels = (RAMP // 14).astype(np.uint8)  # 0, 1, 2
    plotter.add_fiblets([line[60:180]], scalars=(labels, PLACE), cmap="viridis", categories=True, **FLAT)
    row_of(plotter)
    assert close_to(colours_in(plotter.screenshot(None)), {mapped("viridis", f, 3) for f in (0.0, 0.5, 1.0)})


@pytest.mark.parametrize("scalars", [[3.0, 3.0, 9.0], np.repeat([2.0, 2.0, 5.0], 41)])
def test_categories_are_counted(plotter, three_lines, scalars, colours_in):
    actor = plotter.add_fiblets(three_lines, scalars=scalars, cmap="viridis", categories=True, **FLAT)
    assert actor.lookup_table.n_values == 2
    plotter.view_vector((1, 0.4, 0.7))
    assert close_to(colours_in(plotter.screenshot(None)), {mapped("viridis", f, 2) for f in (0.0, 1.0)}, tolerance=4)
    actor.categories = False
    assert actor.lookup_table.n_values == 256


def test_a_logarithmic_scale_and_a_bar(plotter, line):
    values = 10.0 ** (RAMP / 20) - 1.0  # from 0 to 99
    actor = plotter.add_fiblets([line], scalars=image_of(values), log_scale=True, lighting=False)
    assert actor.clim == pytest.approx((10**0.05 - 1, 99.0))
    assert list(plotter.scalar_bars.keys()) == ["fa"]
    plotter.screenshot(None)


def test_a_volume_of_nothing_but_nan_still_draws(plotter, line, colours_in):
    plotter.add_fiblets([line], scalars=(np.full((3, 3, 3), np.nan), np.eye(4)), nan_color="red", **FLAT)
    row_of(plotter)
    assert colours_in(plotter.screenshot(None)) == {(255, 0, 0)}


@pytest.mark.parametrize(
    ("scalars", "message"),
    [
        (lambda: (np.zeros((3, 3, 3, 2)), np.eye(4)), r"shape \(3, 3, 3, 2\)"),
        (lambda: nib.Nifti1Image(np.zeros((4, 5, 6, 7), np.float32), np.eye(4)), r"shape \(4, 5, 6, 7\)"),
        (lambda: (np.zeros((3, 3, 3)), np.eye(3)), r"\(4, 4\) matrix"),
        (lambda: pv.ImageData(dimensions=(3, 3, 3)), "no active scalars"),
        (lambda: image_of(np.ones((3, 3, 3)), rgb=np.zeros((27, 3))), "3 numbers per voxel"),
    ],
)
def test_nonsense_is_refused_in_words(plotter, line, scalars, message):
    with pytest.raises(ValueError, match=message):
        plotter.add_fiblets([line], scalars=scalars())
    with pytest.raises(FileNotFoundError, match=r"nothing\.nii"):
        plotter.add_fiblets([line], scalars="/nowhere/nothing.nii")
    assert not plotter.actors
