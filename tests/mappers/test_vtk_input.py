"""Mappers as VTK's own code uses them: connected, given to actors, copied, and coloured by vtkMapper's settings."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkVariant, vtkWeakReference
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkContourFilter, vtkTubeFilter
from vtkmodules.vtkFiltersGeneral import vtkTransformFilter
from vtkmodules.vtkFiltersSources import vtkLineSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkActor, vtkColorTransferFunction, vtkPolyDataMapper
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderer

from pvfiblets.codec.encoding.compress import compress
from pvfiblets.mappers import Colouring, FibletMapper, HaloMapper, TubeMapper, VolumeMapper
from pvfiblets.streamlines import Streamlines
from pvfiblets.volumes.raycast_options import RaycastOptions

from .vtk_lines import CURVES, SIZE, alike, ball, drawn, lines, rainbow, scene, shot, vtks, wide


def test_set_mapper_is_enough(tools):
    """The mapper finds the actor, though nobody but VTK has it."""
    fiblets = compress(Streamlines.from_list(CURVES))
    attached, given = FibletMapper(fiblets), FibletMapper(fiblets)
    by_attach = scene(vtkPolyDataMapper(), attached.attach)
    by_set = scene(given)
    gc.collect()
    np.testing.assert_array_equal(shot(by_set), shot(by_attach))
    assert given.actor is not None
    given.raise_pending()
    attached.raise_pending()
    for window in (by_set, by_attach):
        window.Finalize()


def test_objects_that_refuse_to_tell_their_class_are_passed_over():
    """Python's collector knows such of any library: all mappers given by SetMapper then drew nothing."""

    class Gone:
        pass

    gone = Gone()
    proxy = weakref.proxy(gone)
    del gone
    with pytest.raises(ReferenceError):
        isinstance(proxy, vtkActor)
    mapper = FibletMapper(compress(Streamlines.from_list(CURVES)))
    assert drawn(mapper).any()
    mapper.raise_pending()


def test_connected_lines_are_drawn_as_vtk_draws_them(tools):
    data = lines()
    mapper = FibletMapper()
    mapper.SetInputData(data)
    ours = drawn(mapper, wide)
    mapper.raise_pending()
    alike(ours, vtks(data, prepare=wide), tools)
    assert mapper.GetInput() is data
    assert mapper.fiblets.n_streamlines == len(CURVES)
    np.testing.assert_allclose(mapper.GetBounds(), data.GetBounds(), atol=1e-3)


def test_what_changes_upstream_is_taken_up_at_the_next_render():
    source, turn = vtkLineSource(), vtkTransform()
    source.SetPoint1(-20, 0, 0)
    source.SetPoint2(20, 0, 0)
    moved = vtkTransformFilter()
    moved.SetTransform(turn)
    moved.SetInputConnection(source.GetOutputPort())
    mapper = FibletMapper()
    mapper.SetInputConnection(moved.GetOutputPort())
    assert mapper.GetInputAlgorithm() is moved
    window = scene(mapper)
    flat = shot(window).any(axis=-1)
    same = mapper.fiblets
    np.testing.assert_array_equal(shot(window).any(axis=-1), flat)
    assert mapper.fiblets is same  # nothing changed: nothing is compressed again
    turn.RotateY(90)
    upright = shot(window).any(axis=-1)
    assert np.ptp(np.nonzero(flat)[1]) > 3 * np.ptp(np.nonzero(upright)[1])
    assert np.ptp(np.nonzero(upright)[0]) > 2 * np.ptp(np.nonzero(flat)[0])
    window.Finalize()


def test_tubes_cover_what_vtks_tube_filter_covers(tools):
    data = lines()
    mapper = TubeMapper(shape={"radius": 1.0})
    mapper.SetInputData(data)
    filtered = vtkTubeFilter()
    filtered.SetInputData(data)
    filtered.SetRadius(1.0)
    filtered.SetNumberOfSides(24)
    filtered.CappingOn()
    theirs = vtkPolyDataMapper()
    theirs.SetInputConnection(filtered.GetOutputPort())
    theirs.ScalarVisibilityOff()
    mapper.ScalarVisibilityOff()
    assert tools.agreement(drawn(mapper).any(axis=-1), drawn(theirs).any(axis=-1)) > 0.98


def test_halos_have_the_color_of_the_background(tools):
    mapper = HaloMapper()
    mapper.SetInputData(lines())

    def look(actor):
        actor.GetProperty().SetColor(1, 1, 0)

    image = drawn(mapper, look)
    mapper.raise_pending()
    seen = image[image.any(axis=-1)]
    assert len(seen) > 500
    assert (seen[:, 2] == 0).all()  # yellow or black, no white


def test_a_surface_of_an_image_covers_what_vtks_contour_covers(tools):
    image = ball()
    mapper = VolumeMapper(casting=RaycastOptions("isosurface", (5.0,)))
    producer = vtkTrivialProducer()
    producer.SetOutput(image)
    mapper.SetInputConnection(producer.GetOutputPort())
    contour = vtkContourFilter()
    contour.SetInputData(image)
    contour.SetValue(0, 5.0)
    theirs = vtkPolyDataMapper()
    theirs.SetInputConnection(contour.GetOutputPort())
    theirs.ScalarVisibilityOff()
    alike(drawn(mapper, wide), drawn(theirs, wide), tools)
    mapper.raise_pending()


@pytest.mark.more
def test_a_shallow_copy_draws_the_same_data():
    mapper = FibletMapper(line_width=2.0)
    mapper.SetInputData(lines())
    rainbow(mapper)
    image = drawn(mapper)
    twin = FibletMapper()
    twin.ShallowCopy(mapper)
    assert twin.fiblets is not None
    assert twin.fiblets is mapper.fiblets
    np.testing.assert_array_equal(drawn(twin), image)
    other = FibletMapper(compress(Streamlines.from_list(CURVES[:2])), colouring=Colouring("solid", color=(0, 1, 0)))
    twin.ShallowCopy(other)
    few = drawn(twin)
    assert few.any()
    assert not few[..., 0].any()
    ordinary = vtkPolyDataMapper()
    ordinary.SetInputData(lines())
    rainbow(ordinary)
    twin = FibletMapper()
    twin.ShallowCopy(ordinary)
    assert (drawn(twin, wide) - image).any()
    assert twin.fiblets.n_streamlines == len(CURVES)


def test_the_property_is_followed():
    mapper, held = FibletMapper(), []
    mapper.SetInputData(lines())
    window = scene(mapper, held.append)
    before = shot(window)
    held[0].GetProperty().SetColor(0, 0, 1)
    held[0].GetProperty().SetLineWidth(4)
    after = shot(window)
    assert before[..., 0].any()
    assert not after[..., 0].any()
    assert after.any(axis=-1).sum() > 2 * before.any(axis=-1).sum()
    window.Finalize()


def test_an_actor_that_gets_another_mapper_shows_that():
    """The shader pieces go with the mapper."""
    mapper, held, data = FibletMapper(), [], lines()
    mapper.SetInputData(data)
    window = scene(mapper, held.append)
    shot(window)
    ordinary = vtkPolyDataMapper()
    ordinary.SetInputData(data)
    held[0].SetMapper(ordinary)
    np.testing.assert_array_equal(shot(window), vtks(data))
    assert mapper.actor is None
    held[0].SetMapper(mapper)
    assert shot(window).any()
    mapper.raise_pending()
    window.Finalize()


def said_by(mapper) -> list[str]:
    said = []

    def hear(_mapper, _event, text):
        said.append(text)

    hear.CallDataType = "string0"
    mapper.AddObserver("ErrorEvent", hear)
    return said


def test_what_cannot_be_drawn_is_said_once_and_mended():
    mapper, nothing = FibletMapper(), vtkAppendPolyData()
    said = said_by(mapper)
    mapper.SetInputConnection(nothing.GetOutputPort())
    assert not drawn(mapper).any()
    mapper.raise_pending()
    assert not said
    sphere, mapper = vtkSphereSource(), FibletMapper()
    said = said_by(mapper)
    mapper.SetInputConnection(sphere.GetOutputPort())
    window = scene(mapper)
    for _ in range(3):
        assert not shot(window).any()
    assert len(said) == 1
    assert "96 other cells" in said[0]
    with pytest.raises(ValueError, match="no lines"):
        mapper.raise_pending()
    # Left to the collector, frames that hold a renderer would take its observers along, which VTK calls all the same.
    left = [one for one in gc.get_objects() if type(one) is vtkOpenGLRenderer and one.GetRenderWindow() is window]
    assert not left
    mapper.SetInputData(lines())
    assert shot(window).any()
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("tints")
    assert shot(window).any()
    assert len(said) == 1
    mapper.RemoveAllInputConnections(0)
    image = vtkImageData()
    image.SetDimensions(2, 2, 2)
    mapper.SetInputDataObject(0, image)
    assert not shot(window).any()
    assert "connect PolyData" in said[1]
    window.Finalize()


@pytest.mark.few(1)
@pytest.mark.parametrize("make", [FibletMapper, TubeMapper, HaloMapper])
def test_mapper_and_data_go_when_nobody_has_them(make):
    mapper = make()
    mapper.SetInputData(lines())
    drawn(mapper)
    what = weakref.ref(mapper._drawn)
    assert what() is not None
    del mapper
    gc.collect()
    assert what() is None


def test_connected_data_go_with_their_mapper_while_the_window_stays():
    mapper, data = FibletMapper(), lines()
    mapper.SetInputData(data)
    window = scene(mapper)
    shot(window)
    held = vtkWeakReference()
    held.Set(data)
    window.GetRenderers().GetFirstRenderer().RemoveAllViewProps()
    del mapper, data
    gc.collect()
    assert held.Get() is None
    window.Finalize()


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
