"""Streamlines that a user singled out: highlighted, counted, measured, saved."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.mappers.picking import Layer
from pvfiblets.plotting.actors.coloured import added_up
from pvfiblets.plotting.fiblets.filtering import BundledActor
from pvfiblets.plotting.filtering.selection import AS_BEFORE, SelectionStyle

if TYPE_CHECKING:
    from os import PathLike

    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

    from pvfiblets.mappers.fiblets import FibletMapper
    from pvfiblets.plotting.fiblets.profiles import Profile
    from pvfiblets.plotting.fiblets.selection_overlay import SelectionOverlay
    from pvfiblets.query.measures.table import Table

class SelectableActor(BundledActor):
    """Actor of fiblets with a selection."""

    _mapper: FibletMapper
    _standout: SelectionOverlay | None = None

    @property
    def picking_layers(self) -> list[Layer]:
        """Mappers whose pixels show this actor's streamlines."""
        layers = [Layer(self._mapper)]
        return layers if self._standout is None else [*layers, self._standout.layer]

    def select(
        self, ids: Any, *, mode: str = "replace", as_tubes: bool = AS_BEFORE, radius: float = AS_BEFORE
    ) -> None:
        """Select streamlines.

        Parameters
        ----------
        ids : array_like, slice, Picked, Predicate or Region
            Numbers (negative ones count from the end), a mask ``(n_streamlines,)`` of bool, a slice, a pick, or
            a condition or region as for :meth:`streamlines_where`.
        mode : {"replace", "add", "remove", "toggle"}
            Effect on the current selection.
        as_tubes : bool, optional
            Whether the selection is drawn as tubes from now on, see :meth:`selection_style`.
        radius : float, optional
            Of the tubes, mm.

        Raises
        ------
        IndexError
            If an id is out of range or a mask has the wrong length.
        ValueError
            If there is no such mode or radius.
        """
        before = self._selection_style
        self._selection_style = before.changed(as_tubes=as_tubes, radius=radius)
        try:
            super().select(ids, mode=mode)
        except Exception:
            self._selection_style = before
            raise

    def grow_selection(self, distance: float) -> None:
        """Add the streamlines whose two ends are near the ends of a selected streamline.

        Parameters
        ----------
        distance : float
            mm: both ends lie within it of the two ends of one of those selected, either way round.

        Raises
        ------
        ValueError
            If it is not a length above 0.
        """
        from pvfiblets.query.selection.endpoints import similar_ends

        self.select(similar_ends(self._fiblets, self.selection, distance), mode="add")

    # How it looks -------------------------------------------------------------------------------

    def selection_style(
        self,
        *,
        color: Any = AS_BEFORE,
        width: float | None = AS_BEFORE,
        dim: float = AS_BEFORE,
        as_tubes: bool = AS_BEFORE,
        radius: float = AS_BEFORE,
        silhouette: Any = AS_BEFORE,
    ) -> SelectionStyle:
        """Change the style of selected streamlines; omitted arguments stay unchanged.

        Parameters
        ----------
        color : color-like or None
            Of those selected; ``None`` leaves them their own colours.
        width : float or None
            Pixels; ``None`` draws them as wide as all.
        dim : float
            How much of the colours of all others gives way to the background, 0 to 1.
        as_tubes : bool
            Draw them as tubes that bend smoothly through their points. (Straight from point to
            point where a volume colours the actor, and where more than 400,000 points are selected.)
        radius : float
            Of the tubes, mm.
        silhouette : bool or color-like
            An outline around them, white where ``True``.

        Returns
        -------
        SelectionStyle
            As it is now.

        Raises
        ------
        ValueError
            If a number has no meaning; all stays as it was.
        """
        return self._restyle(
            color=color, width=width, dim=dim, as_tubes=as_tubes, radius=radius, silhouette=silhouette
        )

    @property
    def _stands_apart(self) -> bool:
        return self._selection_style.width is not None or self._selection_style.as_tubes

    def _show_selection(self) -> None:
        super()._show_selection()
        if self._standout is not None:
            self._standout.leave()
            self._standout = None
        if self._selected is not None and self._stands_apart:
            self._standout = self._make_standout(self._selection_style)

    def _make_standout(self, style: SelectionStyle) -> SelectionOverlay:
        from pvfiblets.plotting.fiblets.selection_overlay import SelectionOverlay

        width = self._mapper.line_width if style.width is None else style.width
        radius = style.radius if style.as_tubes else None
        return SelectionOverlay(
            self,
            self.selection,
            color=style.color,
            width=width,
            radius=radius,
            outline=style.silhouette,
        )

    # What it holds ------------------------------------------------------------------------------

    def selection_table(self) -> Table:
        """Return a row for each selected streamline; see :func:`pvfiblets.table`."""
        return self._fiblets.table(self.selection)

    def selection_statistics(self, scalars: Any = None) -> dict[str, Any]:
        """Count and measure the selected streamlines.

        Parameters
        ----------
        scalars : str or array, optional
            Of what to give mean and standard deviation, per streamline or per point: a name, or an
            array with one number per streamline or per point. The numbers that colour the actor by
            default.

        Returns
        -------
        dict
            ``count``, ``points``; ``length_mean``, ``length_min``, ``length_max`` and
            ``length_total`` in mm; and, where there are numbers, their name as ``scalars``, and
            ``mean`` and ``std`` (population) over the streamlines or points that have one. NaN
            where there is nothing.

        Raises
        ------
        KeyError
            If there is no array of that name.
        ValueError
            If an array has the wrong length.
        """
        ids = self.selection
        part = self._fiblets.extract(ids)
        lengths = part.lengths()
        some = lengths if len(lengths) else np.full(1, np.nan)
        found: dict[str, Any] = {
            "count": len(ids),
            "points": part.n_points,
            "length_mean": float(some.mean()),
            "length_min": float(some.min()),
            "length_max": float(some.max()),
            "length_total": float(lengths.sum()),
        }
        if scalars is None and self._scalars is not None and self._scalars.mapped:
            scalars = self._scalars.name if self._scalars.values is None else self._scalars.values
            name = self._scalars.name
        else:
            name = scalars if isinstance(scalars, str) else "Data"
        if scalars is not None:
            from pvfiblets.plotting.fiblets.profiles import values_of

            values = values_of(self._fiblets, scalars, part, ids)
            values = values[np.isfinite(values)]
            found |= {
                "scalars": name,
                "mean": float(values.mean()) if len(values) else float("nan"),
                "std": float(values.std()) if len(values) else float("nan"),
            }
        return found

    def selection_profile(self, scalars: Any = None, n: int = 100) -> Profile:
        """Return the mean of a value along the selected streamlines, from end to end.

        Parameters
        ----------
        scalars : str or array, optional
            A value per point: a name or an array. What colours the actor by default.
        n : int, default: 100
            Places along each streamline, evenly spaced.

        Returns
        -------
        Profile
            Streamlines are turned so that they run the same way.

        Raises
        ------
        KeyError
            If there is no array of that name.
        ValueError
            If the values are not per point, or ``n`` is below 2.
        """
        from pvfiblets.query.measures.profile import mean_profile

        if scalars is None:
            if self._scalars is None or self._scalars.kind != "point_scalar":
                raise ValueError("scalars is None, but the actor has no values per point; name an array")
            scalars = self._scalars.name
        mean, std = mean_profile(self._fiblets, self.selection, scalars, n)
        name = scalars if isinstance(scalars, str) else str(getattr(scalars, "name", "Data"))
        from pvfiblets.plotting.fiblets.profiles import Profile

        return Profile(mean, std, np.linspace(0.0, 1.0, n), name, len(self.selection))

    def save_selection(self, path: str | PathLike[str]) -> list[str]:
        """Write the selected streamlines to a file, in the format of its suffix.

        Parameters
        ----------
        path : str or Path
            ``.fiblets`` takes them as they are; ``.trk``, ``.tck``, ``.trx``, ``.vtk`` and the
            others take them decompressed. None at all is a file too.

        Returns
        -------
        list of str
            What the format cannot hold and was left out.

        Raises
        ------
        UnknownFormatError
            If no format that can be written has such a suffix.
        """
        if Path(path).suffix.lower() != ".fiblets":
            from pvfiblets.formats import registry

            registry.module_for(path, "write")
        return self._fiblets.extract(self.selection).save(path)

    # Life ---------------------------------------------------------------------------------------

    def entered(self, renderer: vtkRenderer) -> None:
        """Be told that a renderer draws the actor from now on."""
        if self._standout is not None:
            self._standout.enter(renderer)

    def raise_pending(self) -> None:
        """Raise what drawing stored, once (`FibletMapper.raise_pending`)."""
        super().raise_pending()
        if self._standout is not None:
            self._standout.mapper.raise_pending()

    def release(self, window: vtkRenderWindow | None = None) -> None:
        """Release the actor's GPU memory in a window, or in all windows."""
        super().release(window)
        if self._standout is not None:
            self._standout.leave_with_owner()
            self._standout.mapper.release(window)

    def _explain_selection(self) -> dict[str, Any]:
        """How many are selected; where they are drawn apart, wider or as tubes, what that takes."""
        apart = None if self._standout is None else added_up(self._standout.mapper.explain())
        return {
            "streamlines": len(self.selection),
            "passes": [] if apart is None else apart["passes"],
            "features": [] if apart is None else apart["features"],
            "gpu_bytes": 0 if apart is None else apart["gpu_bytes"],
        }
