"""``plotter.add_raycast_volume(...)`` and ``plotter.raycast_volumes``.

PyVista finds this module by two entry points and imports it when a plotter is first asked for either
name. :class:`RaycastVolumesComponent` lives as long as its plotter; its life cycle is that of
`pvfiblets.plotting.actors.registry`.
"""

from __future__ import annotations

import itertools
import warnings
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.plotting.actors.registry import ActorRegistry
from pvfiblets.plotting.components import register
from pvfiblets.plotting.settings.call_signature import plotter_method
from pvfiblets.plotting.settings.settings import Given
from pvfiblets.plotting.volumes.blending import mode_of_blending
from pvfiblets.plotting.volumes.settings import VolumeSettings

if TYPE_CHECKING:
    from os import PathLike

    from pvfiblets.plotting.volumes.actor import VolumeActor
    from pvfiblets.volumes import RaycastVolume

    Source: TypeAlias = (
        str | PathLike[str] | pv.ImageData | pv.MultiBlock | np.ndarray | tuple[Any, Any] | RaycastVolume
    )


MULTI_COLOURS = ("Reds", "Greens", "Blues", "Greys", "Oranges", "Purples")
"""Maps of blocks with ``multi_colors``, as of ``Plotter.add_volume``."""

COLOURING = {"color", "cmap", "clim", "n_colors", "log_scale", "surface_colors", "scalar_bar_args"}
"""Arguments that give surfaces colours, or a map of them."""


@register("raycast_volumes")
class RaycastVolumesComponent(ActorRegistry["VolumeActor"]):
    """The ray-cast volumes of one plotter.

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

    _SETTINGS = VolumeSettings
    NAME, ADD = "raycast_volumes", "add_raycast_volume"

    def add(self, /, source: Any, **arguments: Any) -> Any:
        """Make an actor and add it to the plotter; of a MultiBlock one for each block."""
        arguments = _in_our_words(arguments)
        if not (hasattr(source, "IsA") and source.IsA("vtkMultiBlockDataSet")):
            arguments.pop("multi_colors", None)
            return super().add(source, **arguments)
        blocks = [block for block in map(source.GetBlock, range(source.GetNumberOfBlocks())) if block is not None]
        if not blocks:
            raise ValueError("the MultiBlock has no blocks; give images in it")
        several, name = arguments.pop("multi_colors", False), arguments.pop("name", None)
        cmaps = itertools.cycle(MULTI_COLOURS if several else [arguments.pop("cmap", None)])
        actors: list[VolumeActor] = []
        try:
            for number, block in enumerate(blocks):
                own = None if name is None else f"{name}-{number}"
                added = self.add(pv.wrap(block), **{**arguments, "name": own, "cmap": next(cmaps)})
                actors += added if isinstance(added, list) else [added]
        except Exception:
            for actor in actors:
                self._plotter.remove_actor(actor, render=False)
            raise
        return actors

    def _make(
        self,
        source: Source,
        settings: Given,
        *,
        scalars: str | np.ndarray | None = None,
        spacing: Any = None,
        origin: Any = None,
        direction: Any = None,
        affine: Any = None,
        shape: Any = None,
        dtype: Any = None,
        blending: str | None = None,
        resolution: Any = None,
        multi_colors: bool = False,  # noqa: ARG002 - `add` looks at it
        categories: bool | int = False,
        preference: str | None = None,
    ) -> VolumeActor:
        """Add a volume to the scene, rendered by one ray per pixel.

        Surfaces intersect meshes and lines as meshes do. Rays of light and peaks end at opaque objects,
        added before or after, so tracts and meshes are visible within their anatomy.

        Parameters
        ----------
        source : ImageData, MultiBlock, array, (array, affine), nibabel image, RaycastVolume or path
            Numbers on a regular grid, and where it lies; see
            :func:`pvfiblets.volumes.as_raycast_volume`. Paths are of NIfTI, MGH, NRRD, MetaImage and
            ``.vti`` files, or of bare numbers. Voxels of four numbers of type uint8 are RGBA: their
            light has their own colours, and ``opacity`` is of alpha.
        scalars : str or array, optional
            Of VTK's images: the name of an array, or numbers. The active ones by default.
        spacing, origin, direction, affine : array_like, optional
            Where the voxels lie, mm, in place of what the source says.
        shape, dtype : optional
            Of bare numbers in a file.
        blending : str, optional
            ``add_volume``'s word for ``mode``: ``"composite"``, ``"maximum"``, ``"minimum"`` or
            ``"average"``.
        resolution : array_like, optional
            ``add_volume``'s word for ``spacing``.
        multi_colors : bool, default: False
            Of a MultiBlock: a map of colours of its own for each block.
        categories : bool or int, default: False
            ``add_volume``'s name for ``n_colors``: True for a colour per value, or a number.
        preference : {"point", "cell"}, optional
            Which of an image's arrays is meant if points and cells both have one of the name ``scalars``; that of the
            points by default.

        Returns
        -------
        VolumeActor
            Its properties may be changed at any time. Of a MultiBlock, a list of one for each block.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        TypeError
            If ``source`` or ``opacity`` is of an unknown kind.
        ValueError
            If an argument is invalid: the message names it and the expected values. So do 2-D and
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
        from pvfiblets.plotting.volumes.actor import VolumeActor
        from pvfiblets.plotting.volumes.property_attributes import tell_given
        from pvfiblets.volumes.raycast_options import MODES
        from pvfiblets.volumes.sources import as_raycast_volume

        if blending is not None:
            settings["mode"] = _mode_of(blending, settings)
        if resolution is not None:
            if spacing is not None:
                raise ValueError("resolution is add_volume's word for spacing: give one of the two")
            spacing = resolution
        if settings["mode"] not in MODES:  # before the slow part
            raise ValueError(f"mode is {settings['mode']!r}; choose one of {MODES}")
        if preference is not None:
            scalars = _preferred(source, scalars, preference)
        where = {
            "scalars": scalars, "spacing": spacing, "origin": origin, "direction": direction, "affine": affine,
            "shape": shape, "dtype": dtype,
        }  # fmt: skip
        where = {name: value for name, value in where.items() if value is not None}
        volume = as_raycast_volume(source, **where)
        if categories:
            settings["n_colors"] = len(np.unique(volume.values)) if categories is True else int(categories)
        if _is_plain_surface(settings) and volume.colours is None:
            settings["color"] = self._plotter.theme.color
        actor = VolumeActor(volume, settings=settings, given=(source, where), theme=self._plotter.theme)
        _warn_of_nothing(actor)
        tell_given(actor, {name: settings[name] for name in settings.named})
        return actor


def _is_plain_surface(settings: Given) -> bool:
    """Return True for one surface that is given no colours."""
    alone = settings["mode"] == "isosurface" and np.size(settings["values"]) == 1
    return alone and settings.named.isdisjoint(COLOURING)


def _in_our_words(arguments: dict[str, Any]) -> dict[str, Any]:
    """Return the arguments, with ``add_volume``'s arguments under their names here."""
    found = dict(arguments)
    for theirs, ours in (("colormap", "cmap"), ("rng", "clim")):
        if theirs in found:
            value = found.pop(theirs)
            found[ours] = value if value is not None else found.get(ours)
    for name, why in (
        ("mapper", "chooses among VTK's mappers of volumes"),
        ("culling", "is of faces, and volumes have none"),
    ):
        if found.pop(name, None) is not None:
            raise ValueError(f"{name} of add_volume {why}; leave it out")
    return found


def _preferred(source: Any, scalars: Any, preference: str) -> Any:
    """Return the array of an image's points or cells that a name stands for."""
    if preference not in ("point", "cell"):
        raise ValueError(f"preference is {preference!r}; choose 'point' or 'cell'")
    data = getattr(source, f"{preference}_data", None)
    return data[scalars] if isinstance(scalars, str) and data is not None and scalars in data else scalars


def _warn_of_nothing(actor: VolumeActor) -> None:
    """Warn if all voxels have one value, which is as good as invisible."""
    low, high = actor.volume.value_range
    transfer = actor.casting.transfer
    if low == high and transfer is not None and float(transfer.lookup(low)[3]) == 0.0:
        warnings.warn(
            f"all voxels have the value {low:g}, where opacity is 0: nothing shows; give clim=(low, high) around it or "
            "one number as opacity",
            UserWarning,
            stacklevel=6,
        )


def _mode_of(blending: str, settings: Given) -> str:
    """Return the mode of a word of ``add_volume``'s."""
    if "mode" in settings.named:
        raise ValueError("blending is add_volume's word for mode: give one of the two")
    return mode_of_blending(blending)


AddRaycastVolume = plotter_method(RaycastVolumesComponent)
