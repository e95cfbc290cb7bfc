"""The polydata that VTK believes it draws."""

from __future__ import annotations

from collections.abc import Sequence

from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData


def proxy_polydata(bounds: Sequence[float] | None) -> vtkPolyData:
    """Return a triangle that has the given bounds and covers nothing.

    ``reset_camera``, the clipping range and VTK's frustum culling take the bounds from it; the vertex
    shader spreads its three vertices over the viewport. Its corners are the least corner of the bounds
    and twice the greatest one: the triangle is a line without area, so that no picker that intersects
    geometry finds a surface in mid-air.

    Parameters
    ----------
    bounds : sequence of float or None
        xmin, xmax, ymin, ymax, zmin, zmax in mm; None (nothing to draw) gives empty polydata.

    Returns
    -------
    vtkPolyData
        Three points and one triangle, or empty.
    """
    polydata = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    polydata.SetPoints(points)
    if bounds is None:
        return polydata
    least, greatest = tuple(bounds[0::2]), tuple(bounds[1::2])
    for corner in (least, greatest, greatest):
        points.InsertNextPoint(corner)
    triangle = vtkCellArray()
    triangle.InsertNextCell(3, (0, 1, 2))
    polydata.SetPolys(triangle)
    return polydata
