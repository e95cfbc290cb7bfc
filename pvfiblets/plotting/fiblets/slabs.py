"""Slabs, as of a radiologist's slices: a cut with a thickness, and the slice of a volume in its middle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.plotting.filtering.region_sources import direction_of

if TYPE_CHECKING:
    from pvfiblets.plotting.fiblets.actor import FibletActor


class FibletSlab:
    """A slab that actors are cut to; ``plotter.fiblets.add_slab`` makes it.

    Its properties may be set at any time and show with the next render.
    """

    def __init__(
        self,
        plotter: pv.BasePlotter,  # where the slice is drawn
        actors: Sequence[FibletActor],  # the fiblets to cut
        name: str,  # of the cut in each actor
        *,
        normal: Any,  # (3,): `"x"`, `"y"`, `"z"`, or a direction
        origin: Any,  # (3,): A point of the middle plane, or how far along the normal it is, mm
        thickness: float,  # mm
        volume: Any = None,  # drawn where the middle plane cuts it
        **mesh_options: Any,
    ) -> None:
        self._plotter = plotter
        self._actors = list(actors)
        self.name = name
        if volume is not None and not isinstance(volume, pv.DataSet):
            raise TypeError(
                f"volume is a {type(volume).__name__}; give a pyvista dataset, such as pv.ImageData or pv.read(path)"
            )
        self._normal = np.asarray(direction_of(normal), float)
        self._origin = self._point(origin)
        self._thickness = float(thickness)
        self._volume: Any = volume
        self._slice: Any = None
        self._slice_mesh = pv.PolyData()
        self._cut()
        if volume is not None:
            options = {"cmap": "gray", "show_scalar_bar": False, "lighting": False, **mesh_options}
            try:
                self._update_slice()
                self._slice = self._add_slice(options)
            except Exception:
                self.remove()
                raise

    def __repr__(self) -> str:
        normal, origin = (np.array2string(v, precision=4) for v in (self._normal, self._origin))
        return f"<FibletSlab {self.name!r}: {self._thickness:g} mm about {origin}, normal {normal}>"

    @property
    def normal(self) -> np.ndarray:
        """Direction across the slab, (3,)."""
        return self._normal.copy()

    @normal.setter
    def normal(self, normal: Any) -> None:
        self.place(normal=normal)

    @property
    def origin(self) -> np.ndarray:
        """A point of its middle plane, (3,) mm."""
        return self._origin.copy()

    @origin.setter
    def origin(self, origin: Any) -> None:
        self.place(origin=origin)

    @property
    def position(self) -> float:
        """Position of its middle plane along the normal, mm."""
        return float(self._origin @ self._normal / np.linalg.norm(self._normal))

    @position.setter
    def position(self, position: float) -> None:
        unit = self._normal / np.linalg.norm(self._normal)
        self.place(origin=self._origin + (float(position) - self.position) * unit)

    @property
    def thickness(self) -> float:
        """Between both faces, mm."""
        return self._thickness

    @thickness.setter
    def thickness(self, thickness: float) -> None:
        self.place(thickness=thickness)

    @property
    def slice_actor(self) -> pv.Actor | None:
        """Actor of the volume's slice."""
        return self._slice

    def place(self, *, normal: Any = None, origin: Any = None, thickness: Any = None) -> None:
        """Change several of these at once; an invalid value changes nothing."""
        before = self._normal, self._origin, self._thickness
        try:
            if normal is not None:
                self._normal = np.array(direction_of(normal), float)
            if origin is not None:
                self._origin = self._point(origin)
            if thickness is not None:
                self._thickness = float(thickness)
            self._cut()
        except Exception:
            self._normal, self._origin, self._thickness = before
            raise
        if self._slice is not None:
            self._update_slice()

    def remove(self) -> None:
        """Take cut and slice away; twice is harmless."""
        for actor in self._actors:
            if self.name in actor.clips:
                actor.unclip(self.name)
        if self._slice is not None:
            self._plotter.remove_actor(self._slice, reset_camera=False, render=False)
            self._slice = None

    def _cut(self) -> None:
        for actor in self._actors:
            actor.clip_slab(self._normal, self._origin, self._thickness, name=self.name)

    def _point(self, origin: Any) -> np.ndarray:
        """Return three numbers of their own; one alone counts along the normal."""
        if np.ndim(origin) == 0:
            return float(origin) * self._normal / np.linalg.norm(self._normal)
        return np.array(origin, float)

    def _add_slice(self, options: dict[str, Any]) -> Any:
        """Add the slice to the plotter, which PyVista refuses while it is empty."""
        empty = not self._slice_mesh.n_points
        if empty:
            self._slice_mesh.copy_from(self._volume.slice(normal=self._normal, origin=self._volume.center))
        actor = self._plotter.add_mesh(
            self._slice_mesh, name=f"{self.name} slice", reset_camera=False, render=False, **options
        )
        if empty:
            self._update_slice()
        return actor

    def _update_slice(self) -> None:
        piece = self._volume.slice(normal=self._normal, origin=self._origin)
        self._slice_mesh.copy_from(piece)
