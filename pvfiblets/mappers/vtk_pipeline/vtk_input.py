"""`VtkInput`: what a mapper draws comes through VTK's pipeline, as it does to every mapper of VTK.

VTK draws a few triangles that stand for the lines (`pvfiblets.mappers.vtk_pipeline.proxy`), so these triangles are what
its own half of the mapper must be connected to. A filter stands between: it takes the lines that the user connects, has
the mapper make the engine's data of them, and puts out the triangles. VTK executes it as it does any other filter,
before bounds are computed and before a draw, when something upstream has changed.
"""

from __future__ import annotations

from typing import Any

from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonDataModel import vtkPolyData

from pvfiblets.mappers.frames.scene import weak


class VtkInput(VTKPythonAlgorithmBase):
    """The filter between what a user connects and a mapper."""

    def __init__(self, mapper: Any) -> None:
        super().__init__(nInputPorts=1, inputType="vtkDataObject", nOutputPorts=1, outputType="vtkPolyData")
        self._mapper = weak(mapper)  # its `_made_of(data)` returns what to draw and its colouring
        self._state: Any = None
        self._failed = False
        self.executing = False

    def RequestData(self, _request: Any, inputs: Any, outputs: Any) -> int:  # noqa: N802 - VTK's name
        """Read the connected data, if they or their settings have changed."""
        mapper: Any = self._mapper.Get()
        if mapper is None:
            return 1
        self.executing = True
        try:
            mapper._link.find()  # noqa: SLF001  its other half
            self._take(mapper, self.GetInputData(inputs, 0, 0))
        except Exception as error:  # noqa: BLE001  VTK would swallow it
            mapper._put(None)  # noqa: SLF001
            mapper._tell(error)  # noqa: SLF001
        finally:
            self.executing = False
        vtkPolyData.GetData(outputs).ShallowCopy(mapper._connection.proxy)  # noqa: SLF001
        return 1

    def _take(self, mapper: Any, data: Any) -> None:
        if data is None:
            raise TypeError("nothing is connected; use SetInputConnection or SetInputData")
        state = self._state_of(mapper, data)
        if state != self._state:
            self._state, self._failed = state, True
            drawn, colouring = mapper._made_of(data)  # noqa: SLF001
            mapper._put(drawn, colouring)  # noqa: SLF001
            # The range of the look-up table may have become the mapper's.
            self._state, self._failed = self._state_of(mapper, data), False

    @staticmethod
    def _state_of(mapper: Any, data: Any) -> tuple[Any, ...]:
        # No two objects of VTK's have been modified at the same time: that of the data says which they are.
        return data.GetMTime(), *mapper._input_state(data)  # noqa: SLF001

    def follow(self) -> None:
        """Execute again before the next draw if colours or the property have changed that the picture follows."""
        mapper, data = self._mapper.Get(), self.GetInputDataObject(0, 0)
        if mapper is not None and data is not None and self._state != self._state_of(mapper, data):
            self.Modified()

    def retry(self) -> None:
        """Apply the settings of an empty mapper, which VTK does not draw."""
        if self._failed:
            self.follow()

    def be_like(self, other: VtkInput) -> None:
        """Take over what the same data has made already, so that it need not be made twice."""
        mapper: Any = self._mapper.Get()
        twin: Any = other._mapper.Get()
        self._state, self.executing = other._state, True
        mapper._put(twin._drawn, twin._colouring)  # noqa: SLF001
        self.executing = False
        self.Modified()
