"""PyVista's own plotter, under a name that type checkers and editors know our components by.

``from pvfiblets.plotting.plotter import Plotter`` is :class:`pyvista.Plotter` itself: PyVista finds the components
whichever is imported. Beside this file lies ``plotter.pyi``, which names them: a checker then knows what
``plotter.add_fiblets(...)`` returns, and which properties that has.
"""

from __future__ import annotations

from pyvista import Plotter

__all__ = ["Plotter"]
