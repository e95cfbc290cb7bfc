"""Colours by vtkMapper's own settings: arrays, look-up tables and functions, against VTK's mapper."""

from __future__ import annotations

import numpy as np
import pytest
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkVariant
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

from pvfiblets.mappers import FibletMapper, HaloMapper, TubeMapper, VolumeMapper

from .vtk_lines import CURVES, SIZE, alike, ball, drawn, lines, rainbow, scene, shot, vtks, wide


def logarithm(mapper):
    table = vtkLookupTable()
    table.SetScaleToLog10()
    table.SetTableRange(1, 40)
    table.SetUseBelowRangeColor(True)
    table.SetBelowRangeColor(1, 0, 1, 1)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("height")
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()


def function(mapper):
    table = vtkColorTransferFunction()
    for place, colour in ((-20, (1, 0, 0)), (0, (1, 1, 1)), (20, (0, 0, 1))):
        table.AddRGBPoint(place, *colour)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("height")
    mapper.SetLookupTable(table)


def magnitude(mapper):
    rainbow(mapper)
    mapper.SelectColorArray("place")
    mapper.GetLookupTable().SetVectorModeToMagnitude()
    mapper.SetScalarRange(18, 25)


def component(mapper):
    mapper.SetScalarModeToUsePointFieldData()
    mapper.ColorByArrayComponent("place", 1)
    mapper.SetScalarRange(-20, 20)


def by_cells(mapper):
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray("number")
    mapper.SetScalarRange(0, 12)


def tints(mapper):
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray("tint")


def hidden(mapper):
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("height")
    mapper.ScalarVisibilityOff()


def labels(mapper):
    table = vtkLookupTable()
    table.IndexedLookupOn()
    table.SetNumberOfTableValues(3)
    for i, colour in enumerate(((1, 0, 0, 1), (0, 1, 0, 1), (0, 0, 1, 1))):
        table.SetAnnotation(vtkVariant(i), str(i))
        table.SetTableValue(i, *colour)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("label")
    mapper.SetLookupTable(table)


COLOURS = (labels, rainbow, logarithm, function, magnitude, component, by_cells, tints, hidden)


@pytest.mark.few(2)
@pytest.mark.parametrize("settle", COLOURS)
def test_colours_are_those_of_vtks_mapper(settle, tools):
    data = lines()
    mapper = FibletMapper()
    mapper.SetInputData(data)
    settle(mapper)
    ours = drawn(mapper, wide)
    mapper.raise_pending()
    alike(ours, vtks(data, settle, wide), tools)


@pytest.mark.few(1)
@pytest.mark.parametrize("make", [TubeMapper, HaloMapper])
def test_tubes_and_halos_are_coloured_point_by_point(make, tools):
    """Of the nearest pixels of VTK's lines: tubes and strips have widths of their own."""
    data = lines()

    def tinted(mapper):
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray("tints")

    mapper = make()
    mapper.SetInputData(data)
    for settle in (tinted, rainbow, by_cells):
        settle(mapper)
        ours, theirs = drawn(mapper), vtks(data, settle)
        both = (ours.max(axis=-1) > 90) & (theirs.max(axis=-1) > 90)
        assert both.sum() > 500
        hues = [image[both] / image[both].max(axis=-1, keepdims=True) for image in (ours, theirs)]
        assert np.percentile(np.abs(hues[0] - hues[1]).max(axis=-1), 70) <= 0.12, settle.__name__
    mapper.raise_pending()


def test_peaks_of_an_image_have_the_colours_of_the_look_up_table():
    """The ray through the middle of the ball meets 12, the last of the range."""
    mapper = VolumeMapper()
    mapper.SetInputData(ball())
    mapper.SetScalarRange(0, 12)
    image = drawn(mapper)
    mapper.raise_pending()
    wanted = [0.0, 0.0, 0.0]
    mapper.GetLookupTable().GetColor(12.0, wanted)
    np.testing.assert_allclose(image[SIZE[1] // 2, SIZE[0] // 2] / 255, wanted, atol=0.03)


def test_translucent_colours_are_drawn_in_the_translucent_pass():
    """Half of white on blue."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(1)
    table.SetTableValue(0, 1, 1, 1, 0.5)
    mapper = FibletMapper()
    mapper.SetInputData(lines(CURVES[:1]))
    rainbow(mapper)
    mapper.SetLookupTable(table)
    window = scene(mapper)
    window.GetRenderers().GetFirstRenderer().SetBackground(0, 0, 1)
    image = shot(window)
    line = image[image[..., 0] > 0]
    assert len(line) > 50
    np.testing.assert_allclose(np.median(line, axis=0), (128, 128, 255), atol=3)
    window.Finalize()
