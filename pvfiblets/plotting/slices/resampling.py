"""Values of an image at the pixels of a plane, by ``vtkImageReslice`` in the coordinates of the image's voxels.

VTK is given neither spacing nor directions: one matrix leads from pixels to voxel indices, so that images lie right on
any affine, sheared ones too.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkImagingCore import vtkImageReslice
from vtkmodules.vtkImagingMorphological import vtkImageThresholdConnectivity

from pvfiblets.slices.frames import PlaneGrid

_MODES = {"nearest": 0, "linear": 1, "cubic": 3}  # VTK_RESLICE_NEAREST, VTK_RESLICE_LINEAR, VTK_RESLICE_CUBIC


def reaching_border(mask: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Return the pixels of a mask that are connected, side by side, with the border of the plane."""
    around = np.pad(mask, 1, constant_values=True).view(np.uint8)
    image = vtkImageData()
    image.SetDimensions(around.shape[1], around.shape[0], 1)
    image.GetPointData().SetScalars(numpy_to_vtk(around.reshape(-1)))
    seeds = vtkPoints()
    seeds.InsertNextPoint(0.0, 0.0, 0.0)
    fill = vtkImageThresholdConnectivity()
    fill.SetInputData(image)
    fill.SetSeedPoints(seeds)
    fill.ThresholdByUpper(1.0)
    fill.SetInValue(1.0)
    fill.SetOutValue(0.0)
    fill.Update()
    found = vtk_to_numpy(fill.GetOutput().GetPointData().GetScalars()).reshape(around.shape)
    return np.asarray(found[1:-1, 1:-1] > 0)


class Resampler:
    """What one volume of an image, or some of its components, is at pixels of planes."""

    def __init__(self, values: npt.NDArray[Any], inverse: npt.NDArray[np.float64]) -> None:
        kind = values.dtype
        if kind.kind == "f":
            wanted = np.dtype(np.float32 if kind.itemsize <= 4 else np.float64)
        elif kind.itemsize == 8:
            wanted = np.dtype(np.float64)
        else:
            wanted = kind.newbyteorder("=")
        values = values.astype(wanted, copy=False)
        self._n = values.shape[3] if values.ndim == 4 else 1
        flat = values.reshape(-1, self._n, order="F") if values.ndim == 4 else values.reshape(-1, order="F")
        self._flat = np.ascontiguousarray(flat)  # kept: VTK's array is a view of it
        image = self._image = vtkImageData()
        image.SetDimensions(*values.shape[:3])
        image.GetPointData().SetScalars(numpy_to_vtk(self._flat))
        self._inverse = inverse  # `(4, 4)` mm to voxel indices
        self._reslice = vtkImageReslice()
        self._reslice.SetInputData(image)
        self._reslice.SetOutputDimensionality(2)
        self._reslice.SetOutputSpacing(1.0, 1.0, 1.0)
        self._reslice.SetOutputOrigin(0.0, 0.0, 0.0)
        self._reslice.AutoCropOutputOff()
        self._reslice.TransformInputSamplingOff()
        self._reslice.BorderOn()  # half a voxel beyond the centres of the outer ones, as far as they reach

    def changed(self) -> None:
        """Take note that the values, which are not copied here, have changed."""
        self._image.GetPointData().GetScalars().Modified()
        self._image.Modified()

    def at(self, grid: PlaneGrid, interpolation: str = "linear") -> npt.NDArray[np.float64]:
        """Return what the image is at the pixels of a plane."""
        matrix = vtkMatrix4x4()
        for i, row in enumerate(grid.to_voxels(self._inverse)):
            for j, part in enumerate(row):
                matrix.SetElement(i, j, float(part))
        reslice = self._reslice
        reslice.SetResliceAxes(matrix)
        width, height = grid.shape
        reslice.SetOutputExtent(0, width - 1, 0, height - 1, 0, 0)
        reslice.SetInterpolationMode(_MODES[interpolation])
        reslice.SetOutputScalarType(11)  # VTK_DOUBLE: holds every label, and has a NaN
        reslice.SetBackgroundColor(np.nan, np.nan, np.nan, np.nan)
        reslice.Update()
        found = np.array(vtk_to_numpy(reslice.GetOutput().GetPointData().GetScalars()), np.float64)
        return found.reshape((height, width) if self._n == 1 else (height, width, self._n))

    def value(self, position: npt.ArrayLike, interpolation: str = "linear") -> npt.NDArray[np.float64]:
        """Return what the image is at a position in mm, ``(n,)``; NaN outside of it."""
        unit = np.eye(3)
        corner = np.asarray(position, np.float64) - 0.5 * (unit[0] + unit[1])
        return self.at(PlaneGrid(corner, unit[0], unit[1], (1, 1)), interpolation).reshape(-1)
