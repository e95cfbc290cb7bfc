"""An actor of spline tubes that is given other tubes and other colours stays in step with itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.plotting import SplineTubeActor
from pvfiblets.splines.build import as_spline_tubes

X = np.linspace(-15.0, 15.0, 5)
BARS = [np.stack([X, 0 * X, 0 * X + z], axis=1) for z in (-10.0, 0.0, 10.0)]
FORK = (np.array([(0, 0, 0), (10, 0, 0), (20, 5, 0), (20, -5, 0)], float), np.array([(0, 1), (1, 2), (1, 3)]))


def test_computed_colours_are_those_of_the_tubes_that_show():
    actor = SplineTubeActor(as_spline_tubes(BARS[0], radius=[1, 2, 3, 4, 5]), scalars="radius")
    assert actor.clim == (1.0, 5.0)
    actor.tubes = replace(actor.tubes, radius=2 * actor.tubes.radius)
    assert actor.clim == (2.0, 10.0)
    actor.scalars = "arc_length"
    actor.tubes = replace(actor.tubes, points=3 * actor.tubes.points)
    assert actor.clim == pytest.approx((0.0, 90.0))
    assert actor.tubes.values == {}


def test_arc_lengths_leave_the_tubes_of_the_actor_as_they_were():
    """Three tubes meet in one node that lies 10 mm, 0 mm and 0 mm along them; numbers are still given per node."""
    tubes = as_spline_tubes(FORK, tangents=np.tile([1.0, 0, 0], (4, 1)), scaled=True, radius=1.0)
    tubes = replace(tubes, tubes=np.arange(3), n_tubes=3)
    actor = SplineTubeActor(tubes, scalars="arc_length")
    assert actor.tubes is tubes
    actor.scalars = np.arange(4.0)
    assert (actor.tubes.n_nodes, actor.clim) == (4, (0.0, 3.0))


@pytest.mark.parametrize("other", [None, BARS[0], "tubes"])
def test_other_things_than_tubes_are_refused_in_words(other):
    actor = SplineTubeActor(as_spline_tubes(BARS, radius=1.0))
    before = actor.tubes
    with pytest.raises(TypeError, match="as_spline_tubes"):
        actor.tubes = other
    assert actor.tubes is before


def test_unknown_names_list_what_there_is():
    mesh = pv.MultipleLines(BARS[0])
    mesh.point_data["height"] = X
    mesh.cell_data["weight"] = [3.0]
    mesh.point_data["fa"] = list("abcde")  # text colours nothing
    plotter = pv.Plotter(off_screen=True)
    for source, known in ((mesh, "'height'.*'weight'.*'arc_length'"), (BARS, "none.*none.*'arc_length'"),
                          (as_spline_tubes(BARS), "none.*none.*'arc_length'")):  # fmt: skip
        with pytest.raises(KeyError, match=f"no array 'fa'.*{known}"):
            plotter.add_spline_tubes(source, scalars="fa")
    plotter.close()
