"""Colours by a value for each position along a bundle: as `add_mesh` of the same numbers."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets import bundles
from pvfiblets.errors import FormatError
from pvfiblets.streamlines import Streamlines

from .views import facing_shot

X = np.linspace(-15.0, 15.0, 61)
PROFILE = np.array([0.0, 1.0, np.nan, 3.0, 4.0])


def bundle():
    """Two lines along x, the second stored from its end, and one along z that no bundle has."""
    lines = [np.stack([X, 0 * X, 0 * X + z], axis=1) for z in (-5.0, 5.0)]
    lines[1] = lines[1][::-1]
    lines.append(np.array([(0.0, 3.0, z) for z in np.linspace(10.0, 18.0, 9)]))
    return Streamlines.from_list(lines, groups={"pair": np.array([0, 1])})


LOOKS = {"cmap": "viridis", "nan_color": "lime", "line_width": 5, "lighting": False, "show_scalar_bar": False}


def test_the_picture_is_add_meshs_of_the_same_numbers(plotter):
    actor = plotter.add_fiblets(bundle(), **LOOKS)
    returned = actor.color_along(PROFILE, ids="pair")
    assert np.array_equal(returned, PROFILE, equal_nan=True)
    found = facing_shot(plotter)
    plotter.remove_actor(actor)
    mesh, share = bundle().to_polydata(), (X + 15.0) / 30.0
    values = np.interp(share, [0.0, 0.25, 0.75, 1.0], [0.0, 1.0, 3.0, 4.0])
    values[np.abs(share - 0.375) < 0.125] = 1.0  # to the nearest position with a value
    values[np.abs(share - 0.625) < 0.125] = 3.0
    values[np.abs(share - 0.5) < 0.125] = np.nan
    mesh["v"] = np.concatenate([values, values[::-1], np.full(9, np.nan)])
    plotter.add_mesh(mesh, scalars="v", **LOOKS)
    wanted = facing_shot(plotter)
    lit = (found.max(axis=2) > 0) & (wanted.max(axis=2) > 0)
    assert lit.sum() > 0.9 * (wanted.max(axis=2) > 0).sum() > 500
    # VTK interpolates the colours of a segment that has a value at one end only.
    assert np.mean(np.abs(found - wanted).max(axis=2)[lit] > 8) < 0.06


def test_all_that_holds_a_profile_is_taken(plotter, tmp_path):
    fiblets = pvfiblets.compress(bundle(), exact=True)
    actor = plotter.add_fiblets(fiblets, **LOOKS)
    values = np.array([1.0, 2.0, 5.0])
    np.save(tmp_path / "v.npy", values)
    (tmp_path / "v.txt").write_text("1\n2\n5\n")
    (tmp_path / "many.tsv").write_text(
        "bundle\tposition\tmean\tp\npair\t0\t1\t0.1\npair\t0.5\t2\t\npair\t1\t5\t0.3\nother\t0\t9\t9\n"
    )
    wanted = bundles.values_along(fiblets, "pair", values)
    for held in (values, list(values), tmp_path / "v.npy", str(tmp_path / "v.txt"), tmp_path / "many.tsv"):
        actor.color_along(held, ids="pair")
        found = actor.fiblets.decompress().per_point[actor.scalars]
        assert np.allclose(found, wanted, atol=1e-3, equal_nan=True)
    actor.color_along(tmp_path / "many.tsv", ids="pair", column="p")
    assert (actor.scalars, actor.clim) == ("p profile", pytest.approx((0.1, 0.3), abs=1e-4))
    with pytest.raises(ValueError, match="profiles of pair, other"):
        actor.color_along(tmp_path / "many.tsv")
    with pytest.raises(KeyError, match="no column 'fa'"):
        actor.color_along(tmp_path / "many.tsv", ids="pair", column="fa")
    for rows, said in (("0,1\n1\n", r"the row \['1'\], expected 2 cells"), ("0,1\n1,high\n", "the cell 'high'")):
        (tmp_path / "bad.csv").write_text(f"position,mean\n{rows}")
        with pytest.raises(FormatError, match=said):
            actor.color_along(tmp_path / "bad.csv", ids="pair")
    assert actor.scalars == "p profile"


def test_a_profile_is_computed_and_knows_its_direction(plotter, tmp_path):
    streamlines = bundle()
    streamlines.per_point["x"] = np.asarray(streamlines.points)[:, 0].copy()
    actor = plotter.add_fiblets(streamlines, scalars="x", **LOOKS)
    profile = actor.color_along("x", 31, ids="pair")
    assert np.allclose(profile.mean, np.linspace(-15, 15, 31), atol=0.2)
    assert actor.scalars_title == "x profile"
    profile.table().save(tmp_path / "x.tsv")
    for held in (profile, tmp_path / "x.tsv"):
        actor.color_along(held, ids=[1])  # which runs the other way, but for its core
        found = actor.fiblets.decompress()
        line = slice(*found.offsets[1:3])
        assert np.allclose(found.per_point[actor.scalars][line], found.points[line, 0], atol=0.2)
        assert np.isnan(found.per_point[actor.scalars][: found.offsets[1]]).all()


def test_a_real_bundle_shows_its_own_profile(shared_data):
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.add_fiblets(shared_data / "nv_tract.SLF1_R.tck")
    profile = actor.color_along(np.linspace(0.0, 1.0, 100))
    mean = bundles.tract_profile(actor.fiblets, slice(None), actor.scalars, 20, weights="equal").mean
    assert np.abs(mean - np.interp(np.linspace(0, 1, 20), np.linspace(0, 1, 100), profile)).max() < 0.02
    plotter.close()
