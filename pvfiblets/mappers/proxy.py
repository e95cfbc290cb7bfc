"""The polydata that VTK believes it draws."""

from __future__ import annotations

from collections.abc import Sequence

from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData


def proxy_polydata(bounds: Sequence[float] | None) -> vtkPolyData:
    """Return two triangles that have the given bounds and cover nothing until the vertex shader places them.

    ``reset_camera``, the clipping range and VTK's frustum culling take the bounds from them; the vertex
    shader spreads them over the part of the viewport that the bounds cover. One sits with all its
    vertices in the least corner of the bounds, the other in the greatest, so that no picker that
    intersects geometry finds a surface or an edge in mid-air.

    Parameters
    ----------
    bounds : sequence of float or None
        xmin, xmax, ymin, ymax, zmin, zmax in mm; None (nothing to draw) gives empty polydata.

    Returns
    -------
    vtkPolyData
        Six points and two triangles, or empty.
    """
    polydata = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    polydata.SetPoints(points)
    if bounds is None:
        return polydata
    least, greatest = tuple(bounds[0::2]), tuple(bounds[1::2])
    triangles = vtkCellArray()
    for first, corner in ((0, least), (3, greatest)):
        for _ in range(3):
            points.InsertNextPoint(corner)
        triangles.InsertNextCell(3, (first, first + 1, first + 2))
    polydata.SetPolys(triangles)
    return polydata
