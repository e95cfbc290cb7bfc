"""`Connection`: what VTK's half of a mapper is connected to.

Mostly a few triangles that stand for the drawable (`pvfiblets.mappers.vtk_pipeline.proxy`). Any other connection, by
``SetInputConnection`` or ``SetInputData`` from Python or C++, is noticed by the mapper's ``ModifiedEvent``, and gets a
filter between (`pvfiblets.mappers.vtk_pipeline.vtk_input.VtkInput`). While VTK's code reads real lines, these are
connected.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from vtkmodules.vtkRenderingCore import vtkMapper
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLPolyDataMapper

from pvfiblets.mappers.frames.scene import weak

if TYPE_CHECKING:
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from pvfiblets.mappers.vtk_pipeline.vtk_input import VtkInput

_BASE: Any = vtkOpenGLPolyDataMapper

_SETTINGS = ("ScalarVisibility", "ColorMode", "ScalarMode", "InterpolateScalarsBeforeMapping")


class Connection:
    """The input of VTK's half of a mapper; the mapper is not kept alive."""

    proxy: vtkPolyData | None = None  # the triangles
    input: VtkInput | None = None  # the filter with the user's data; None without a connection

    def __init__(self, mapper: vtkMapper) -> None:
        self._mapper = weak(mapper)
        self._port: Any = None
        self._connecting = False
        self._settings: dict[str, Any] | None = None  # of vtkMapper, while real lines are connected

    @property
    def is_readable(self) -> bool:
        """Whether VTK's data are the real lines at this moment."""
        return self._settings is not None

    def show(self, proxy: vtkPolyData | None, *, connect: bool) -> None:
        """Connect other triangles; where no filter puts them out, ``connect`` decides whether to do so yet."""
        self.proxy = proxy
        if self.input is not None:
            if not self.input.executing:
                self.input.Modified()
        elif connect:
            with self._own_change():
                _BASE.SetInputData(self._mapper.Get(), proxy)

    @contextmanager
    def _own_change(self) -> Iterator[None]:
        """Connect internal data meanwhile, with VTK's own methods instead of the mapper's overrides."""
        self._connecting = True
        try:
            yield
        finally:
            self._connecting = False
        self._port = _BASE.GetInputConnection(self._mapper.Get(), 0, 0)

    def changed(self) -> None:
        """Put the filter between the new connection and VTK."""
        mapper: Any = self._mapper.Get()
        there = bool(_BASE.GetNumberOfInputConnections(mapper, 0))
        port = _BASE.GetInputConnection(mapper, 0, 0) if there else None
        if self._connecting:
            return
        if port is self._port:
            if self.input is not None:
                self.input.retry()
            return
        from pvfiblets.mappers.vtk_pipeline.vtk_input import VtkInput

        self._port = port
        if port is not None and isinstance(port.GetProducer(), VtkInput):
            port = port.GetProducer().GetInputConnection(0, 0)  # a copy of another of these
        if self.input is None:
            self.input = VtkInput(mapper)
        mapper._put(None)  # noqa: SLF001  its other half
        self.input.SetInputConnection(port)
        if port is not None:
            self._port = port = self.input.GetOutputPort()
            _BASE.SetInputConnection(mapper, port)

    def begin_reading(self, data: vtkPolyData) -> None:
        """Connect real lines, with RGBA as active scalars or in the colour of the actor's property."""
        mapper = self._mapper.Get()
        if self._settings is None:
            self._settings = {name: getattr(_BASE, f"Get{name}")(mapper) for name in _SETTINGS}
        coloured = data.GetPointData().GetScalars() is not None
        wanted = (int(coloured), 2, 1, 0)  # direct scalars, of points
        with self._own_change():
            for name, value in zip(_SETTINGS, wanted, strict=True):
                getattr(_BASE, f"Set{name}")(mapper, value)
            _BASE.SetInputData(mapper, data)

    def end_reading(self) -> None:
        """Restore the earlier connection; a second call has no effect."""
        before, self._settings = self._settings, None
        if before is None:
            return
        mapper = self._mapper.Get()
        with self._own_change():
            for name, value in before.items():
                getattr(_BASE, f"Set{name}")(mapper, value)
            if self.input is None:
                _BASE.SetInputData(mapper, self.proxy)
            else:
                _BASE.SetInputConnection(mapper, self.input.GetOutputPort())
