"""``plotter.add_spline_tubes(...)`` and ``plotter.spline_tubes``.

PyVista finds this module by two entry points and imports it when a plotter is first asked for
either name. :class:`SplineTubesComponent` lives as long as its plotter; its life cycle is that of
`pvfiblets.plotting.actors.registry`.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.plotting.actors.registry import ActorRegistry
from pvfiblets.plotting.components import register
from pvfiblets.plotting.settings.call_signature import plotter_method
from pvfiblets.plotting.settings.mesh_arguments import ThickLineCommon
from pvfiblets.plotting.settings.places import OPTIONS
from pvfiblets.plotting.settings.settings import Given
from pvfiblets.plotting.tubes.settings import TubeSettings

if TYPE_CHECKING:
    from os import PathLike

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.plotting.colours.same_names import Preference
    from pvfiblets.plotting.tubes.actor import TubeActor
    from pvfiblets.streamlines import Streamlines
    from pvfiblets.tubes.spline_tubes import SplineTubes

    Lines: TypeAlias = pv.PolyData | Streamlines | FibletSet | np.ndarray | list[Any] | tuple[Any, Any]
    Source: TypeAlias = str | PathLike[str] | SplineTubes | Lines


@register("spline_tubes")
class SplineTubesComponent(ActorRegistry["TubeActor"]):
    """The spline tubes of one plotter.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.

    Examples
    --------
    >>> import pyvista as pv
    >>> pl = pv.Plotter(off_screen=True)
    >>> actor = pl.spline_tubes.add([[(0, 0, 0), (1, 1, 0), (2, 0, 0)]], radius=0.1, color="red")
    >>> list(pl.spline_tubes) == [actor]
    True
    """

    _SETTINGS = TubeSettings
    COMMON = ThickLineCommon
    NAME, ADD = "spline_tubes", "add_spline_tubes"

    def _make(
        self,
        source: Source,
        settings: Given,
        *,
        radius: float | str | np.ndarray | None = None,
        scalars: str | np.ndarray | None = None,
        tangents: str | np.ndarray | None = None,
        method: str = "finite",
        radius_slopes: float | str | np.ndarray | None = None,
        scalar_slopes: str | np.ndarray | None = None,
        scaled: bool | None = None,
        rgb: bool | None = None,
        preference: Preference = "point",
    ) -> TubeActor:
        """Add tubes of varying radius around Hermite splines to the scene.

        Each pixel shows the point at which its ray enters the tube. There is no mesh, so no facets
        appear at any distance. Tubes intersect each other and meshes.

        Parameters
        ----------
        source : PolyData, Streamlines, array, list of arrays, (points, segments), SplineTubes, FibletSet or path
            Lines in mm; their points are the nodes of the splines. One ``(n, 3)`` array is one tube. A
            line of one point is a ball.
        radius : float, str, array or image, optional
            Radius in mm: one for all, the name of an array of ``source``, a number per point or per
            line, or an image, sampled at the points. By default the point array ``"radius"``,
            ``"Radius"`` or ``"MaximumInscribedSphereRadius"`` (VMTK), else 0.5 % of the diagonal of the
            bounds.
        scalars : str, array or image, optional
            Colours of the tubes: the name of an array of ``source``; ``"radius"``, ``"arc_length"``,
            ``"length"`` (mm) or ``"orientation"`` (the absolute direction as red, green, blue); an array
            with one number or one colour (3 or 4 columns; floats with ``rgb``) per point or per line; a
            file of numbers (``.tsf``, ``.npy``, ``.txt``, ``.csv``); or an image, sampled at the points.
            By default the active scalars of a VTK data set, unless ``color`` is given.
        preference : {'point', 'cell'}, default: 'point'
            Meaning of a name that points and lines (cells) share, here and in criteria. The other array
            is then called ``"NAME (line)"`` or ``"NAME (point)"``.
        tangents : str or array, optional
            ``(n_points, 3)`` derivatives of the positions, or the name of a point array. By default
            ``method`` computes them from the points.
        method : {"finite", "catmull-rom", "natural"}, default: "finite"
            Method for missing derivatives: finite differences by length, half the difference of the two
            neighbours, or natural cubic splines, whose curvature is continuous.
        radius_slopes, scalar_slopes : str or array, optional
            Derivatives of radius and scalars at the points. By default ``method`` computes them.
        scaled : bool, optional
            True: derivatives are by length (mm/mm). False: they are by the segment's parameter, from 0
            to 1. By default False if ``tangents`` are given or ``method`` is ``"catmull-rom"``, else True.
        rgb : bool, optional
            True: ``scalars`` of three or four columns are colours. False: they are vectors, coloured by
            magnitude. By default uint8 columns are colours, and so are arrays whose names end in
            ``"_rgb"`` or ``"_rgba"``.

        Returns
        -------
        TubeActor
            Its properties may be changed at any time.

        Raises
        ------
        KeyError
            If no array has the name given as ``scalars``.
        TypeError
            If ``source`` has an unsupported type.
        ValueError
            If an argument is invalid, or no array has the name given as ``radius``, ``tangents`` or a
            slope; the message names the array, the row and the value.

        Notes
        -----
        Source: Russig, Gumhold and Salm, "GPU-based raycasting of Hermite spline tubes" (2020).

        Examples
        --------
        A spring of growing thickness, coloured by its radius:

        >>> import numpy as np
        >>> import pyvista as pv
        >>> t = np.linspace(0, 20, 60)
        >>> spring = np.stack([10 * np.cos(t), 10 * np.sin(t), 2 * t], axis=1)
        >>> pl = pv.Plotter(off_screen=True)
        >>> actor = pl.add_spline_tubes(spring, radius=0.5 + 0.05 * t, scalars="radius", cmap="plasma")
        >>> actor.prop.specular = 0.5
        >>> actor.tubes.n_segments
        59

        Two points with explicit tangents make a curved tube:

        >>> nodes, slopes = np.array([(0, 0, 0), (10, 0, 0)]), np.array([(0, 20, 0), (0, 20, 0)])
        >>> actor = pl.add_spline_tubes(nodes, tangents=slopes, radius=[1, 2], color="tomato")
        """
        from pvfiblets.mappers.tubes import TubeOptions
        from pvfiblets.plotting.colours.colours import active_scalars
        from pvfiblets.plotting.colours.scalars import refuse_numbers
        from pvfiblets.plotting.tubes.actor import TubeActor
        from pvfiblets.plotting.tubes.sources import as_tubes

        TubeOptions(**settings.at(OPTIONS))  # errors are raised before the slow part
        if scalars is None:
            scalars = active_scalars(source, settings["color"], rgb)
        tubes, choice, data = as_tubes(
            source,
            scalars=scalars,
            rgb=rgb,
            preference=preference,
            radius=radius,
            tangents=tangents,
            method=method,
            radius_slopes=radius_slopes,
            scalar_slopes=scalar_slopes,
            scaled=scaled,
        )
        if not tubes.n_segments:
            warnings.warn("the source holds no lines: nothing is drawn", UserWarning, stacklevel=5)
        renderer = self._plotter.renderer
        if choice is None and settings["color"] is None and renderer._color_cycle is not None:  # noqa: SLF001
            settings["color"] = renderer.next_color  # as `add_mesh` does after `set_color_cycler`
        actor = TubeActor(tubes, scalars=choice, settings=settings, theme=self._plotter.theme, data=data)
        refuse_numbers(actor.scalars_title, rgb)
        return actor


AddSplineTubes = plotter_method(SplineTubesComponent)
