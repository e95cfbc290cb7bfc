"""Spline tubes that are given other tubes and colours stay in step with themselves; what is refused leaves nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.plotting import TubeActor
from pvfiblets.tubes.build import as_spline_tubes

X = np.linspace(-15.0, 15.0, 5)
BARS = [np.stack([X, 0 * X, 0 * X + z], axis=1) for z in (-10.0, 0.0, 10.0)]
FORK = (np.array([(0, 0, 0), (10, 0, 0), (20, 5, 0), (20, -5, 0)], float), np.array([(0, 1), (1, 2), (1, 3)]))


def test_computed_colours_are_those_of_the_tubes_that_show():
    actor = TubeActor(as_spline_tubes(BARS[0], radius=[1, 2, 3, 4, 5]), scalars="radius")
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
    actor = TubeActor(tubes, scalars="arc_length")
    assert actor.tubes is tubes
    actor.scalars = np.arange(4.0)
    assert (actor.tubes.n_nodes, actor.clim) == (4, (0.0, 3.0))


@pytest.mark.parametrize("other", [None, BARS[0], "tubes"])
def test_other_things_than_tubes_are_refused_in_words(other):
    actor = TubeActor(as_spline_tubes(BARS, radius=1.0))
    before = actor.tubes
    with pytest.raises(TypeError, match="as_spline_tubes"):
        actor.tubes = other
    assert actor.tubes is before


def test_unknown_names_list_what_there_is():
    mesh = pv.MultipleLines(BARS[0])
    mesh.point_data["height"] = X
    mesh.cell_data["weight"] = [3.0]
    plotter = pv.Plotter(off_screen=True)
    for source, known in ((mesh, "'height'.*'weight'.*'arc_length'"), (BARS, "none.*none.*'arc_length'"),
                          (as_spline_tubes(BARS), "none.*none.*'arc_length'")):  # fmt: skip
        with pytest.raises(KeyError, match=f"no array 'fa'.*{known}"):
            plotter.add_spline_tubes(source, scalars="fa")
    plotter.close()


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"radius": -1.0}, ValueError, "radius"),
        ({"radius": [1.0]}, ValueError, r"radius has the shape \(1,\)"),
        ({"scalars": "fa"}, KeyError, "no array 'fa'.*'arc_length'"),
        ({"scalars": np.zeros((15, 2)), "rgb": True}, ValueError, r"\(15, 2\)"),
        ({"method": "magic"}, ValueError, "method is 'magic'"),
        ({"opacity": 2}, ValueError, "opacity is 2"),
        ({"solver": "luck"}, ValueError, "solver is 'luck'"),
        ({"min_width": 1000}, ValueError, "min_width is 1000"),
        ({"scalars": "length", "clim": (2, 1)}, ValueError, "the low one first"),
        ({"scalars": "length", "n_colors": None}, ValueError, "n_colors is None"),
        ({"scalars": "length", "n_colors": 1e30}, ValueError, "n_colors is 1e"),
        ({"scalars": "length", "scalar_bar_args": {"size": 3}}, TypeError, "size"),
        ({"scalar_bar_args": "title"}, TypeError, "scalar_bar_args is 'title'"),
        ({"opacity": "linear"}, ValueError, "opacity 'linear' follows the numbers"),
        ({"silhouettes": ["boxes"]}, ValueError, r"silhouettes is \['boxes'\]"),
        ({"solver": {}}, ValueError, "solver is {}"),
        ({"iterations": "many"}, ValueError, "iterations is 'many'"),
        ({"iterations": float("inf")}, ValueError, "iterations is inf"),
        ({"min_width": None}, ValueError, "min_width is None"),
        ({"scalars": "arc_length", "scalar_slopes": np.ones(15)}, ValueError, "scalar_slopes came with 'arc_length'"),
        ({"label": 3}, TypeError, "label is 3; give a string"),
    ],
)
def test_nonsense_is_refused_in_words(plotter, arguments, error, message):
    with pytest.raises(error, match=message):
        plotter.add_spline_tubes(BARS, **arguments)
    assert not plotter.actors
