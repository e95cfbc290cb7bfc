"""PyVista's side: what a user of :class:`pyvista.Plotter` sees.

``plotter.add_fiblets(...)``, ``plotter.fiblets``, ``plotter.add_spline_tubes(...)``,
``plotter.spline_tubes`` and ``polydata.fiblets`` need no import: PyVista finds them by entry points
(see ``pyproject.toml``), which name the modules ``component``, ``spline_component`` and ``accessor``
here. ``files`` serves ``pyvista.read`` and ``save``. The actor's colours are found in
``scalars`` and made into a look-up table in ``colours``; the drawing is the mapper's.
"""

from __future__ import annotations

from pvfiblets.plotting.actor import FibletActor
from pvfiblets.plotting.component import AddFiblets, FibletsComponent
from pvfiblets.plotting.spline_actor import SplineTubeActor
from pvfiblets.plotting.spline_component import AddSplineTubes, SplineTubesComponent

__all__ = ["AddFiblets", "AddSplineTubes", "FibletActor", "FibletsComponent", "SplineTubeActor", "SplineTubesComponent"]
