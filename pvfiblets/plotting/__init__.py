"""The PyVista interface: the components that :class:`pyvista.Plotter` offers to its users.

``plotter.add_fiblets(...)``, ``plotter.fiblets``, ``plotter.add_spline_tubes(...)``,
``plotter.spline_tubes``, ``plotter.add_halo_lines(...)``, ``plotter.halo_lines``,
``plotter.add_halo_points(...)``, ``plotter.halo_points``, ``plotter.add_raycast_volume(...)``,
``plotter.raycast_volumes``, ``plotter.add_slices(...)``, ``plotter.slices``,
``plotter.add_connectome(...)``, ``plotter.connectomes`` and ``polydata.fiblets`` need no
import: PyVista finds them by entry points (see ``pyproject.toml``), which name the modules
``component`` of each drawable's folder and ``accessor`` here. ``files`` serves
``pyvista.read`` and ``save``. What can be set of a drawable is declared once, in the
``settings`` of its folder. The actor's colours are found in ``scalars`` and made into a look-up
table in ``colours``; the drawing is the mapper's.

After importing this package, any plotter has the components (:mod:`.components`). Each is imported when somebody
asks for it, and imports actors, mappers and the engine with the first ``add_*``: a scene of lines loads no volumes, and
a compressed file no compiler.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pvfiblets.plotting.components import await_components
from pvfiblets.support.lazy_imports import names_from

if TYPE_CHECKING:
    from pvfiblets.plotting.connectomes.component import AddConnectome, ConnectomesComponent
    from pvfiblets.plotting.connectomes.graph import ConnectomeGraph
    from pvfiblets.plotting.fiblets.actor import FibletActor
    from pvfiblets.plotting.fiblets.component import AddFiblets, FibletsComponent
    from pvfiblets.plotting.halos.actors import HaloLineActor, HaloPointActor
    from pvfiblets.plotting.halos.component import (
        AddHaloLines,
        AddHaloPoints,
        HaloLinesComponent,
        HaloPointsComponent,
    )
    from pvfiblets.plotting.slices.component import AddSlices, SlicesComponent
    from pvfiblets.plotting.slices.layer import SliceLayer
    from pvfiblets.plotting.slices.stack import SliceStack
    from pvfiblets.plotting.tubes.actor import TubeActor
    from pvfiblets.plotting.tubes.component import AddSplineTubes, SplineTubesComponent
    from pvfiblets.plotting.volumes.actor import VolumeActor
    from pvfiblets.plotting.volumes.component import AddRaycastVolume, RaycastVolumesComponent

__all__ = [
    "AddConnectome",
    "AddFiblets",
    "AddHaloLines",
    "AddHaloPoints",
    "AddRaycastVolume",
    "AddSlices",
    "AddSplineTubes",
    "ConnectomeGraph",
    "ConnectomesComponent",
    "FibletActor",
    "FibletsComponent",
    "HaloLineActor",
    "HaloLinesComponent",
    "HaloPointActor",
    "HaloPointsComponent",
    "RaycastVolumesComponent",
    "SliceLayer",
    "SliceStack",
    "SlicesComponent",
    "SplineTubesComponent",
    "TubeActor",
    "VolumeActor",
]

_HOME = {
    "AddFiblets": "fiblets.component",
    "FibletsComponent": "fiblets.component",
    "AddHaloLines": "halos.component",
    "AddHaloPoints": "halos.component",
    "HaloLinesComponent": "halos.component",
    "HaloPointsComponent": "halos.component",
    "AddRaycastVolume": "volumes.component",
    "RaycastVolumesComponent": "volumes.component",
    "AddConnectome": "connectomes.component",
    "ConnectomesComponent": "connectomes.component",
    "AddSlices": "slices.component",
    "SlicesComponent": "slices.component",
    "AddSplineTubes": "tubes.component",
    "SplineTubesComponent": "tubes.component",
    "ConnectomeGraph": "connectomes.graph",
    "FibletActor": "fiblets.actor",
    "HaloLineActor": "halos.actors",
    "HaloPointActor": "halos.actors",
    "VolumeActor": "volumes.actor",
    "SliceLayer": "slices.layer",
    "SliceStack": "slices.stack",
    "TubeActor": "tubes.actor",
}

__getattr__, __dir__ = names_from(__name__, _HOME)

await_components()
