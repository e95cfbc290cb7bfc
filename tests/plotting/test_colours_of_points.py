"""A colour at every point of fiblets: what NumPy interpolates, and as `add_mesh` shows the same data."""

from __future__ import annotations

import numpy as np
import pytest

import pvfiblets
from pvfiblets.codec.editing.point_arrays import colours_of_points, with_point_colours
from pvfiblets.streamlines import Streamlines

X = np.linspace(-10.0, 10.0, 41)
RAMP = np.stack([(X + 10.0) / 20.0, (10.0 - X) / 20.0, 0.2 + np.abs(X) / 20.0], axis=1)


def line(z=0.0, **columns):
    return Streamlines(np.stack([X, 0.0 * X, 0.0 * X + z], axis=1), [0, 41], per_point=columns)


def show(plotter):
    """Look at the line from above, 1 pixel for each 0.12 mm."""
    plotter.camera.SetParallelProjection(True)
    plotter.camera.SetPosition(0.0, 0.0, 100.0)
    plotter.camera.SetFocalPoint(0.0, 0.0, 0.0)
    plotter.camera.SetViewUp(0.0, 1.0, 0.0)
    plotter.camera.SetParallelScale(12.0)
    plotter.renderer.ResetCameraClippingRange()
    plotter.render()
    return plotter.screenshot(None)


def middle(picture):
    """Colours of the line's pixels from 0 to 1, and which x they lie at."""
    rows = picture[:, :, :3].max(axis=2)
    seen = np.flatnonzero(rows.max(axis=0))[2:-2]
    x = (seen + 0.5 - 100.0) * 0.12
    return picture[rows[:, seen].argmax(axis=0), seen, :3] / 255.0, x


def ramp(x):
    return np.stack([np.interp(x, X, RAMP[:, k]) for k in range(3)], axis=1)


@pytest.mark.few(5)
@pytest.mark.parametrize("pipeline", ["compute", "tessellation", "geometry"])
@pytest.mark.parametrize("kind", ["floats", "bytes", "name", "columns"])
def test_a_colour_at_every_point(plotter, pipeline, kind):
    colours = np.round(255.0 * RAMP).astype(np.uint8) if kind == "bytes" else RAMP
    if kind == "name":
        actor = plotter.add_fiblets(line(c=RAMP), scalars="c", lighting=False, pipeline=pipeline)
    elif kind == "columns":
        held = pvfiblets.compress(line(c=RAMP), per_point=["c"])
        actor = plotter.add_fiblets(held, scalars="c", lighting=False, pipeline=pipeline)
    else:
        actor = plotter.add_fiblets(line(), scalars=colours, lighting=False, pipeline=pipeline)
    assert not plotter.scalar_bars.keys()
    found, x = middle(show(plotter))
    assert len(x) > 150
    np.testing.assert_allclose(found, ramp(x), atol=3.0 / 255.0 + 0.06 / 20.0)
    assert [buffer["bytes"] for buffer in actor.explain()["buffers"] if buffer["name"] == "values"] == [4 * 41 + 4]


@pytest.mark.parametrize("line_width", [1, 7])
def test_as_add_mesh_shows_them(plotter, line_width):
    mesh = line(c=np.round(255.0 * RAMP).astype(np.uint8)).to_polydata()
    plotter.add_mesh(mesh, scalars="c", rgb=True, lighting=False, line_width=line_width)
    wanted, x = middle(show(plotter))
    plotter.clear()
    plotter.add_fiblets(mesh, scalars="c", lighting=False, line_width=line_width)
    found, at = middle(show(plotter))
    both, ours, theirs = np.intersect1d(np.round(at, 6), np.round(x, 6), return_indices=True)
    assert len(both) > 150
    np.testing.assert_allclose(found[ours], wanted[theirs], atol=3.0 / 255.0)


@pytest.mark.few(2)
@pytest.mark.parametrize("transparency", ["all", "layers", None])
@pytest.mark.parametrize("how", ["alpha", "opacity"])
def test_what_shows_through_has_the_colours_of_its_points(plotter, transparency, how):
    """Half of a red line, and of what it lets through of the line behind it."""
    both = Streamlines.concatenate([line(5.0), line(-5.0)])
    colours = np.concatenate([np.tile([1.0, 0.0, 0.0], (41, 1)), RAMP])
    if how == "alpha":
        colours = np.hstack([colours, np.full((82, 1), 0.5)])
    actor = plotter.add_fiblets(both, scalars=colours, rgb=True, lighting=False, transparency=transparency)
    if how == "opacity":
        actor.opacity = 0.5
    found, x = middle(show(plotter))
    wanted = 0.5 * np.tile([1.0, 0.0, 0.0], (len(x), 1))
    if transparency is not None:
        wanted = wanted + 0.25 * ramp(x)
    np.testing.assert_allclose(found, wanted, atol=0.02)


def test_bytes_are_kept_to_half_a_step():
    rng = np.random.default_rng(3)
    colours = rng.integers(0, 256, (41, 4)).astype(np.uint8)
    for columns in (3, 4):
        held = with_point_colours(pvfiblets.compress(line()), "c", colours[:, :columns])
        assert sum(held.per_point[f"c[{k}]"].codes.nbytes for k in range(columns)) == columns * 41
        kept = colours_of_points(held, "c")
        assert np.abs(kept[:, :columns].astype(int) - colours[:, :columns]).max() <= 1
        assert columns == 4 or (kept[:, 3] == 255).all()


def test_colours_change_and_are_saved(plotter, tmp_path, colours_in):
    red = np.tile([255, 0, 0], (41, 1)).astype(np.uint8)
    actor = plotter.add_fiblets(line(), scalars=red, lighting=False)
    assert actor.copy().scalars == actor.scalars == "Data"
    actor.fiblets.save(tmp_path / "red.fiblets")
    assert colours_in(show(plotter)) == {(255, 0, 0)}
    actor.scalars = np.hstack([red[:, ::-1], red[:, :1]])
    assert colours_in(show(plotter)) == {(0, 0, 255)}
    actor.scalars = np.linspace(0.0, 1.0, 41)  # numbers in their place
    assert actor.scalars_title == "Data"
    actor.scalars = red
    assert actor.scalars_title is None
    actor.opacity_by = np.array([1.0])
    with pytest.raises(ValueError, match="one number at points goes with a picture"):
        actor.opacity_by = np.linspace(0.0, 1.0, 41)
    assert colours_in(show(plotter)) == {(255, 0, 0)}
    plotter.clear()
    plotter.add_fiblets(tmp_path / "red.fiblets", scalars="Data", lighting=False)
    assert colours_in(show(plotter)) == {(255, 0, 0)}
    with pytest.raises(ValueError, match="floats must lie between 0 and 1"):
        plotter.add_fiblets(line(), scalars=3.0 * RAMP, rgb=True)
