"""`Colouring` against vtkLookupTable, number by number and pixel by pixel."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkLookupTable

from pvfiblets.mappers import Colouring
from pvfiblets.mappers.frames import windows

VTK_COLOR_MODE_MAP_SCALARS = 1
RAINBOW = np.array(
    [[0, 0, 255, 255], [0, 255, 255, 255], [0, 255, 0, 255], [255, 255, 0, 255], [255, 0, 0, 255]],
    dtype=np.uint8,
)


def vtk_table(colouring: Colouring) -> vtkLookupTable:
    table = vtkLookupTable()
    table.SetNumberOfTableValues(len(colouring.lut))
    table.SetRange(*colouring.clim)
    if colouring.log_scale:
        table.SetScaleToLog10()
    for index, colour in enumerate(colouring.lut):
        table.SetTableValue(index, *(float(channel) / 255 for channel in colour))
    table.SetNanColor(*colouring.nan_color)
    table.SetUseBelowRangeColor(colouring.below_color is not None)
    table.SetUseAboveRangeColor(colouring.above_color is not None)
    if colouring.below_color is not None:
        table.SetBelowRangeColor(*colouring.below_color)
    if colouring.above_color is not None:
        table.SetAboveRangeColor(*colouring.above_color)
    table.BuildSpecialColors()
    return table


def as_bytes(table: vtkLookupTable, value: float) -> tuple[int, ...]:
    array = vtkDoubleArray()
    array.InsertNextValue(value)
    return tuple(int(c) for c in table.MapScalars(array, VTK_COLOR_MODE_MAP_SCALARS, -1).GetTuple(0))


@given(
    low=st.floats(-1e3, 1e3, width=32), span=st.floats(0, 1e3, width=32),
    share=st.floats(-0.25, 1.25) | st.sampled_from([0.999, math.nan, math.inf, -math.inf]),
    count=st.integers(1, 300), special=st.booleans(),
)  # fmt: skip
def test_linear_tables_map_as_vtk_does(low, span, share, count, special):
    lut = np.random.default_rng(count).integers(0, 256, (count, 4), dtype=np.uint8)
    value = low + share * span if span else low + share
    outside = {"below_color": (1, 0, 1), "above_color": (0, 1, 0, 0.5)} if special else {}
    colouring = Colouring("point_scalar", source="fa", lut=lut, clim=(low, low + span), **outside)
    edge = (value - low) * count / span if span and math.isfinite(value) else 0.5
    if abs(edge - round(edge)) < 1e-9 * max(1.0, abs(edge)):
        return  # on the border of two entries both are right
    assert tuple(colouring.map_values([value])[0]) == as_bytes(vtk_table(colouring), value)


@given(low=st.floats(0.0625, 100, width=32), factor=st.floats(1.5, 1e4, width=32), value=st.floats(-10, 1e6, width=32))
def test_logarithmic_tables_map_as_vtk_does(low, factor, value):
    colouring = Colouring(
        "point_scalar", source="fa", lut=RAINBOW, clim=(low, low * factor), log_scale=True, below_color=(1, 0, 1),
        above_color=(1, 1, 1),
    )  # fmt: skip
    if value > 0:
        edge = math.log10(value / low) / math.log10(factor) * len(RAINBOW)
        if abs(edge - round(edge)) < 1e-6:
            return
    assert tuple(colouring.map_values([value])[0]) == as_bytes(vtk_table(colouring), value)


@pytest.mark.parametrize(
    ("fields", "words"),
    [({"mode": "rainbow"}, "rainbow"), ({"mode": "solid", "color": (255, 0, 0)}, "between 0 and 1"),
     ({"mode": "streamline_rgba", "values": np.zeros((4, 2), np.uint8)}, "shape"),
     ({"mode": "streamline_rgba", "values": np.zeros((4, 3))}, "uint8"), ({"mode": "streamline_rgba"}, "nothing"),
     ({"mode": "streamline_scalar", "values": np.zeros((4, 3))}, "streamline_scalar"),
     ({"mode": "point_scalar", "clim": (0, 1)}, "source"), ({"mode": "point_scalar", "source": "fa"}, "clim"),
     ({"mode": "point_scalar", "source": "fa", "clim": (1, 0)}, "rising"),
     ({"mode": "point_scalar", "source": "fa", "clim": (0, math.nan)}, "finite"),
     ({"mode": "point_scalar", "source": "fa", "clim": (0, 1), "log_scale": True}, "positive"),
     ({"mode": "point_scalar", "source": "fa", "clim": (0, 1), "lut": np.zeros((0, 4), "u1")}, "lut"),
     ({"mode": "point_rgba"}, "'point_rgba' needs source")],
)  # fmt: skip
def test_what_cannot_be_drawn_is_refused(fields, words):
    with pytest.raises(ValueError, match=words):
        Colouring(**fields)


def test_the_default_range_is_that_of_finite_values():
    values = np.array([3.0, np.nan, -1.0, np.inf])
    assert Colouring("streamline_scalar", values=values).clim == (-1.0, 3.0)
    assert Colouring("streamline_scalar", values=values, log_scale=True).clim == (3.0, 3.0)
    assert Colouring("streamline_scalar", values=np.full(3, np.nan)).clim == (0.0, 1.0)


# Pixels


def rods(tools, count=5):
    """Parallel rods along x, y and z in turn, one streamline each."""
    streamlines = tools.helices(1, 2)
    axes = [(1, 0, 0), (0, 0, 1), (1, 0, 1)]
    curves = []
    for i in range(count):
        along = np.linspace(0, 10, 21)[:, None] * np.array(axes[i % 3])
        curves.append(along + np.array((12 * i, 0, 0)))
    return type(streamlines).from_list(curves)


@pytest.fixture
def rod_scene(make_plotter, make_fibres, tools):
    fibres = make_fibres(rods(tools))
    mapper, actor = fibres.actor()
    plotter = make_plotter(window_size=(400, 120))
    plotter.add_actor(actor)
    plotter.camera_position = "xz"
    plotter.reset_camera()
    plotter.camera.zoom(2.0)

    def colours():
        """Return the colour of every rod, which must have only one."""
        image = tools.picture(plotter, mapper)
        mask = tools.covered(image)
        found = []
        for i in range(5):
            middle = (*map(float, fibres.reference[i][10]), 1.0)
            plotter.renderer.SetWorldPoint(actor.GetMatrix().MultiplyPoint(middle))
            plotter.renderer.WorldToDisplay()
            x, y, _ = plotter.renderer.GetDisplayPoint()
            row, column = image.shape[0] - 1 - int(y), int(x)
            window = np.s_[row - 2 : row + 3, column - 2 : column + 3]
            seen = image[window][mask[window]].astype(int)
            # Tangents of decoded points differ by what the coding leaves; nothing else may.
            assert len(seen) == 0 or np.ptp(seen, axis=0).max() <= 4, seen
            found.append(tuple(int(c) for c in np.median(seen, axis=0)) if len(seen) else None)
        return found

    return mapper, actor, colours


def test_orientation_is_the_tangent_in_data_coordinates(rod_scene):
    mapper, actor, colours = rod_scene
    diagonal = round(255 / math.sqrt(2))
    expected = [(255, 0, 0), (0, 0, 255), (diagonal, 0, diagonal), (255, 0, 0), (0, 0, 255)]
    assert np.allclose(colours(), expected, atol=3)
    actor.SetOrientation(0, 5, 0)  # in world coordinates red would lose, and blue gain, 22
    assert np.allclose(colours(), expected, atol=3)


def test_solid_and_streamline_colours(rod_scene):
    mapper, _, colours = rod_scene
    mapper.colouring = Colouring("solid", color=(0.2, 0.4, 0.6))
    assert colours() == [(51, 102, 153)] * 5
    rgb = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 8, 7], [255, 255, 255]], dtype=np.uint8)
    mapper.colouring = Colouring("streamline_rgba", values=rgb)
    assert colours() == [tuple(map(int, row)) for row in rgb]
    with pytest.raises(ValueError, match="4 values for 5 streamlines"):
        mapper.colouring = Colouring("streamline_scalar", values=np.arange(4.0))


@pytest.mark.parametrize("log_scale", [False, True])
def test_streamline_scalars_and_the_scalar_bar_agree(rod_scene, log_scale):
    mapper, _, colours = rod_scene
    values = np.array([1.0, np.nan, 50.0, 1000.0, 0.5])
    mapper.colouring = colouring = Colouring(
        "streamline_scalar", values=values, lut=RAINBOW, clim=(1.0, 100.0), log_scale=log_scale,
        nan_color=(0.2, 0.2, 0.2), above_color=(1, 1, 1),
    )  # fmt: skip
    table = vtk_table(colouring)
    assert colours() == [as_bytes(table, value)[:3] for value in values]


def test_zero_alpha_is_not_drawn_and_changes_pass(rod_scene):
    mapper, actor, colours = rod_scene
    rgba = np.full((5, 4), 255, dtype=np.uint8)
    rgba[1, 3] = 0
    mapper.colouring = Colouring("streamline_rgba", values=rgba)
    assert actor.HasTranslucentPolygonalGeometry()
    assert colours() == [(255, 255, 255), None] + [(255, 255, 255)] * 3
    mapper.colouring = Colouring("solid")
    assert not actor.HasTranslucentPolygonalGeometry()


@pytest.mark.parametrize("log_scale", [False, True])
def test_point_values_through_the_table(make_plotter, make_fibres, tools, log_scale):
    """Arc length grows along a straight line from 0 to its length: pixel by pixel against vtkLookupTable."""
    line = np.c_[np.linspace(0, 100, 101), np.zeros((101, 2))]
    colouring = Colouring(
        "point_scalar", source="arc_length", lut=RAINBOW, clim=(4.0, 90.0), log_scale=log_scale,
        below_color=(1, 0, 1), above_color=(1, 1, 1),
    )  # fmt: skip
    mapper, actor = make_fibres(type(tools.helices(1, 2)).from_list([line])).actor(colouring=colouring)
    plotter = make_plotter(window_size=(400, 60))
    plotter.add_actor(actor)
    plotter.camera_position = "xz"
    plotter.enable_parallel_projection()
    plotter.reset_camera()
    plotter.camera.parallel_scale = 10
    image = tools.picture(plotter, mapper)
    rows, columns = np.nonzero(tools.covered(image))
    assert len(columns) > 290
    x, table = 50 + (columns + 0.5 - 200) * 20 / 60, vtk_table(colouring)
    expected = np.array([as_bytes(table, value)[:3] for value in x])
    # Only pixels at the border of two entries may fall to either side.
    assert (image[rows, columns] == expected).all(axis=1).mean() > 0.97
    assert len(np.unique(image[rows, columns], axis=0)) == 7


def test_changing_colours_costs_no_redraw(rod_scene):
    mapper, actor, colours = rod_scene

    def redraws():
        (context,) = windows._contexts.values()
        (slot,) = context.slots.values()
        (drawn,) = slot.drawn.values()
        return slot.renderer, slot.renderer.render(drawn.view, drawn.style).generation

    colours()
    before = redraws()
    mapper.colouring = Colouring("solid")
    colours()
    mapper.colouring = Colouring("streamline_scalar", values=np.arange(5.0))
    colours()
    mapper.colouring = dataclasses.replace(mapper.colouring, lut=RAINBOW)
    colours()
    actor.GetProperty().SetOpacity(0.5)
    colours()
    assert redraws() == before


def test_more_streamlines_than_a_texture_is_wide(make_plotter, tools):
    count = 9001
    x = np.arange(count) % 100
    z = np.arange(count) // 100
    points = np.stack([np.c_[x, 0 * x, z], np.c_[x + 0.2, 0 * x, z]], axis=1).reshape(-1, 3)
    helices = tools.helices(1, 2)
    streamlines = type(helices)(points.astype(float), np.arange(count + 1) * 2)
    fibres = tools.fibres(streamlines)
    rgb = np.zeros((count, 3), dtype=np.uint8)
    rgb[:, 0] = 1 + np.arange(count) % 251
    rgb[:, 1] = np.arange(count) // 251
    mapper, actor = fibres.actor(colouring=Colouring("streamline_rgba", values=rgb))
    plotter = make_plotter(window_size=(500, 500))
    plotter.add_actor(actor)
    plotter.camera_position = "xz"
    plotter.reset_camera()
    image = tools.picture(plotter, mapper)
    mask = tools.covered(image)
    ids = (image[..., 0].astype(int) - 1 + 251 * image[..., 1].astype(int))[mask]
    rows, columns = np.nonzero(mask)
    assert ids.max() < count
    assert len(set(ids)) > 0.6 * count
    # Ids grow to the right and upwards as the rods were laid out.
    assert np.corrcoef(ids % 100, columns)[0, 1] > 0.999
    assert np.corrcoef(ids // 100, -rows)[0, 1] > 0.999
