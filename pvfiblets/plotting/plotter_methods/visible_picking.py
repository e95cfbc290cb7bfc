"""PyVista's rectangle picking of visible cells finds only triangles, never lines, so it warns.

PyVista looks for the cells that VTK selected among the triangles of a mesh, which lines have none of. All its other
pickers find this package's lines (`pvfiblets.mappers.vtk_pipeline.vtk_overrides`).
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from pvfiblets.plotting.settings.call_signature import replace_method

if TYPE_CHECKING:
    import pyvista as pv

METHODS = ("enable_rectangle_visible_picking", "enable_cell_picking")


def _enable(plotter: pv.BasePlotter, original: Any, arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
    through = False
    if original.__name__ == "enable_cell_picking":
        through = named.get("through", arguments[1] if len(arguments) > 1 else True)
    from pvfiblets.mappers.engine_mapper import shows_engine

    if not through and any(map(shows_engine, plotter.renderers)):
        warnings.warn(
            f"PyVista's {original.__name__} finds triangles, not lines; "
            "plotter.fiblets.enable_picking(mode='box') finds the visible streamlines in a rectangle, and "
            "enable_rectangle_through_picking all that run through it",
            UserWarning,
            stacklevel=4,
        )
    return original(plotter, *arguments, **named)


for _name in METHODS:
    replace_method(_name, _enable, __name__)
