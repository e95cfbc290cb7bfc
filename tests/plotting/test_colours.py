"""The colours on the screen are those of matplotlib's maps, of arithmetic, and of volumes at the points."""

from __future__ import annotations

import matplotlib as mpl
import nibabel as nib
import numpy as np
import pytest
import pyvista as pv

from pvfiblets.streamlines import Streamlines

FLAT = {"lighting": False, "line_width": 5.0, "show_scalar_bar": False}


def mapped(cmap, fraction, n_colors=256):
    """One colour of a matplotlib map, as VTK's table of ``n_colors`` has it."""
    entry = min(int(fraction * n_colors), n_colors - 1)
    parts = mpl.colormaps[cmap].resampled(n_colors)(entry)[:3]
    return tuple(round(255 * part) for part in parts)


@pytest.fixture
def shown(colours_in):
    """Return a function: the colours that a plotter shows from aslant."""

    def colours(plotter):
        plotter.view_vector((1, 0.4, 0.7))
        return colours_in(plotter.screenshot(None))

    return colours


def close_to(found, wanted, tolerance=2):
    """Whether each colour has a partner in the other set within ``tolerance`` of 255."""
    found, wanted = np.array(sorted(found), int), np.array(sorted(wanted), int)
    distance = np.abs(found[:, None] - wanted[None]).max(axis=2)
    return distance.min(axis=1).max() <= tolerance and distance.min(axis=0).max() <= tolerance


BYTES = np.array([[255, 0, 0], [20, 200, 40], [250, 250, 5]])


@pytest.mark.parametrize(
    ("arguments", "wanted"),
    [
        ({}, [(255, 0, 0), (0, 255, 0), (0, 0, 255)]),  # the absolute direction
        ({"color": "orange"}, [pv.Color("orange").int_rgb]),
        ({"scalars": BYTES.astype(np.uint8)}, BYTES.tolist()),
        ({"scalars": BYTES / 255.0}, BYTES.tolist()),
        ({"scalars": "weight", "cmap": "plasma", "clim": (0, 100)}, [mapped("plasma", f) for f in (0.01, 0.1, 1.0)]),
        ({"scalars": "weight", "cmap": "plasma", "log_scale": True}, [mapped("plasma", f) for f in (0.0, 0.5, 1.0)]),
        ({"scalars": [0.0, 0.4, 1.0], "n_colors": 4}, [mapped("viridis", f, 4) for f in (0.0, 0.4, 1.0)]),
        ({"scalars": np.repeat([0.0, 0.5, 1.0], 41)}, [mapped("viridis", f) for f in (0.0, 0.5, 1.0)]),
        ({"scalars": [np.nan, -5.0, 5.0], "clim": (0, 1), "nan_color": "magenta", "below_color": "cyan",
          "above_color": "yellow"}, [(255, 0, 255), (0, 255, 255), (255, 255, 0)]),
        ({"scalars": [np.nan] * 3, "nan_color": "red"}, [(255, 0, 0)]),
    ],
    ids=["direction", "one", "bytes", "floats", "numbers", "log", "few", "points", "outside", "nan"],
)  # fmt: skip
def test_colours_are_those_of_the_numbers(plotter, three_lines, shown, arguments, wanted):
    plotter.add_fiblets(three_lines, **{"cmap": "viridis", **arguments}, **FLAT)
    assert close_to(shown(plotter), set(map(tuple, wanted)), tolerance=4)


@pytest.mark.parametrize("scalars", ["height", "arc_length"])
def test_values_along_a_line_run_through_the_colour_map(plotter, three_lines, scalars):
    plotter.add_fiblets(three_lines, scalars=scalars, cmap="gray", **FLAT)
    plotter.view_xy()
    picture = plotter.screenshot(None).max(axis=2)
    rows = np.flatnonzero((picture > 0).sum(axis=1) > 60)  # the line along x
    values = picture[rows[len(rows) // 2]]
    inside = np.flatnonzero(values)
    run = values[inside[0] : inside[-1]].astype(int)
    expected = np.linspace(run[0], 255, len(run))
    assert np.abs(run - expected).max() < 12


@pytest.mark.parametrize(
    ("arguments", "message"),
    [({"scalars": [1.0, 2.0]}, "expected 3 numbers, one per streamline"),
     ({"scalars": np.zeros((3, 2)), "rgb": True}, "2 columns"),
     ({"scalars": np.full((3, 3), 7.0), "rgb": True}, "between 0 and 1"),
     ({"scalars": "weight", "clim": (2, 1)}, "the low one first"),
     ({"scalars": "weight", "clim": "wide"}, "clim is 'wide'"),
     ({"scalars": "weight", "clim": (0, 1), "log_scale": True}, "above zero"),
     ({"scalars": "weight", "n_colors": 0}, "n_colors is 0"), ({"opacity": 1.5}, "opacity is 1.5"),
     ({"line_width": 0}, "line_width is 0"), ({"line_width": "x"}, "line_width is 'x'; give .* above 0")],
)  # fmt: skip
def test_nonsense_is_refused_in_words(plotter, three_lines, arguments, message):
    with pytest.raises(ValueError, match=message):
        plotter.add_fiblets(three_lines, **arguments)
    with pytest.raises(KeyError, match=r"no array 'fa'.*'weight'.*'curvature'"):
        plotter.add_fiblets(three_lines, scalars="fa")
    assert not plotter.actors


def test_no_streamlines_and_equal_values_are_drawn_too(plotter, three_lines, colours_in):
    with pytest.warns(UserWarning, match="no streamlines"):
        plotter.add_fiblets(Streamlines(np.zeros((0, 3)), [0]), scalars="length", show_scalar_bar=False)
    assert not colours_in(plotter.screenshot(None))
    plotter.add_fiblets(three_lines, scalars=[7.0, 7.0, 7.0], **FLAT)
    plotter.render()
    assert len(colours_in(plotter.screenshot(None))) == 1


WRONG = {
    "clim": ["x", [1.0], (2.0, 1.0), (0.0, np.nan), ("a", "b")],
    "n_colors": [0, 2.5, "x", 1e9],
    "nan_color": ["nope", 5],
    "below_color": ["nope"],
    "above_color": ["nope"],
    "log_scale": ["off"],
    "lighting": ["off"],
}


@pytest.mark.few(5)
@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines"])
@pytest.mark.parametrize("name", WRONG)
def test_wrong_settings_fail_at_once_though_one_colour_is_shown(plotter, three_lines, add, name):
    """Else they would fail when numbers colour later, far from where they were given."""
    actor = getattr(plotter, add)(three_lines, color="red")
    for value in WRONG[name]:
        before = getattr(actor, name)
        with pytest.raises(ValueError, match=rf"{name} (is|begins)"):
            setattr(actor, name, value)
        assert getattr(actor, name) == before
        with pytest.raises(ValueError, match=rf"{name} (is|begins)"):
            getattr(plotter, add)(three_lines, color="red", **{name: value})
    actor.scalars = np.arange(3.0)
    plotter.screenshot()


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
        (lambda: image_of(np.ones((3, 3, 3)), rgb=np.zeros((27, 3))), r"shape \(3, 3, 3, 3\), as RGB"),
    ],
)
def test_what_is_no_volume_is_refused_in_words(plotter, line, scalars, message):
    with pytest.raises(ValueError, match=message):
        plotter.add_fiblets([line], scalars=scalars())
    with pytest.raises(FileNotFoundError, match=r"nothing\.nii"):
        plotter.add_fiblets([line], scalars="/nowhere/nothing.nii")
    assert not plotter.actors
