"""`LineReading`: real lines as a mapper's VTK data for as long as VTK's own code reads them.

VTK is connected to a few triangles that the engine's picture is drawn by. What reads VTK's data instead of drawing
would see these: exporters, pickers that intersect geometry, hardware selection of cells and points, views that draw in
a browser. For these the mapper's input becomes `pvfiblets.mappers.line_data` for a while: lines, or surfaces of tubes,
with the colours that the picture has. `readable` does so for all mappers of a window.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Any, cast

from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkCommonDataModel import vtkPolyData

from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.mappers.frames.scene import actors_in, items_of, to_array, weak, world_planes
from pvfiblets.mappers.frames.windows import contexts_with

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkHardwareSelector, vtkRenderer, vtkRenderWindow

    from pvfiblets.mappers.engine_mapper import EngineMapper
    from pvfiblets.mappers.vtk_pipeline.actor_link import ActorLink
    from pvfiblets.mappers.vtk_pipeline.connection import Connection

MOST_POINTS = 2_000_000  # most points for exporters and pickers: some 60 MB, or 100 MB as a .gltf or .obj file

_CELLS = 1  # vtkDataObject.FIELD_ASSOCIATION_CELLS; 0 are points


class LineReading:
    """Real lines as VTK's data of one mapper, which is not kept alive, for a while."""

    purpose = ""  # VTK's purpose of drawing the lines: `"selection"`, `"export"`, or nothing

    def __init__(self, mapper: EngineMapper[Any], connection: Connection, link: ActorLink) -> None:
        self._weak = weak(mapper)
        self._connection, self._link = connection, link
        self._last: tuple[tuple[Any, ...], vtkPolyData] | None = None
        self._selected_from: vtkPolyData | None = None
        self._watched: dict[str, Any] = {}

    @property
    def mapper(self) -> EngineMapper[Any]:
        """Mapper of the lines."""
        return cast("EngineMapper[Any]", self._weak.Get())

    @property
    def points(self) -> int | None:
        """Number of points of the lines; None without lines, as for volumes."""
        mapper = self.mapper
        if mapper._drawn is None and self._connection.input is not None:  # noqa: SLF001
            self._connection.input.Update()
        return None if mapper._drawn is None else mapper._readable_points()  # noqa: SLF001

    def begin(self, data: vtkPolyData, *, purpose: str = "") -> None:
        """Make some PolyData VTK's data, which VTK draws if there is a purpose."""
        self._connection.begin_reading(data)
        if purpose and not self.purpose:
            self.purpose = purpose
            self._link.take_out()

    def end(self) -> None:
        """Undo `begin`; twice is harmless."""
        self._connection.end_reading()
        purpose, self.purpose = self.purpose, ""
        if purpose:
            self._link.install()
        if purpose == "export":  # by an exporter that rendered
            self._link.modified()

    def data(self, *, colours: bool = False, segments: bool = False, budget: int | None = MOST_POINTS) -> vtkPolyData:
        """Return the lines that are shown, made anew only when something else is shown."""
        # `colours`: with RGBA as active scalars of the points. `segments`: a cell for each segment, not each line.
        # Streamlines are left out evenly beyond `budget` points; None is without limit. Cell data `'streamline'` are
        # the numbers of streamlines, tubes or points.
        mapper, count = self.mapper, self.points
        if count is None:
            return vtkPolyData()
        budget = count if budget is None else budget
        key = (self._state(colours), segments, min(budget, count))
        if self._last is None or not _same(self._last[0], key):
            lines = mapper._readable_data(budget, colours=colours, segments=segments)  # noqa: SLF001
            self._last = key, mapper._wrapped(lines)  # noqa: SLF001
        return self._last[1]

    def near(self, ray: Any, budget: int) -> vtkPolyData:
        """Return lines for a picker: all of them, or if these are too many those near to its ray."""
        found = self.mapper._readable_near(ray, budget)  # noqa: SLF001
        return self.data(budget=budget) if found is None else self.mapper._wrapped(found)  # noqa: SLF001

    def _state(self, colours: bool) -> tuple[Any, ...]:
        mapper, actor = self.mapper, self._link.actor
        cuts = world_planes(mapper).tobytes(), getattr(mapper, "_region", None)
        placed = b"" if actor is None else to_array(actor.GetMatrix()).tobytes()
        return (
            mapper._drawn, mapper.colouring if colours else None, getattr(mapper, "_filtering", None),  # noqa: SLF001
            getattr(mapper, "_look", None), *cuts, placed, mapper._thickness, mapper.ink,  # noqa: SLF001
            getattr(mapper, "ends", False),
        )  # fmt: skip

    def watch(self, renderer: vtkRenderer) -> None:
        """Handle the start of a renderer's picture, which may be one of VTK's selection."""
        address = renderer.GetAddressAsString("")
        known = self._watched.get(address)
        if known is None or known.Get() is None:
            self._watched[address] = weak(renderer)
            # Or the renderer would keep the data of a mapper gone.
            observe(renderer, ("StartEvent",), weakly(self._follow_selection, passing=True))

    def _follow_selection(self, renderer: vtkRenderer, _event: str) -> None:
        """Be real lines while VTK selects cells or points, and be drawn by the engine in every other picture."""
        mapper, selector = self.mapper, renderer.GetSelector()
        if self.purpose == "export":
            return
        if selector is None or selector.GetActorPassOnly() or selector.GetFieldAssociation() > _CELLS:
            self.end()
        elif self.purpose != "selection" and mapper._drawn is not None and mapper._selects_lines():  # noqa: SLF001
            count = self.points
            if count is not None and count > MOST_POINTS:
                warnings.warn(
                    f"VTK's selection of cells and points says which actor it is, but not which streamline: {count:,} "
                    f"points are more than {MOST_POINTS:,}. plotter.fiblets.enable_picking() finds streamlines of any "
                    "set",
                    UserWarning,
                    stacklevel=2,
                )
            elif count:
                self.end()
                self._selected_from = self.data(segments=True)  # pickers keep its address
                self.begin(self._selected_from, purpose="selection")
                _clear_errors(mapper, selector)


def reading_of(mapper: Any) -> LineReading | None:
    """Return the lines of a mapper of this package; None for another mapper."""
    found = getattr(mapper, "reading", None)
    return found if isinstance(found, LineReading) else None


def _clear_errors(mapper: Any, selector: vtkHardwareSelector) -> None:
    """Drop, after a selection, the error of OpenGL that VTK leaves when its data become lines after triangles."""
    # It binds a buffer that it has deleted (9.7, mappers of its own too); the next caller would see the error.
    follower = weak(mapper)

    def ended(ended_selector: Any, _event: str) -> None:
        ended_selector.RemoveObserver(tag)  # pickers keep their selector, and select again
        found: Any = follower.Get()
        for context in [] if found is None else contexts_with(found):
            if context.alive:
                context.window.MakeCurrent()
                context.ctx.clear_errors()

    tag = selector.AddObserver(vtkCommand.EndEvent, ended)


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
def readable(window: vtkRenderWindow, *, most: int = MOST_POINTS) -> Iterator[None]:
    """Make a window's lines of this package readable for VTK's code, with the colours of the picture.

    Exporters of VTK (``vtkGLTFExporter`` and its like) and PyVista's ``export_*`` do so by themselves.

    Parameters
    ----------
    window : vtkRenderWindow
    most : int
        Greatest number of points of all lines; beyond, streamlines are left out evenly, with a warning.

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
    found = [reading_of(actor.GetMapper()) for actor in _actors_of(window)]
    readings = [reading for reading in found if reading is not None and not reading.mapper.is_readable]
    counts = [reading.points for reading in readings]
    total = sum(count or 0 for count in counts)
    with ExitStack() as undo:
        for reading, count in zip(readings, counts, strict=True):
            share = count if total <= most else int((count or 0) * (most / total))
            undo.callback(reading.end)
            data = vtkPolyData()
            if share is not None:
                data = reading.mapper._readable_data(share, colours=True, segments=False)  # noqa: SLF001
            reading.begin(data, purpose="export")
        _tell(readings, counts, total, most)
        yield


@contextmanager
def readable_mapper(mapper: EngineMapper[Any]) -> Iterator[None]:
    """Make one mapper's lines readable for VTK's code, any number of times."""
    reading = mapper.reading
    data, count = reading.data(colours=True), reading.points
    _tell([reading], [count], count or 0, MOST_POINTS)
    reading.begin(data)
    try:
        yield
    finally:
        reading.end()


def _tell(readings: list[LineReading], counts: list[int | None], total: int, most: int) -> None:
    """Warn of differences from the frame."""
    depth = 5
    if total > most:
        warnings.warn(
            f"the export holds {most:,} of {total:,} points at most: streamlines are left out evenly; "
            "`with pvfiblets.mappers.readable(plotter.render_window, most=...):` around it exports more",
            UserWarning,
            stacklevel=depth,
        )
    without = [reading.mapper for reading, count in zip(readings, counts, strict=True) if count is None]
    actors: list[Any] = [mapper.actor for mapper in without if mapper._drawn is not None]  # noqa: SLF001
    named = [repr(getattr(actor, "name", actor.GetClassName())) for actor in actors]
    if named:
        warnings.warn(
            f"the export lacks what rays are cast through ({', '.join(named)}): it has no lines; export surfaces of "
            "it (ImageData.contour), or a picture",
            UserWarning,
            stacklevel=depth,
        )
    if any(reading.mapper.colouring.mode == "pixel_count" for reading in readings):
        warnings.warn(
            "the number of lines in a pixel depends on the view: the export has colours of orientation instead",
            UserWarning,
            stacklevel=depth,
        )


def _actors_of(window: vtkRenderWindow) -> list[Any]:
    """Return the actors that a window shows, each once."""
    found: dict[str, Any] = {}
    for renderer in items_of(window.GetRenderers()):
        for prop in items_of(renderer.GetViewProps()):
            found |= {actor.GetAddressAsString(""): actor for actor in actors_in(prop) if actor.GetVisibility()}
    return list(found.values())
