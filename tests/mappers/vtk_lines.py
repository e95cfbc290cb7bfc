"""Poly-lines of VTK's own, and pictures of what mappers draw in a plain window of VTK's."""

from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)

SIZE = (220, 180)


def ring(turn: float, points: int = 120) -> np.ndarray:
    """Return a curve about 40 mm across, around the origin."""
    t = np.linspace(0, 5, points) + turn
    return np.c_[20 * np.cos(t), 20 * np.sin(t), 6 * t - 15 - 6 * turn + 4 * np.sin(9 * turn)]


CURVES = [ring(0.3 * i) for i in range(12)]


def lines(curves=CURVES) -> vtkPolyData:
    """Return curves as VTK's own poly-lines, with an array of each kind."""
    data, points, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    data.SetVerts(vtkCellArray())
    data.GetVerts().InsertNextCell(1, (0,))  # cell data of the lines begin after it
    for curve in curves:
        first = points.GetNumberOfPoints()
        for point in curve:
            points.InsertNextPoint(point)
        cells.InsertNextCell(len(curve), range(first, first + len(curve)))
    data.SetPoints(points)
    data.SetLines(cells)
    places = np.concatenate(curves)
    add(data.GetPointData(), "height", places[:, 2])
    add(data.GetPointData(), "place", places)
    add(data.GetPointData(), "label", np.digitize(places[:, 0], [-10, 10]).astype(float))
    number = np.arange(len(curves) + 1.0)
    add(data.GetCellData(), "number", number)
    add(data.GetCellData(), "tint", (np.c_[number, number[::-1], number * 0] * 255 / len(curves)).astype(np.uint8))
    add(data.GetPointData(), "tints", np.uint8(np.clip(places * 6 + 128, 0, 255)))
    return data


def add(attributes, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    attributes.AddArray(array)


def scene(mapper, prepare=None) -> vtkRenderWindow:
    """Return a window whose only holder is the caller: actor and renderer are VTK's."""
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    if prepare:
        prepare(actor)
    renderer = vtkRenderer()
    renderer.AddActor(actor)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(SIZE)
    window.AddRenderer(renderer)
    renderer.GetActiveCamera().SetPosition(60, -70, 50)
    renderer.GetActiveCamera().SetViewUp(0, 0, 1)
    renderer.ResetCameraClippingRange()
    return window


def shot(window) -> np.ndarray:
    """Return a window's picture, (height, width, 3)."""
    grabber = vtkWindowToImageFilter()
    grabber.SetInput(window)
    grabber.ReadFrontBufferOff()
    grabber.Update()
    values = vtk_to_numpy(grabber.GetOutput().GetPointData().GetScalars())
    return values.reshape(*SIZE[::-1], -1)[::-1].astype(int)


def drawn(mapper, prepare=None) -> np.ndarray:
    window = scene(mapper, prepare)
    image = shot(window)
    window.Finalize()
    return image


def alike(ours, theirs, tools, *, share=0.97, colours=25):
    """Compare two pictures: the same pixels but for neighbours, and in those of both the same colours."""
    assert tools.agreement(ours.any(axis=-1), theirs.any(axis=-1)) > share
    both = ours.any(axis=-1) & theirs.any(axis=-1)
    apart = np.abs(ours - theirs)[both].max(axis=-1)
    assert np.percentile(apart, 80) <= colours  # where lines cross another one may be in front


def vtks(data, settle=lambda mapper: None, prepare=None):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    settle(mapper)
    return drawn(mapper, prepare)


def wide(actor):
    actor.GetProperty().SetLineWidth(3)
    actor.GetProperty().SetColor(1.0, 0.5, 0.2)


def rainbow(mapper):
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("height")
    mapper.SetScalarRange(-20, 20)


def ball() -> vtkImageData:
    axis = np.arange(-12.0, 13.0)
    values = 12.0 - np.sqrt(axis[:, None, None] ** 2 + axis[:, None] ** 2 + axis**2)
    image = vtkImageData()
    image.SetDimensions(25, 25, 25)
    image.SetOrigin(-12, -12, -12)
    image.GetPointData().SetScalars(numpy_to_vtk(values.ravel(order="F"), deep=True))
    return image
