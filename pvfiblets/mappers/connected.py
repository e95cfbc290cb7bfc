"""`Connected`: mappers whose data comes through VTK's pipeline, by ``SetInputConnection`` or ``SetInputData``."""

from __future__ import annotations

from typing import Any, ClassVar

from vtkmodules.vtkCommonCore import vtkOutputWindow
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLPolyDataMapper

from pvfiblets.mappers.colouring import Colouring

_BASE: Any = vtkOpenGLPolyDataMapper


class Connected:
    """The part of `pvfiblets.mappers.engine_mapper.EngineMapper` that VTK's pipeline sees.

    VTK is connected to a few triangles (`pvfiblets.mappers.proxy`). Whoever connects something else, from Python or
    C++, is noticed by the mapper's ``ModifiedEvent``, and gets `pvfiblets.mappers.vtk_input.VtkInput` between.
    """

    _drawn: Any
    _error: BaseException | None
    _found: bool
    _follows: bool
    _colouring: Colouring
    # What a shallow copy takes over beside what is drawn.
    COPIED: ClassVar[tuple[str, ...]] = ("_options", "_factory", "_made_with", "_colouring", "_follows", "_effects")

    _NAME: ClassVar[str]

    def _init_input(self) -> None:
        self._input: Any = None
        self._port: Any = None
        self._connecting = False
        self._told = ""
        self._component = -1

    # VTK's side of it

    def _connect(self, proxy: Any) -> None:
        """Have VTK draw triangles that are not put out by a filter."""
        self._connecting = True
        try:
            _BASE.SetInputData(self, proxy)
        finally:
            self._connecting = False
        self._port = _BASE.GetInputConnection(self, 0, 0)

    def _connections_changed(self) -> None:
        """Put the filter between what was connected now and VTK."""
        there = bool(_BASE.GetNumberOfInputConnections(self, 0))
        port = _BASE.GetInputConnection(self, 0, 0) if there else None
        if self._connecting:
            return
        if port is self._port:
            if self._input is not None:
                self._input.retry()
            return
        from pvfiblets.mappers.vtk_input import VtkInput

        self._port = port
        if port is not None and isinstance(port.GetProducer(), VtkInput):
            port = port.GetProducer().GetInputConnection(0, 0)  # a copy of another of these
        if self._input is None:
            self._input = VtkInput(self)
        self._put(None)
        self._input.SetInputConnection(port)
        if port is not None:
            self._port = self._input.GetOutputPort()
            _BASE.SetInputConnection(self, self._port)

    def GetInputConnection(self, port: int, index: int) -> Any:  # noqa: N802 - VTK's name
        """Return what was connected."""
        if self._input is None or self.is_readable:
            return _BASE.GetInputConnection(self, port, index)
        return self._input.GetInputConnection(port, index)

    def GetInputAlgorithm(self, port: int = 0, index: int = 0) -> Any:  # noqa: N802 - VTK's name
        """Return the algorithm that was connected."""
        connection = self.GetInputConnection(port, index)
        return None if connection is None else connection.GetProducer()

    def GetInputDataObject(self, port: int, index: int) -> Any:  # noqa: N802 - VTK's name
        """Return the data that were connected."""
        if self._input is None or self.is_readable:
            return _BASE.GetInputDataObject(self, port, index)
        return self._input.GetInputDataObject(port, index)

    def GetInput(self) -> Any:  # noqa: N802 - VTK's name
        """Return the data that were connected."""
        read = self._input is None or self.is_readable
        return _BASE.GetInput(self) if read else self._input.GetInputDataObject(0, 0)

    def SetArrayComponent(self, component: int) -> None:  # noqa: N802 - VTK's name
        """Colour by that component of vectors; -1 leaves it to the look-up table."""
        self._component = component
        _BASE.SetArrayComponent(self, component)

    def GetArrayComponent(self) -> int:  # noqa: N802 - VTK's name
        """Return what was set: VTK itself sets 0 where it finds no such array in what it draws."""
        return self._component

    def ColorByArrayComponent(self, array: str | int, component: int) -> None:  # noqa: N802 - VTK's name
        """Colour by a component of an array."""
        self._component = component
        _BASE.ColorByArrayComponent(self, array, component)

    def ShallowCopy(self, other: Any) -> None:  # noqa: N802 - VTK's name
        """Become like another mapper: its input, its settings of ``vtkMapper`` and, of one of these, all others.

        Compressed and other data are shared, not copied. Each mapper serves an actor of its own.
        """
        _BASE.ShallowCopy(self, other)
        self._component = other.GetArrayComponent()
        if not isinstance(other, type(self)):
            return
        for name in self.COPIED:
            value = getattr(other, name)
            setattr(self, name, dict(value) if isinstance(value, dict) else value)
        drawn, connected = other._drawn, other._input  # noqa: SLF001  its own kind
        if connected is None:
            self._put(drawn)
        elif drawn is not None:
            self._input.be_like(connected)
        self._install()

    # The mapper's side of it

    def _begin(self) -> None:
        """Find the actor that VTK is about to draw, and follow what has been set since the last draw."""
        self._find_actor()
        if self._input is not None and not self.is_readable:
            self._input.follow()

    def _input_state(self, data: Any) -> tuple[Any, ...]:
        """Return what a picture of some data depends on beside them."""
        if not self._follows:
            return ()
        from pvfiblets.mappers.vtk_scalars import state_of

        return self._property_color(), *state_of(self, data)

    def _property_color(self) -> tuple[float, float, float]:
        return (1.0, 1.0, 1.0) if self.actor is None else self.actor.GetProperty().GetDiffuseColor()

    def _made_of(self, data: Any) -> tuple[Any, Colouring]:
        """Return what to draw of the data that were connected, and its colours."""
        raise NotImplementedError

    def _tell(self, error: BaseException) -> None:
        """Keep an error for `raise_pending`, and say it as VTK says its own."""
        self._error = error
        text = f"{self._NAME}: {error}"
        if text == self._told:
            return  # it would be the same in every frame
        self._told = text
        if _BASE.HasObserver(self, "ErrorEvent"):
            _BASE.InvokeEvent(self, "ErrorEvent", text)
        else:
            vtkOutputWindow.GetInstance().DisplayErrorText(f"ERROR: {text}\n")

    # Of the other parts

    actor: Any

    @property
    def is_readable(self) -> bool:
        """Whether VTK's data are the real lines at this moment."""
        raise NotImplementedError

    def _put(self, drawn: Any, colouring: Colouring | None = None) -> None:
        raise NotImplementedError

    def _find_actor(self) -> None:
        raise NotImplementedError

    def _install(self) -> None:
        raise NotImplementedError
