"""``plotter.add_raycast_volume(...)`` and ``plotter.raycast_volumes``.

PyVista finds this module by two entry points and imports it when a plotter is first asked for either
name. :class:`RaycastVolumesComponent` lives as long as its plotter; its life cycle is that of
`pvfiblets.plotting.actor_registry`.
"""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.plotting.actor_registry import ActorRegistry, same_as

if TYPE_CHECKING:
    from os import PathLike

    from pvfiblets.plotting.volumes.actor import VolumeActor
    from pvfiblets.volumes import RaycastVolume

    Source: TypeAlias = str | PathLike[str] | pv.ImageData | np.ndarray | tuple[Any, Any] | RaycastVolume


@pv.register_plotter_component("raycast_volumes")
class RaycastVolumesComponent(ActorRegistry["VolumeActor"]):
    """The volumes of one plotter that rays are cast through.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.

    Examples
    --------
    >>> import numpy as np
    >>> import pyvista as pv
    >>> pl = pv.Plotter(off_screen=True)
    >>> actor = pl.raycast_volumes.add(np.random.default_rng(0).random((8, 8, 8)), mode="mip")
    >>> list(pl.raycast_volumes) == [actor]
    True
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._init_keeping(plotter)

    def add(
        self,
        source: Source,
        *,
        scalars: str | np.ndarray | None = None,
        mode: str = "composite",
        values: float | Any = None,
        cmap: Any = None,
        clim: Any = None,
        opacity: str | float | Any = "linear",
        opacity_unit_distance: float | None = None,
        n_colors: int = 256,
        color: Any = None,
        flip_scalars: bool = False,
        thresholds: Any = None,
        peak: float | None = None,
        smooth: float | Any = None,
        step: float = 0.5,
        filter: str = "trilinear",  # noqa: A002 - what the paper calls it
        refine: str = "regula-falsi",
        iterations: int = 5,
        integrator: str = "adaptive",
        jitter: bool = False,
        octree: bool = True,
        homogeneous: float = 0.0,
        recon: bool = False,
        sparse: int = 1,
        sparse_threshold: float = 0.05,
        stop: float = 0.999,
        interactive_quality: float | dict[str, Any] = 0.5,
        box: Any = None,
        spacing: Any = None,
        origin: Any = None,
        direction: Any = None,
        affine: Any = None,
        shape: Any = None,
        dtype: Any = None,
        lighting: bool | None = None,
        ray_occlusion: bool | dict[str, Any] = False,
        name: str | None = None,
        label: str | None = None,
        show_scalar_bar: bool | None = None,
        scalar_bar_args: dict[str, Any] | None = None,
        pickable: bool = True,
        user_matrix: Any = None,
        reset_camera: bool | None = None,
        render: bool = True,
    ) -> VolumeActor:
        """Add a volume to the scene, through which a ray is cast for each pixel.

        Surfaces cut into meshes and lines as meshes do. Light and peaks end at whatever is opaque,
        be it added before or after, and so do tracts and meshes show in their anatomy.

        Parameters
        ----------
        source : ImageData, array, (array, affine), nibabel image, RaycastVolume or path
            Numbers on a regular grid, and where it lies; see
            :func:`pvfiblets.volumes.as_raycast_volume`. Paths are of NIfTI, MGH, NRRD, MetaImage and
            ``.vti`` files, or of bare numbers.
        scalars : str or array, optional
            Of VTK's images: the name of an array, or numbers. The active ones by default.
        mode : {"composite", "isosurface", "mip", "local-mip"}, default: "composite"
            What a ray shows: the light of all that it passes through, the first surface, the
            greatest value, or the first peak.
        values : float or list of float, optional
            Where surfaces are, up to eight; the middle of the volume's values by default.
        cmap : str, list or colormap, optional
            Colour map; the theme's by default. Surfaces have the colour of their value.
        clim : float or (float, float), optional
            Values of the first and the last colour; the range of the volume's by default.
        opacity : str, float or list of float, default: "linear"
            How opaque values are, from the first colour to the last: a name as for
            :meth:`pyvista.Plotter.add_volume`, numbers from 0 to 1 that are linear between, or one
            number for all. One number makes surfaces translucent, too; all else does not touch them.
        opacity_unit_distance : float, optional
            mm of which ``opacity`` is, so that light does not depend on the step; the mean spacing
            of the voxels by default.
        n_colors : int, default: 256
            Number of colours in the map, between which light is linear.
        color : color-like, optional
            One colour for all in place of the map.
        flip_scalars : bool, default: False
            Reverse the colour map.
        thresholds : (float, float), optional
            Least and greatest value that is there, either may be ``None``; not of surfaces.
        peak : float, optional
            The least value of a peak for ``"local-mip"``; the middle of the volume's by default.
        smooth : float or (float, float, float), optional
            Standard deviation of a Gaussian that the volume is smoothed with first, voxels.
        step : float, default: 0.5
            Of a ray, in mean spacings of voxels.
        filter : {"trilinear", "nearest", "tricubic"}, default: "trilinear"
            Reconstruction between voxels.
        refine : {"regula-falsi", "newton", "none"}, default: "regula-falsi"
            How the place of a surface on its ray is refined.
        iterations : int, default: 5
            Steps of that.
        integrator : {"adaptive", "preintegrated", "exponential", "riemann", "simpson", "romberg", "rk4"}
            How light is added up over a step. ``"adaptive"``, the default, is within a hundredth
            of the exact light however dense and steep opacities are: it is ``"preintegrated"``
            where that suffices, takes steps in parts at edges from voxel to voxel, and is
            several times as slow where opacities are steep.
        jitter : bool, default: False
            Have each ray start at a place of its own in the first step: noise in place of rings.
        octree : bool, default: True
            Skip parts with nothing to see; the picture is the same.
        homogeneous : float, default: 0.0
            Difference of values up to which parts are taken as their mean.
        recon : bool, default: False
            Take parts in which colour and opacity are the same for all values there as one: light
            is the same, and faster where opacities have plateaus.
        sparse : {1, 2, 4}, default: 1
            Cast a ray for every so many pixels along each axis, and for those between only where
            what the first ones found differs. Things thinner than that may be missed.
        sparse_threshold : float, default: 0.05
            By how much that may differ, from 0 to 1.
        stop : float, default: 0.999
            Opacity at which a ray ends.
        interactive_quality : float or dict, default: 0.5
            While the camera moves, how well: from 0 to 1, which is as at rest, or
            ``{"step": factor, "sparse": pixels}``. At rest all is drawn as it is set.
        box : (float, float, float, float, float, float), optional
            (xmin, xmax, ymin, ymax, zmin, zmax) in voxels of what is there; all by default.
        spacing, origin, direction, affine : array_like, optional
            Where the voxels lie, mm, in place of what the source says.
        shape, dtype : optional
            Of bare numbers in a file.
        lighting : bool, optional
            Shade surfaces by the scene's lights; the theme's by default.
        ray_occlusion : bool or dict, default: False
            Darken surfaces where the volume stands over them, by rays through it:
            ``{"samples": 32, "radius": mm, "strength": 1.0, "seed": 0, "smooth": True}``, or ``True``
            for these.
        name : str, optional
            Replaces the actor of the same name.
        label : str, optional
            For :meth:`pyvista.Plotter.add_legend`.
        show_scalar_bar : bool, optional
            The theme's by default; there is none with ``color``.
        scalar_bar_args : dict, optional
            For :meth:`pyvista.Plotter.add_scalar_bar`.
        pickable : bool, default: True
            Whether pickers find the actor.
        user_matrix : transform-like, optional
            From data to world coordinates.
        reset_camera : bool, optional
            As for :meth:`pyvista.Plotter.add_mesh`.
        render : bool, default: True
            Render at once if the window is shown already.

        Returns
        -------
        VolumeActor
            Its properties may be changed at any time.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        TypeError
            If ``source`` or ``opacity`` is of an unknown kind.
        ValueError
            If an argument has no meaning: the message names it and what was expected. So do 2-D and
            empty images, affines that flatten space, limits in the wrong order, and opacities
            outside 0 to 1.

        Notes
        -----
        Of several things that are translucent in a pixel VTK takes the mean, weighted by opacity,
        where depth peeling is off, which is right for volumes in one place; with
        ``plotter.enable_depth_peeling()`` they lie over each other by the depth of a volume's first
        light, which is right for one behind the other. Opacity is right in both.

        Source: Lesar, "Real-time ray casting of volumetric data" (2015).

        Examples
        --------
        A ball of fog that thins towards its rim, then its surface:

        >>> import numpy as np
        >>> import pyvista as pv
        >>> x = np.linspace(-1, 1, 32)
        >>> ball = 1 - np.sqrt(x[:, None, None] ** 2 + x[:, None] ** 2 + x**2)
        >>> pl = pv.Plotter(off_screen=True)
        >>> actor = pl.add_raycast_volume(ball, cmap="gray", clim=(0, 1), opacity=[0, 0.1])
        >>> actor.mode, actor.values = "isosurface", 0.4
        >>> actor.casting.values
        (0.4,)
        """
        from pvfiblets.plotting.colours import ColourSettings
        from pvfiblets.plotting.volumes.actor import VolumeActor
        from pvfiblets.volumes.options import MODES
        from pvfiblets.volumes.sources import as_raycast_volume

        if mode not in MODES:  # before the slow part
            raise ValueError(f"mode is {mode!r}; choose one of {MODES}")
        volume = as_raycast_volume(
            source,
            scalars=scalars,
            spacing=spacing,
            origin=origin,
            direction=direction,
            affine=affine,
            shape=shape,
            dtype=dtype,
        )
        settings = ColourSettings(
            color=None if color is None else pv.Color(color),
            cmap=cmap,
            clim=clim,
            n_colors=n_colors,
            flip_scalars=flip_scalars,
        )
        actor = VolumeActor(
            volume,
            casting={
                "mode": mode,
                "step": step,
                "filter": filter,
                "refine": refine,
                "iterations": iterations,
                "integrator": integrator,
                "jitter": jitter,
                "octree": octree,
                "homogeneous": homogeneous,
                "recon": recon,
                "sparse": sparse,
                "sparse_threshold": sparse_threshold,
                "stop": stop,
                "box": box,
            },
            values=values,
            thresholds=thresholds,
            peak=peak,
            opacity=opacity,
            opacity_unit_distance=opacity_unit_distance,
            smooth=smooth,
            settings=settings,
            interactive_quality=interactive_quality,
            lighting=lighting,
            theme=self._plotter.theme,
        )
        actor.ray_occlusion = ray_occlusion
        return self._enter(
            actor,
            name=name,
            label=label,
            show_scalar_bar=show_scalar_bar,
            scalar_bar_args=scalar_bar_args,
            pickable=pickable,
            user_matrix=user_matrix,
            reset_camera=reset_camera,
            render=render,
        )


@pv.register_plotter_component("add_raycast_volume")
class AddRaycastVolume:
    """What makes ``plotter.add_raycast_volume`` callable; the same as ``plotter.raycast_volumes.add``.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter: Any = weakref.proxy(plotter)

    @same_as(RaycastVolumesComponent.add)
    def __call__(self, source: Source, **arguments: Any) -> VolumeActor:
        """Add a volume; see :meth:`RaycastVolumesComponent.add`."""
        return self._plotter.raycast_volumes.add(source, **arguments)
