"""PyVista's side: what a user of :class:`pyvista.Plotter` sees.

``plotter.add_fiblets(...)``, ``plotter.fiblets`` and ``polydata.fiblets`` need no import: PyVista
finds them by entry points (see ``pyproject.toml``), which name the modules ``component`` and
``accessor`` here. ``files`` serves ``pyvista.read`` and ``save``. The actor's colours are found in
``scalars`` and made into a look-up table in ``colours``; the drawing is the mapper's.
"""

from __future__ import annotations

from pvfiblets.plotting.actor import FibletActor
from pvfiblets.plotting.component import AddFiblets, FibletsComponent

__all__ = ["AddFiblets", "FibletActor", "FibletsComponent"]
