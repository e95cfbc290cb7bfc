"""The actor that ``plotter.add_spline_tubes`` returns: an ordinary PyVista actor with live colours."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.lines import SourceData
from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.effects.shading import Silhouette
from pvfiblets.mappers.tubes import TubeMapper, TubeOptions
from pvfiblets.plotting.actors.coloured import added_up
from pvfiblets.plotting.actors.mapper_words import PlottedLines
from pvfiblets.plotting.colours.opacities import LineActor
from pvfiblets.plotting.filtering.line_subject import LineSubject
from pvfiblets.plotting.filtering.state import Choices
from pvfiblets.plotting.settings.places import OPTIONS
from pvfiblets.plotting.settings.settings import Given
from pvfiblets.plotting.tubes.parts import tube_parts
from pvfiblets.plotting.tubes.settings import TubeSettings
from pvfiblets.plotting.tubes.sources import find_tube_scalars, with_built_in, with_node_values
from pvfiblets.tubes.spline_tubes import SplineTubes

if TYPE_CHECKING:
    from pvfiblets.plotting.colours.scalars import Scalars


_OUTLINE = {"color": "white", "width": 2.0, "tubes": None}


class PlottedSplines(PlottedLines[TubeOptions], TubeMapper):
    """A mapper of spline tubes with scalar bars."""


class TubeActor(TubeSettings, LineActor):
    """Tubes of varying radius around Hermite splines, ray cast to their exact surface.

    Everything of :class:`pyvista.Actor` works (``visibility``, ``position``, ``user_matrix``,
    ``pickable``, ``prop`` with its ``specular`` and so on). The properties below may be set at any
    time and take effect at the next render.

    Parameters
    ----------
    tubes : SplineTubes
        What to draw.
    scalars : str or array, optional
        As for :attr:`scalars`.
    settings : mapping, optional
        Arguments of ``plotter.add_spline_tubes`` that are settings, by name.
    name : str, optional
        Name of the actor in the plotter.
    theme : pyvista theme, optional
        Defaults of omitted settings.
    data : SourceData, optional
        More arrays that criteria and scalars may name.

    Notes
    -----
    Source: Russig, Gumhold and Salm, "GPU-based raycasting of Hermite spline tubes" (2020).
    """

    _mapper: PlottedSplines
    _DATA = "tubes"
    _WIDTH = "tubes have a radius in mm, given as radius; actor.min_width is in pixels"

    def __init__(
        self,
        tubes: SplineTubes,
        *,
        scalars: str | np.ndarray | None = None,
        settings: Mapping[str, Any] | None = None,
        name: str | None = None,
        theme: Any = None,
        data: SourceData | None = None,
    ) -> None:
        given = Given(TubeSettings, settings)
        self._data = SourceData() if data is None else data
        self._tubes, scalars = with_node_values(_checked(tubes), scalars, data=self._data)
        self._shown = with_built_in(self._tubes, scalars)  # what is computed for colours is not the user's
        mapper = PlottedSplines(self._shown, options=TubeOptions(**given.at(OPTIONS)))
        self._choices = Choices()
        self._subject = _subject_of(self._tubes, self._data, mapper)
        super().__init__(mapper, scalars, given, name=name, theme=theme)
        self._recolour()
        self.opacity = given["opacity"]
        self._take(given)

    def __repr__(self) -> str:
        colours = "one colour" if self._scalars is None else self._scalars.name
        return f"<{type(self).__name__} {self.name!r}: {self._tubes!r}, coloured by {colours}>"

    # Data ---------------------------------------------------------------------------------------

    @property
    def tubes(self) -> SplineTubes:
        """The drawn data; can be replaced.

        Computed scalars, such as ``"radius"``, are computed again.
        """
        return self._tubes

    @tubes.setter
    def tubes(self, tubes: SplineTubes) -> None:
        tubes, choice = with_node_values(_checked(tubes), self._choice)
        shown = with_built_in(tubes, choice)
        found = self._find(shown, choice)
        same = tubes.n_tubes == self._tubes.n_tubes and np.array_equal(tubes.segments, self._tubes.segments)
        data = self._data if same else SourceData()
        with self._choosing_from(_subject_of(tubes, data, self._mapper)):
            self._data = data
            self._draw(tubes, shown)
            self._choice = choice
            self._show(found)

    @property
    def scalars(self) -> str | np.ndarray | None:
        """Source of the colours; ``None`` for one colour.

        A name in ``tubes.values``, ``tubes.tube_values`` or of an array of the source; ``"radius"``
        (mm), ``"arc_length"`` (mm from the tube's first node), ``"length"`` (mm, of the whole tube),
        ``"orientation"`` (the absolute direction as red, green, blue); or an array with one number or
        one colour (3 or 4 columns) per node or per tube.
        """
        return self._choice

    @scalars.setter
    def scalars(self, scalars: Any) -> None:
        tubes, scalars = with_node_values(self._tubes, scalars, data=self._data)
        shown = with_built_in(self._shown if tubes is self._tubes else tubes, scalars)
        found = self._find(shown, scalars)
        if shown is not self._shown:
            self._draw(tubes, shown)
        self._colour_by(scalars, found)

    def _made_with(self) -> dict[str, Any]:
        return {"tubes": self._tubes, "scalars": self._choice, "data": self._data}

    def explain(self) -> dict[str, Any]:
        """Return what is active for this actor and what it costs, over all windows that show it.

        Returns
        -------
        dict
            ``passes``: name and milliseconds of the last redraw; ``features``: pieces of the
            shaders in use; ``buffers``: name and bytes of what lies on the GPU; ``gpu_bytes``:
            their sum; ``tubes_total``, ``segments_total``; ``primitives``: triangles of the last
            redraw without culling, 0 before the first; ``silhouettes``, ``solver``, ``iterations``,
            ``culling``: those in use, ``None`` before the first frame; ``streamlines``: tubes in
            ``total`` and ``shown``; ``criteria``, ``conditions``, ``groups_shown``, ``clips``.
        """
        report = self._mapper.explain()
        total = added_up(report)
        del total["fiblets"]
        windows = report["windows"]
        latest = windows[-1] if windows else {}
        return {
            **total,
            "tubes_total": self._tubes.n_tubes,
            "segments_total": self._tubes.n_segments,
            "primitives": sum(window.get("primitives", 0) for window in windows),
            "silhouettes": self._mapper.pipeline_in_use,
            "solver": latest.get("solver"),
            "iterations": latest.get("iterations"),
            "culling": latest.get("culling"),
            **self._explain_choices(),
        }

    def pick_at(self, x: int, y: int) -> tuple[int, float] | None:
        """Return the segment at a window pixel, and the position along it.

        Parameters
        ----------
        x, y : int
            Pixel, counted from the lower left corner.

        Returns
        -------
        tuple of (int, float) or None
            Row of ``tubes.segments``, and the segment's parameter, from 0 to 1, at the visible surface.
            ``tubes.tubes[row]`` is the segment's tube. ``None`` if the pixel shows no tube of this actor.
        """
        return self._mapper.pick_at(x, y)

    def _read_silhouette(self) -> dict[str, Any] | bool:
        return self._shades.get("silhouette", False)

    def _write_silhouette(self, wanted: Mapping[str, Any] | bool | None) -> None:
        if wanted is None or wanted is False:
            self._shades.pop("silhouette", None)
            self._mapper.set_effect("silhouette", None)
            return
        if wanted is not True and not isinstance(wanted, Mapping):
            raise ValueError(f"silhouette is {wanted!r}; give True, False or a dict of settings")
        settings = {**_OUTLINE, **({} if wanted is True else wanted)}
        if unknown := sorted(set(settings) - set(_OUTLINE)):
            raise ValueError(f"silhouette has no settings {unknown}; it has {list(_OUTLINE)}")
        chosen = np.full(self._tubes.n_tubes, settings["tubes"] is None)
        if settings["tubes"] is not None:
            given = np.asarray(settings["tubes"])
            try:
                chosen[given if given.size else given.astype(np.int64)] = True
            except IndexError as error:
                raise IndexError(
                    f"tubes of the silhouette are {settings['tubes']!r}; give numbers from 0 to "
                    f"{len(chosen) - 1}, or a mask of {len(chosen)}"
                ) from error
        color = pv.Color(settings["color"]).float_rgb
        self._mapper.set_effect("silhouette", Silhouette(chosen, color, settings["width"]))
        self._shades["silhouette"] = settings

    # Inside -------------------------------------------------------------------------------------

    @property
    def _drawn(self) -> SplineTubes:
        return self._shown

    def _as_polydata(self) -> pv.PolyData:
        pairs = np.insert(np.asarray(self._tubes.segments, np.int64), 0, 2, axis=1)
        lines = pv.PolyData(np.asarray(self._tubes.points), lines=pairs.ravel())
        lines["radius"] = np.asarray(self._tubes.radius)
        for name, values in self._tubes.values.items():
            lines[name] = np.asarray(values.values)
        return lines

    def _draw(self, tubes: SplineTubes, shown: SplineTubes) -> None:
        """Give the mapper other tubes, ``shown``; colours for another number of tubes go first."""
        if tubes.n_tubes != self._tubes.n_tubes:
            self._mapper.colouring = Colouring("solid")
        self._mapper.set_tubes(shown)
        before, self._tubes, self._shown = self._tubes, tubes, shown
        self._subject = _subject_of(tubes, self._data, self._mapper)
        outline = self.silhouette
        if before.n_tubes != tubes.n_tubes and isinstance(outline, dict):
            self.silhouette = outline["tubes"] is None and outline  # numbers mean other tubes now

    def _find(self, tubes: SplineTubes, choice: Any) -> Scalars | None:
        return None if choice is None else find_tube_scalars(tubes, choice, self._data)


def _subject_of(tubes: SplineTubes, data: SourceData, mapper: PlottedSplines) -> LineSubject:
    return LineSubject(mapper, lambda: tube_parts(tubes, data))


def _checked(tubes: Any) -> SplineTubes:
    if not isinstance(tubes, SplineTubes):
        raise TypeError(
            f"tubes are a {type(tubes).__name__}; give SplineTubes, which pvfiblets.tubes.build.as_spline_tubes "
            "makes of lines"
        )
    return tubes
