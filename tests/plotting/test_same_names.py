"""Arrays of points and of lines that share a name."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.streamlines import Streamlines

POINTS = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1]])
WIDTHS = {"add_halo_lines": {"line_width": 0.1, "strip_width": 0.3}, "add_spline_tubes": {"radius": 0.1}}


@pytest.fixture
def mesh():
    found = pv.PolyData(POINTS, lines=[2, 0, 1, 2, 1, 2, 2, 2, 0])
    found.point_data["d"], found.cell_data["d"] = [10.0, 11, 12], [0, 1, 2]
    return found


@pytest.mark.parametrize("add", ["add_fiblets", "add_halo_lines", "add_spline_tubes"])
@pytest.mark.parametrize("preference", ["point", "cell"])
def test_the_preferred_array_colours_as_in_add_mesh(plotter, mesh, add, preference):
    actor = getattr(plotter, add)(mesh, scalars="d", preference=preference, **WIDTHS.get(add, {}))
    wanted = plotter.add_mesh(mesh.copy(), scalars="d", preference=preference).mapper.scalar_range
    assert actor.clim == wanted
    assert sorted(mesh.point_data) == sorted(mesh.cell_data) == ["d"]
    assert mesh.point_data["d"].tolist() == [10, 11, 12]


@pytest.mark.parametrize(("preference", "limits"), [("point", (10.0, 11.0)), ("cell", (0, 1))])
def test_criteria_take_the_same_array(plotter, mesh, preference, limits):
    actor = plotter.add_fiblets(mesh, scalars="d", preference=preference)
    actor.criterion("d", limits)
    assert actor.shown.any()
    other = {"point": "d (line)", "cell": "d (point)"}[preference]
    actor.scalars = other
    assert actor.clim == {"point": (0.0, 2.0), "cell": (10.0, 12.0)}[preference]


def test_streamlines_and_unknown_preferences(plotter):
    lines = Streamlines(POINTS, np.array([0, 3]), {"d": np.arange(3.0)}, {"d": np.array([7.0])})
    assert plotter.add_fiblets(lines, scalars="d", preference="cell").clim[0] == 7.0
    assert set(lines.per_point) == set(lines.per_streamline) == {"d"}
    with pytest.raises(ValueError, match="preference is 'row'; choose 'point' or 'cell'"):
        plotter.add_fiblets(lines, preference="row")
