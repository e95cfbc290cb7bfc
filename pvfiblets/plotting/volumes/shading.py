"""How a volume that rays are cast through is shaded: effects of its surfaces, and fading of all that it shows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pvfiblets.mappers.ray_occlusion import RayOcclusion
from pvfiblets.plotting.shading import SurfaceShading

__all__ = ["VolumeShading"]

OF_SURFACES = ("ambient_occlusion", "ray_occlusion")
"""Light and peaks have nothing that could stand over anything: they keep these for when a surface shows again."""


class VolumeShading(SurfaceShading):
    """The part of :class:`~pvfiblets.plotting.volumes.actor.VolumeActor` that shades.

    ``ambient_occlusion`` and ``ray_occlusion`` are of ``mode="isosurface"``: in the other modes they are kept and
    change nothing. ``depth_cue`` is of all modes: light fades by where it begins, a peak by where it is.
    """

    def _init_shading(self) -> None:
        super()._init_shading()
        self._of_surfaces: dict[str, Any] = {}

    @property
    def ray_occlusion(self) -> dict[str, Any] | bool:
        """Darkness where the volume stands over its own surfaces, by rays through it (Lesar 2015, equation 10).

        Unlike ``ambient_occlusion``, which knows the pixels alone, it sees what is hidden or beside
        the picture, and does not change as the camera turns; it costs ``samples`` rays a pixel.

        ``samples`` (32): rays of each pixel, 1 to 2048. ``radius`` (mm): what is farther does not
        darken; ``None``, the default, is a 20th of the data's diagonal. ``strength`` (1.0): 0 to 1.
        ``seed`` (0): the same picture with the same seed is the same to the last bit. ``smooth``
        (``True``): mean over neighbouring pixels of the same piece of surface, in place of grain.
        """
        return self._shades.get("ray_occlusion", False)

    @ray_occlusion.setter
    def ray_occlusion(self, wanted: Mapping[str, Any] | bool | None) -> None:
        self._shade("ray_occlusion", RayOcclusion, wanted)

    def _shade(self, name: str, kind: type, wanted: Any) -> None:
        super()._shade(name, kind, wanted)
        if name in OF_SURFACES:
            self._of_surfaces[name] = self._mapper.extras.get(name)
            self._look()

    def _shade_surfaces(self, surface: bool) -> None:
        """Have the mapper draw what is of surfaces if there is one."""
        for name, extra in self._of_surfaces.items():
            self._mapper.set_extra(name, extra if surface else None)

    def _shade_surface_like(self, other: SurfaceShading) -> None:
        super()._shade_surface_like(other)
        if isinstance(other, VolumeShading):
            self.ray_occlusion = other.ray_occlusion

    def _look(self) -> None:
        """Set what the actor's property knows."""
        raise NotImplementedError
