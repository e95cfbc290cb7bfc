"""The polydata that VTK believes it draws."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData


def proxy_polydata(bounds: Sequence[float] | None, layers: int = 1) -> vtkPolyData:
    """Return two triangles for each layer, which have the given bounds and cover nothing until the vertex shader does.

    ``reset_camera``, the clipping range and VTK's frustum culling take the bounds from them; the vertex
    shader spreads them over the part of the viewport that the bounds cover. One sits with all its
    vertices in the least corner of the bounds, the other in the greatest, so that no picker that
    intersects geometry finds a surface or an edge in mid-air. Its vertices differ by a billionth of the
    size, inwards: VTK before 9.7 leaves out triangles whose vertices coincide.
    """
    polydata = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    polydata.SetPoints(points)
    if bounds is None:
        return polydata
    least, greatest = np.array(bounds[0::2], dtype=np.float64), np.array(bounds[1::2], dtype=np.float64)
    extent = greatest - least
    # At least some units in the last place, so that the vertices differ however far from the origin they are.
    apart = np.maximum(max(1e-9 * extent.max(), 1e-12), 8.0 * np.spacing(np.maximum(np.abs(least), np.abs(greatest))))
    triangles = vtkCellArray()
    for first in range(0, 6 * layers, 3):
        corner, inwards = (greatest, -apart) if first % 6 else (least, apart)
        for vertex in range(3):
            points.InsertNextPoint(corner + inwards * (np.arange(3) == vertex - 1))
        triangles.InsertNextCell(3, (first, first + 1, first + 2))
    polydata.SetPolys(triangles)
    return polydata
