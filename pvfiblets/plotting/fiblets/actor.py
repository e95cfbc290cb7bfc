"""The actor that ``plotter.add_fiblets`` returns: an ordinary PyVista actor with live colours."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.codec.editing.point_arrays import with_point_values as add_values
from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.effects.depth_peeling import Layers
from pvfiblets.mappers.effects.line_light import LegendColours, LineLight
from pvfiblets.mappers.effects.line_tubes import Tubes, TubeShading
from pvfiblets.mappers.effects.shading import Ink
from pvfiblets.mappers.engine_options import EngineOptions
from pvfiblets.mappers.fiblets import FibletMapper
from pvfiblets.plotting.actors.coloured import added_up
from pvfiblets.plotting.actors.linked_property import own_writes
from pvfiblets.plotting.actors.mapper_words import PlottedLines
from pvfiblets.plotting.actors.shading import BACKGROUND
from pvfiblets.plotting.colours.colours import limits
from pvfiblets.plotting.colours.scalars import Scalars, refuse_numbers
from pvfiblets.plotting.fiblets.filtering import FibletSubject
from pvfiblets.plotting.fiblets.looks import PLAIN, look_of, settings_of
from pvfiblets.plotting.fiblets.opacities import Opacities, find_opacities
from pvfiblets.plotting.fiblets.pick_result import Picked, checked_box, everything, visible
from pvfiblets.plotting.fiblets.scalars import find_fiblet_scalars
from pvfiblets.plotting.fiblets.selection import SelectableActor
from pvfiblets.plotting.fiblets.settings import ALL, STYLES, THINNEST, TONES, WIDEST, FibletSettings
from pvfiblets.plotting.fiblets.sources import as_fiblets, with_point_values
from pvfiblets.plotting.filtering.state import Choices
from pvfiblets.plotting.settings.places import OPTIONS
from pvfiblets.plotting.settings.settings import Given
from pvfiblets.query.measures.even_sample import mean_direction

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource

_LIGHT = "light"
_ROUND = "tube_shading"
_LAYERS = "layers"
_DENSITY = "density"
_ENDS = "ends"
_COUNTS = Scalars("density", "pixel_count")
_SOME_LAYERS = 4


def _layers(transparency: Any) -> Layers:
    """Return the effect of a number of layers, or of ``'layers'``."""
    return Layers(_SOME_LAYERS if transparency == "layers" else transparency)


class PlottedMapper(PlottedLines[EngineOptions], FibletMapper):
    """A fiblet mapper with scalar bars."""


class FibletActor(FibletSettings, SelectableActor):
    """Streamlines rendered from their compressed form.

    Everything of :class:`pyvista.Actor` works (``visibility``, ``position``, ``user_matrix``,
    ``pickable``, ``prop`` …). The properties below may be set at any time and take effect at the
    next render.

    Parameters
    ----------
    fiblets : FibletSet
        What to draw.
    scalars : str, array or VolumeSource, optional
        As for ``plotter.add_fiblets``.
    settings : mapping, optional
        Arguments of ``plotter.add_fiblets`` that are settings, by name.
    name : str, optional
        Under which the plotter knows the actor.
    theme : pyvista theme, optional
        Source of defaults.
    progress : bool, default: False
        Show a progress bar while copying to the GPU.
    """

    _DATA = "fiblets"

    def __init__(
        self,
        fiblets: FibletSet,
        *,
        scalars: Any = None,
        settings: Mapping[str, Any] | None = None,
        name: str | None = None,
        theme: Any = None,
        progress: bool = False,
    ) -> None:
        given = Given(FibletSettings, settings)
        self._fiblets, self._rgb = fiblets, given["rgb"]
        self._style = STYLES[0]
        self._tone = TONES[0]
        self._transparency: str | int | None = None  # until it is set
        self._choices = Choices()
        mapper = PlottedMapper(fiblets, options=EngineOptions(**given.at(OPTIONS)), progress=progress)
        self._subject = FibletSubject(fiblets, mapper)
        super().__init__(mapper, scalars, given, name=name, theme=theme)
        self.line_width = self._theme.line_width if given["line_width"] is None else given["line_width"]
        self._recolour()
        self.opacity = self._theme.opacity if given["opacity"] is None else given["opacity"]
        look = given["look"]
        if look is not None:
            self._take_look(look, but=given.named)
        said = given if look is None else {name: given[name] for name in given.named}
        self._take({name: value for name, value in said.items() if name != "look"})

    def __repr__(self) -> str:
        colours = "one colour" if self._scalars is None else self._scalars.name
        share = "" if self.share in (None, 1.0) else f", {self.share:.1%} of the streamlines drawn"
        return f"<{type(self).__name__} {self.name!r}: {self._fiblets!r}, coloured by {colours}{share}>"

    # Data ---------------------------------------------------------------------------------------

    @property
    def fiblets(self) -> FibletSet:
        """The compressed data; can be replaced by another set."""
        return self._fiblets

    @fiblets.setter
    def fiblets(self, fiblets: FibletSet) -> None:
        scalars = self._find(fiblets, self._choice)
        with self._choosing_from(FibletSubject(fiblets, self._mapper)):
            self._draw(fiblets)
            self._show(scalars)

    def update(self, source: Any, **options: Any) -> None:
        """Replace the streamlines, for instance when they move or grow; settings stay.

        Parameters
        ----------
        source : path, FibletSet, Streamlines, pyvista.PolyData or list of (n, 3) arrays
            As for ``plotter.add_fiblets``. The per-point array of the current colours is kept.
        **options
            Of :func:`pvfiblets.compress`.

        Raises
        ------
        KeyError, ValueError
            If it lacks the array of the current colours; the actor is then unchanged.
        """
        self.fiblets = as_fiblets(source, scalars=self._choice, rgb=self._rgb, **options)[0]

    def _made_with(self) -> dict[str, Any]:
        return {"fiblets": self._fiblets, "scalars": self._choice}

    def explain(self) -> dict[str, Any]:
        """Return the active features of this actor and their cost, in all its windows.

        Returns
        -------
        dict
            ``passes``: name and milliseconds of the last redraw; ``features``: pieces of the
            shaders in use; ``buffers``: name and bytes of each GPU buffer; ``gpu_bytes``:
            their sum; ``fiblets_total``; ``pipeline``; ``culling``; ``share``: how many of the
            streamlines are drawn; ``fiblets``: of the last redraw ``total``, ``in_frustum``,
            ``drawn`` and ``visible``, ``None`` where not known; ``streamlines``: ``total`` and
            ``shown``; ``look``; ``colours``: of numbers their ``clim``, and the ``percentile`` of
            them that it ends at by default, ``None`` where it ends at the largest; ``criteria``,
            ``conditions``, ``clips``, ``groups_shown``; ``selection``: how many streamlines, and
            what drawing them apart takes; where a set is drawn part by part (``fit="stream"``),
            ``parts``: how many there are in ``total``, ``in_view``, ``left`` to be drawn, ``there``
            on the GPU, and how often one was ``fetched``; where workers draw, ``cluster``: ``parts``,
            how many are ``left``, the milliseconds of each part and of putting them together,
            and the bytes of these pictures.
        """
        return {
            **added_up(self._mapper.explain()),
            "selection": self._explain_selection(),
            "fiblets_total": self._fiblets.n_fiblets,
            "pipeline": self.pipeline_in_use,
            "culling": self.culling,
            "share": self.share,
            "look": self.look,
            "colours": self._explain_colours(),
            **self._explain_choices(),
        }

    def pick_at(self, x: int, y: int) -> tuple[int, float] | None:
        """Return the streamline id and the position along it (in points) at a window pixel.

        Parameters
        ----------
        x, y : int
            Pixel, counted from the lower left corner.

        Returns
        -------
        tuple of (int, float) or None
            ``None`` where no streamline of this actor was drawn.
        """
        return self._mapper.pick_at(x, y)

    def pick_box(self, box: Any, *, through: bool = False, renderer: vtkRenderer | None = None) -> Picked | None:
        """Return the streamlines in a rectangle of the window.

        Parameters
        ----------
        box : (float, float, float, float)
            Two opposite corners ``(x0, y0, x1, y1)``: pixels, counted from the lower left corner of
            the window; those on the edges belong to it.
        through : bool, default: False
            Occluded ones too. Otherwise only visible ones, with the ids of the frame.
        renderer : pyvista.Renderer, optional
            The subplot to look into; the one drawn last by default.

        Returns
        -------
        Picked or None
            ``None`` if there are none, or nothing has been drawn yet.

        Raises
        ------
        ValueError
            If ``box`` is not four finite numbers.
        """
        return self._pick(checked_box(box), through, 0.0, renderer)

    def pick_polygon(
        self, points: Any, *, through: bool = False, tolerance: float = 0.0, renderer: vtkRenderer | None = None
    ) -> Picked | None:
        """Return the streamlines in a polygon in the window.

        Parameters
        ----------
        points : array_like
            ``(k, 2)`` corners, pixels counted from the lower left corner of the window. It closes
            itself; inside is by the even-odd rule. One corner is a point, two are a line.
        through : bool, default: False
            Hidden ones too.
        tolerance : float, default: 0.0
            Pixels that a streamline may be away.
        renderer : pyvista.Renderer, optional
            The subplot to look into; the one drawn last by default.

        Returns
        -------
        Picked or None
            ``None`` if there are none, or nothing has been drawn yet.

        Raises
        ------
        ValueError
            If the corners are not finite pairs of numbers.
        """
        return self._pick(points, through, tolerance, renderer)

    def _pick(self, points: Any, through: bool, tolerance: float, renderer: vtkRenderer | None) -> Picked | None:
        from pvfiblets.query.selection.screen import checked_polygon

        find = everything if through else visible
        return find(self, checked_polygon(points), tolerance=tolerance, renderer=renderer)

    # Colours ------------------------------------------------------------------------------------

    @property
    def scalars(self) -> str | np.ndarray | VolumeSource | None:
        """Source of colours: a name, an array or a volume; ``None`` for ``color`` or orientation."""
        return self._choice

    @scalars.setter
    def scalars(self, scalars: Any) -> None:
        scalars = self._values_of_criterion(scalars)
        fiblets, scalars = with_point_values(self._fiblets, scalars, self._rgb)
        found = self._find(fiblets, scalars)
        if fiblets is not self._fiblets:
            self._draw(fiblets)
        self._colour_by(scalars, found)

    def color_along(
        self, profile: Any, n: int = 100, *, ids: Any = None, column: str = "mean", orient_by: Any = None
    ) -> Any:
        """Colour each streamline by a value for each position along its bundle.

        Positions are those of :func:`pvfiblets.bundles.tract_profile`: streamlines are turned to run one way, and
        divided into parts of equal length. Points without a value have ``nan_color``.

        Parameters
        ----------
        profile : TractProfile, Profile, str, path, array_like or image
            Numbers at positions from one end of the bundle to the other, such as means, p-values or effect sizes; the
            path of a table that has them (``.csv``, ``.tsv``, ``.txt``, ``.npy``); or the name of an array, or an
            image, whose profile is computed.
        n : int, default: 100
            Positions of a profile that is computed.
        ids : array_like, slice, Bundle or str, optional
            The bundle's streamlines, or the name of a group, whose rows are read of a table that has a column
            ``bundle``; all streamlines by default. Others have no value.
        column : str, default: "mean"
            Column of a table.
        orient_by : array_like, optional
            ``(m, 3)`` mm: a line that all streamlines are turned to run along; by default the core of a
            ``TractProfile``, the columns ``x``, ``y`` and ``z`` of a table, or the first of the bundle.

        Returns
        -------
        TractProfile, Profile or numpy.ndarray
            The profile whose values are shown, for a plot beside the bundle; of a table, ``(n,)`` numbers.

        Raises
        ------
        KeyError
            If there is no such array, group or column.
        ValueError
            If the values are not one number for each position.

        Examples
        --------
        >>> import pyvista as pv
        >>> from pvfiblets.synthetic import brain_streamlines
        >>> pl = pv.Plotter(off_screen=True)
        >>> actor = pl.add_fiblets(brain_streamlines(100))
        >>> _ = actor.color_along([0.2, 0.5, 0.4, float("nan")], ids=slice(0, 10))
        """
        from pvfiblets.plotting.fiblets.along import along_bundle

        bundle = slice(None) if ids is None else ids
        shown, name, values = along_bundle(self._fiblets, profile, n, bundle, column, orient_by)
        fiblets = add_values(self._fiblets, name, values, bits=16)
        found = self._find(fiblets, name)
        self._draw(fiblets)
        self._colour_by(name, found)
        return shown

    def _as_polydata(self) -> pv.PolyData:
        return self._fiblets.decompress().to_polydata()

    def _draw_source(self, source: Any) -> None:
        self.update(source)

    def _mean_colour(self, scalars: Scalars) -> Any:
        return mean_direction(self._fiblets) if scalars.kind == "orientation" else super()._mean_colour(scalars)

    def _read_rgb(self) -> bool | None:
        return self._rgb

    def _write_rgb(self, rgb: bool | None) -> None:
        before, self._rgb = self._rgb, rgb
        try:
            self.scalars = self._choice
        except Exception:
            self._rgb = before
            raise

    def _explain_colours(self) -> dict[str, Any] | None:
        if self._scalars is None or not self._scalars.mapped:
            return None
        chosen = self._settings.clim is not None
        return {"clim": tuple(self.clim), "percentile": None if chosen else self._scalars.percentile}

    # How it is drawn ----------------------------------------------------------------------------

    def _read_look(self) -> str | None:
        return look_of({name: getattr(self, name) for name in PLAIN}, self._fiblets)

    def _write_look(self, look: str | None) -> None:
        if look is not None:
            self._take_look(look)

    def _take_look(self, look: str, but: Collection[str] = ()) -> None:
        """Set all that a look says but some settings."""
        for name, value in settings_of(look, self._fiblets).items():
            if name not in but:
                setattr(self, name, value)

    @property
    def pipeline_in_use(self) -> str | None:
        """The pipeline that rendered the last frame; ``None`` before the first."""
        return self._mapper.pipeline_in_use

    @property
    def share(self) -> float | None:
        """Share of the streamlines that is drawn: 1.0 for all; ``None`` before the first frame.

        Less only where memory does not suffice for all, and ``fit`` is ``"sample"``; or it is ``"stream"``, and parts
        in view have not been drawn yet: then of the drawn ones.
        """
        return self._mapper.share

    def _read_line_width(self) -> float:
        return self._mapper.line_width

    def _write_line_width(self, width: float) -> None:
        with own_writes():
            self.prop.line_width = width
        self._mapper.line_width = width
        self._relight()

    def _property_changed(self) -> None:
        super()._property_changed()
        width = min(max(self.GetProperty().GetLineWidth(), THINNEST), WIDEST)
        if width != self._mapper.line_width:
            self._mapper.line_width = width
        self._take_tube_shading()
        self._relight()
        self._see_through()

    def _show(self, scalars: Scalars | None) -> None:
        super()._show(scalars)
        self._relight()
        self._count_lines()

    # Opacity ------------------------------------------------------------------------------------

    def _write_opacity(self, opacity: Any) -> None:
        if isinstance(opacity, float):
            self.prop.opacity = opacity
        else:
            self.opacity_by = opacity

    def _write_opacity_by(self, choice: Any) -> None:
        fiblets, found = self._fiblets, Opacities()
        if choice is not None:
            fiblets, found = find_opacities(fiblets, choice)
        before = self._fiblets
        if fiblets is not before:
            self._draw(fiblets)
        try:
            self._fade_by(choice, found, "streamline or per point")
        except Exception:
            if fiblets is not before:
                self._draw(before)
            raise

    # Light and style ----------------------------------------------------------------------------

    def _shade(self, name: str, kind: type, wanted: Any) -> None:
        super()._shade(name, kind, wanted)
        self._relight()

    def _relight(self) -> None:
        """Bring the light in step that lines have where nothing else says which."""
        kind = self._usual_light()
        present = self._mapper.effects.get(_LIGHT)
        if kind is not (None if present is None else type(present)):
            self._mapper.set_effect(_LIGHT, None if kind is None else kind())

    def _usual_light(self) -> type | None:
        bodies = "tubes" in self._shades or (self._read_tube_shading() and self._mapper.line_width > 1.0)
        bodies = bodies and self._style != _ENDS
        if self._style == _DENSITY:
            return LegendColours if self.prop.GetLighting() else None
        lit = self._style in (STYLES[0], _ENDS)
        if bodies or "illuminated" in self._shades or not lit or not self.prop.GetLighting():
            return None
        return LegendColours if self._scalars is not None and self._scalars.mapped else LineLight

    def _read_tube_shading(self) -> bool:
        return bool(self.prop.GetRenderLinesAsTubes())

    def _write_tube_shading(self, wanted: bool) -> None:
        with own_writes():
            self.prop.SetRenderLinesAsTubes(wanted)
        self._take_tube_shading()
        self._relight()

    def _take_tube_shading(self) -> None:
        wanted = self._read_tube_shading() and self._style != _ENDS
        if wanted != (_ROUND in self._mapper.effects):
            self._mapper.set_effect(_ROUND, TubeShading() if wanted else None)

    def _read_tube_radius(self) -> float | None:
        settings = self._shades.get("tubes")
        return None if settings is None else float(settings["radius"])

    def _write_tube_radius(self, radius: float | None) -> None:
        self._shade("tubes", Tubes, None if radius is None else {"radius": float(radius)})
        self._take_tubes()

    def _take_tubes(self) -> None:
        """Draw lines as tubes if they have a radius, unless only their ends are drawn."""
        radius = self._read_tube_radius()
        wanted = None if radius is None or self._style == _ENDS else Tubes(radius)
        if wanted != self._mapper.effects.get("tubes"):
            self._mapper.set_effect("tubes", wanted)

    def _read_style(self) -> str:
        return self._style

    def _write_style(self, style: str) -> None:
        if style == self._style:
            return
        self._style = style
        inks = {"halo": Ink(), "ink": Ink(None)}
        self._mapper.set_effect("ink", inks.get(style))
        self._mapper.ends = style == _ENDS
        self._take_tubes()
        self._take_tube_shading()
        self._relight()
        self._count_lines()
        if style == "ink":
            self.halos = {"color": BACKGROUND}
        elif style != "halo" or not self.halos:
            self.halos = style == "halo"

    # Density ------------------------------------------------------------------------------------

    def _count_lines(self) -> None:
        """Count all lines of a pixel where style or colours need it."""
        thin, counted = self._style == "density", self._scalars is not None and self._scalars.kind == "pixel_count"
        effect = None
        if thin or counted:
            from pvfiblets.mappers.effects.density import Density

            clim = self._settings.clim
            most = None if clim is None else limits(replace(self._settings, log_scale=False), _COUNTS)[1]
            effect = Density(not counted, thin, most, self._tone, self._most_found if counted else None)
        if effect != self._mapper.effects.get(_DENSITY):
            self._mapper.set_effect(_DENSITY, effect)
        self._see_through()

    def _most_found(self, most: float) -> None:
        """End the scalar bar at the number of lines in the fullest pixel."""
        low, high = self._table.scalar_range
        if most > low and most != high and self._scalars is not None:
            self._scalars = replace(self._scalars, range=(self._scalars.range[0], most))
            with own_writes():
                self._table.scalar_range = low, most
            self._linked_table.note()

    def _read_density_tone(self) -> str:
        return self._tone

    def _write_density_tone(self, tone: str) -> None:
        self._tone = tone
        self._count_lines()

    def _read_transparency(self) -> str | int | None:
        return self._transparency

    def _write_transparency(self, transparency: str | int | None) -> None:
        if transparency is not None and transparency != ALL:
            try:
                _layers(transparency)
            except (TypeError, ValueError) as error:  # it refuses other types
                raise ValueError(
                    f"transparency is {transparency!r}; give 'all', 'layers', a number of layers from 2 to 64, or None"
                ) from error
        self._transparency = transparency
        self._see_through()

    def _see_through(self) -> None:
        """Update the lines behind the nearest one; none if nothing is translucent."""
        effect: Any = None
        if _DENSITY in self._mapper.effects or self._transparency is None:
            pass
        elif self._transparency != ALL:
            effect = _layers(self._transparency)
        elif self._mapper.colouring.translucent() or self.prop.GetOpacity() < 1.0:
            from pvfiblets.mappers.effects.slices import Slices

            effect = Slices()
        if effect != self._mapper.effects.get(_LAYERS):
            self._mapper.set_effect(_LAYERS, effect)

    # Inside -------------------------------------------------------------------------------------

    @property
    def _drawn(self) -> FibletSet:
        return self._fiblets

    def _draw(self, fiblets: FibletSet) -> None:
        """Give the mapper other fiblets; colours for another number of streamlines go first."""
        if fiblets.n_streamlines != self._fiblets.n_streamlines:
            self._mapper.colouring = Colouring()
        self._mapper.set_fiblets(fiblets)
        self._fiblets, self._subject = fiblets, FibletSubject(fiblets, self._mapper)
        self._reselect(fiblets.n_streamlines)

    def _find(self, fiblets: FibletSet, choice: str | np.ndarray | VolumeSource | None) -> Scalars | None:
        if choice is None and self._settings.color is not None:
            return None
        found = find_fiblet_scalars(fiblets, choice, self._rgb)
        refuse_numbers(found.title if found.mapped else None, self._rgb)
        return found
