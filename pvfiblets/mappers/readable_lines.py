"""`Readable`: real lines as a mapper's VTK data for as long as VTK's own code reads them.

VTK is connected to a few triangles that the engine's picture is drawn by. What reads VTK's data instead of drawing
would see these: exporters, pickers that intersect geometry, hardware selection of cells and points, views that draw in
a browser. For these the mapper's input becomes `pvfiblets.mappers.line_data` for a while: lines, or surfaces of tubes,
with the colours that the picture has. `readable` does so for all mappers of a window.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLPolyDataMapper

from pvfiblets.mappers import resolve
from pvfiblets.mappers.scene import actors_in, items_of, to_array, world_planes
from pvfiblets.mappers.windows import contexts_with, weak

__all__ = ["MOST_POINTS", "Readable", "readable"]

_BASE: Any = vtkOpenGLPolyDataMapper

MOST_POINTS = 2_000_000
"""Points that exporters and pickers are given at most: some 60 MB, of which a .gltf or .obj file takes 100 MB."""

_CELLS = 1  # vtkDataObject.FIELD_ASSOCIATION_CELLS; 0 are points

_SETTINGS = ("ScalarVisibility", "ColorMode", "ScalarMode", "InterpolateScalarsBeforeMapping")


class Readable:
    """The part of `pvfiblets.mappers.engine_mapper.EngineMapper` that VTK's code can read.

    A mapper says by ``_readable_points`` how many points its lines have, and by ``_readable_lines`` which they are.
    """

    _drawn: Any
    _input: Any
    _port: Any
    _proxy: Any
    _connecting: bool
    _effects: Any
    actor: Any

    def _init_readable(self) -> None:
        self._before_reading: Any = None  # settings of vtkMapper that come back
        self._drawn_by_vtk = ""  # what for: "selection" or "export"
        self._read_last: tuple[Any, Any] | None = None
        self._selected_from: Any = None
        self._watched: dict[str, Any] = {}

    @property
    def is_readable(self) -> bool:
        """Whether VTK's data are the real lines at this moment."""
        return self._before_reading is not None

    def _readable_points(self) -> int | None:
        """Return how many points the real lines have; None where there are none, as of volumes."""
        return None

    def _points_to_read(self) -> int | None:
        """Return the same of what is connected as well, which VTK may not have asked for yet."""
        if self._drawn is None and self._input is not None:
            self._input.Update()
        return None if self._drawn is None else self._readable_points()

    def _selects_lines(self) -> bool:
        """Whether VTK's selection is to find lines, not the actor: of what is no wider than they are."""
        return False

    def _readable_data(self, budget: int, *, colours: bool, segments: bool) -> vtkPolyData:
        """Return the real lines, with no more points than that."""
        raise NotImplementedError

    def begin_reading(self, data: vtkPolyData, *, drawn: str = "") -> None:
        """Make some PolyData VTK's data.

        Parameters
        ----------
        data : vtkPolyData
            With RGBA as active scalars, or in the colour of the actor's property.
        drawn : {'', 'selection', 'export'}
            What VTK is to draw them for, too.
        """
        if self._before_reading is None:
            self._before_reading = {name: getattr(_BASE, f"Get{name}")(self) for name in _SETTINGS}
        self._connecting = True
        try:
            coloured = data.GetPointData().GetScalars() is not None
            wanted = (int(coloured), 2, 1, 0)  # direct scalars, of points
            for name, value in zip(_SETTINGS, wanted, strict=True):
                getattr(_BASE, f"Set{name}")(self, value)
            _BASE.SetInputData(self, data)
        finally:
            self._connecting = False
        self._port = _BASE.GetInputConnection(self, 0, 0)
        if drawn and not self._drawn_by_vtk:
            self._drawn_by_vtk = drawn
            self._take_out()

    def end_reading(self) -> None:
        """Undo `begin_reading`; twice is harmless."""
        before, self._before_reading = self._before_reading, None
        if before is None:
            return
        self._connecting = True
        try:
            for name, value in before.items():
                getattr(_BASE, f"Set{name}")(self, value)
            if self._input is None:
                _BASE.SetInputData(self, self._proxy)
            else:
                _BASE.SetInputConnection(self, self._input.GetOutputPort())
        finally:
            self._connecting = False
        self._port = _BASE.GetInputConnection(self, 0, 0)
        if self._drawn_by_vtk:
            exported, self._drawn_by_vtk = self._drawn_by_vtk == "export", ""
            self._install()
            if exported:  # by an exporter that rendered
                self._actor_modified()

    def _take_out(self) -> None:
        """Take the shader pieces out of the actor, so that VTK draws its data in its own way."""
        shaders = self._shader_property.Get()
        if shaders is not None:
            resolve.uninstall(shaders, self._installed)
        self._installed = ()

    def readable_data(
        self, *, colours: bool = False, segments: bool = False, budget: int | None = MOST_POINTS
    ) -> vtkPolyData:
        """Return the lines that are shown as PolyData; made anew only when something else is shown.

        Parameters
        ----------
        colours : bool
            Whether with RGBA as the points' active scalars.
        segments : bool
            Whether each segment is a cell, instead of each line.
        budget : int, optional
            Points at most; beyond, streamlines are left out evenly. None for all.

        Returns
        -------
        vtkPolyData
            Lines, surfaces of tubes, or vertices, in data coordinates, with the number of the streamline, tube or
            point as cell data ``'streamline'``.
        """
        count = self._points_to_read()
        if count is None:
            return vtkPolyData()
        budget = count if budget is None else budget
        key = (self._readable_state(colours), segments, min(budget, count))
        if self._read_last is None or not _same(self._read_last[0], key):
            self._read_last = key, self._wrapped(self._readable_data(budget, colours=colours, segments=segments))
        found: vtkPolyData = self._read_last[1]
        return found

    def _wrapped(self, data: vtkPolyData) -> vtkPolyData:
        """Return data as users of the mapper know such."""
        return data

    def _readable_state(self, colours: bool) -> tuple[Any, ...]:
        cuts = world_planes(self).tobytes(), getattr(self, "_region", None)
        placed = b"" if self.actor is None else to_array(self.actor.GetMatrix()).tobytes()
        return (
            self._drawn, self._colouring if colours else None, getattr(self, "_filtering", None),
            getattr(self, "_look", None), *cuts, placed, self._thickness,
        )  # fmt: skip

    @staticmethod
    def _readable_form(lines: Any, radius: float, segments: bool) -> vtkPolyData:
        """Return lines as PolyData, with a radius above 0 as tubes."""
        if radius <= 0.0 or segments:
            return lines.to_polydata(segments=segments)
        from pvfiblets.mappers.line_data import RADIUS, tube_surface

        return tube_surface(lines.with_columns(**{RADIUS: np.full(len(lines.points), radius)}))

    def _within_cuts(self, lines: Any) -> Any:
        """Return lines without what clipping planes and regions cut away."""
        planes, region = self._cuts()
        if region is None and not len(planes):
            return lines
        model = np.eye(4) if self.actor is None else to_array(self.actor.GetMatrix())
        region = None if region is None else region.moved(np.linalg.inv(model))
        planes = planes @ model

        def contains(points: Any) -> Any:
            inside = (points @ planes[:, :3].T + planes[:, 3] >= 0.0).all(axis=1)
            return inside if region is None else inside & region.contains(points)

        return lines.inside(contains)

    def _watch(self, renderer: Any) -> None:
        """Be told when a renderer begins a picture, which may be one of VTK's selection."""
        address = renderer.GetAddressAsString("")
        known = self._watched.get(address)
        if known is None or known.Get() is None:
            self._watched[address] = weak(renderer)
            renderer.AddObserver("StartEvent", _follow(self))

    def _follow_selection(self, selector: Any) -> None:
        """Be real lines while VTK selects cells or points, and be drawn by the engine in every other picture."""
        if self._drawn_by_vtk == "export":
            return
        if selector is None or selector.GetActorPassOnly() or selector.GetFieldAssociation() > _CELLS:
            self.end_reading()
        elif self._drawn_by_vtk != "selection" and self._drawn is not None and self._selects_lines():
            count = self._readable_points()
            if count is not None and count > MOST_POINTS:
                warnings.warn(
                    f"VTK's selection of cells and points says which actor it is, but not which streamline: {count:,} "
                    f"points are more than {MOST_POINTS:,}. plotter.fiblets.enable_picking() finds streamlines of any "
                    "set",
                    UserWarning,
                    stacklevel=2,
                )
            elif count:
                self.end_reading()
                self._selected_from = self.readable_data(segments=True)  # pickers keep its address
                self.begin_reading(self._selected_from, drawn="selection")
                _clear_errors(self, selector)

    def readable_near(self, ray: Any, budget: int) -> vtkPolyData:  # noqa: ARG002 - of fiblets
        """Return lines for a picker: all of them, or if these are too many those near to its ray."""
        return self.readable_data(budget=budget)

    def GetDataSetInput(self) -> Any:  # noqa: N802 - VTK's name
        """Return the lines that are shown as PolyData; while VTK reads or selects, the very data that it looks at."""
        if self.is_readable:
            return _BASE.GetInputDataObject(self, 0, 0)
        if self._input is not None:
            return self._input.GetInputDataObject(0, 0)
        return self.readable_data(budget=None)

    def GetInputAsDataSet(self) -> Any:  # noqa: N802 - VTK's name
        """Return the same, by the older name."""
        return self.GetDataSetInput()

    def GetClassName(self) -> str:  # noqa: N802 - VTK's name
        """Return VTK's own class, or what views in browsers know mappers of this package by."""
        if "trame_vtk.modules.vtk.serializers.registry" not in sys.modules:
            return str(_BASE.GetClassName(self))
        from pvfiblets.mappers.browser_views import class_name

        return class_name(readable_mapper)

    # Of the other parts

    _shader_property: Any
    _installed: tuple[Any, ...]
    _colouring: Any
    _thickness: float
    _cuts: Callable[[], tuple[Any, Any]]
    _install: Callable[[], None]
    _actor_modified: Callable[[], None]


def _follow(mapper: Any) -> Callable[[Any, str], None]:
    """Return an observer of a renderer that does not keep the mapper alive."""
    follower = weak(mapper)

    def started(renderer: Any, _event: str) -> None:
        found: Any = follower.Get()
        selector = renderer.GetSelector()
        if found is not None and (selector is not None or found.is_readable):
            found._follow_selection(selector)  # noqa: SLF001 - this module's own

    return started


def _clear_errors(mapper: Any, selector: Any) -> None:
    """Drop, after a selection, the error of OpenGL that VTK leaves when its data become lines after triangles.

    It binds a buffer that it has deleted (9.7, mappers of its own too); who asks next would take the error for his own.
    """
    follower = weak(mapper)

    def ended(ended_selector: Any, _event: str) -> None:
        ended_selector.RemoveObserver(tag)  # pickers keep their selector, and select again
        found: Any = follower.Get()
        for context in [] if found is None else contexts_with(found):
            if context.alive:
                context.window.MakeCurrent()
                context.ctx.clear_errors()

    tag = selector.AddObserver("EndEvent", ended)


def _same(one: tuple[Any, ...], other: tuple[Any, ...]) -> bool:
    """Whether two states are of the same objects, or of equal numbers."""
    if len(one) != len(other):
        return False
    pairs = zip(one, other, strict=True)
    return all(
        _same(a, b) if isinstance(a, tuple) and isinstance(b, tuple)
        else a is b or (isinstance(a, (bytes, float, int)) and isinstance(b, (bytes, float, int)) and a == b)
        for a, b in pairs
    )  # fmt: skip


@contextmanager
def readable(window: Any, *, most: int = MOST_POINTS) -> Iterator[None]:
    """Let VTK's code read what mappers of this package show in a window, as lines with the colours of the picture.

    Exporters of VTK (``vtkGLTFExporter`` and its like) and PyVista's ``export_*`` do so by themselves.

    Parameters
    ----------
    window : vtkRenderWindow
    most : int
        Points of all lines together; beyond, streamlines are left out evenly, and a warning says so.

    Warns
    -----
    UserWarning
        Of streamlines that are left out, of volumes, which have no lines, and of colours that depend on the view.

    Examples
    --------
    >>> from pvfiblets.mappers import readable
    >>> with readable(plotter.render_window):                                                    # doctest: +SKIP
    ...     exporter.Write()
    """
    actors = [actor for actor in _actors_of(window) if isinstance(actor.GetMapper(), Readable)]
    mappers = [(actor, actor.GetMapper()) for actor in actors if not actor.GetMapper().is_readable]
    counts = [mapper._points_to_read() for _, mapper in mappers]  # noqa: SLF001 - this module's own
    total = sum(count or 0 for count in counts)
    with ExitStack() as undo:
        for (_, mapper), count in zip(mappers, counts, strict=True):
            share = count if total <= most else int((count or 0) * (most / total))
            undo.callback(mapper.end_reading)
            data = vtkPolyData() if count is None else mapper._readable_data(share, colours=True, segments=False)  # noqa: SLF001
            mapper.begin_reading(data, drawn="export")
        _tell([(a, m) for (a, m), count in zip(mappers, counts, strict=True) if count is None], total, most, mappers)
        yield


@contextmanager
def readable_mapper(mapper: Any) -> Iterator[None]:
    """Let VTK's code read what one mapper shows, as often as it likes."""
    data = mapper.readable_data(colours=True)
    count = mapper._points_to_read()  # noqa: SLF001 - this module's own
    _tell([(mapper.actor, mapper)] if count is None else [], count or 0, MOST_POINTS, [(mapper.actor, mapper)])
    mapper.begin_reading(data)
    try:
        yield
    finally:
        mapper.end_reading()


def _tell(without: list[Any], total: int, most: int, mappers: list[Any]) -> None:
    """Warn of what is not as in the picture."""
    depth = 5
    if total > most:
        warnings.warn(
            f"the export holds {most:,} of {total:,} points at most: streamlines are left out evenly; "
            "`with pvfiblets.mappers.readable(plotter.render_window, most=...):` around it exports more",
            UserWarning,
            stacklevel=depth,
        )
    shown = [actor for actor, mapper in without if mapper._drawn is not None]  # noqa: SLF001
    named = [repr(getattr(actor, "name", actor.GetClassName())) for actor in shown]
    if named:
        warnings.warn(
            f"the export lacks what rays are cast through ({', '.join(named)}): it has no lines; export surfaces of "
            "it (ImageData.contour), or a picture",
            UserWarning,
            stacklevel=depth,
        )
    if any(mapper._colouring.mode == "pixel_count" for _, mapper in mappers):  # noqa: SLF001
        warnings.warn(
            "the number of lines in a pixel depends on the view: the export has colours of orientation instead",
            UserWarning,
            stacklevel=depth,
        )


def _actors_of(window: Any) -> list[Any]:
    """Return the actors that a window shows, each once."""
    found: dict[str, Any] = {}
    for renderer in items_of(window.GetRenderers()):
        for prop in items_of(renderer.GetViewProps()):
            found |= {actor.GetAddressAsString(""): actor for actor in actors_in(prop) if actor.GetVisibility()}
    return list(found.values())
