"""PyVista's rectangles that pick what is visible: they find triangles only, and lines of nobody; so that is told.

PyVista looks for the cells that VTK selected among the triangles of a mesh, which lines have none of. All its other
pickers find this package's lines (`pvfiblets.mappers.vtk_overrides`).
"""

from __future__ import annotations

import inspect
import warnings
from typing import Any

import pyvista as pv

from pvfiblets.plotting.call_signature import method_of_plotters

__all__ = ["METHODS"]

METHODS = ("enable_rectangle_visible_picking", "enable_cell_picking")


def _register(name: str) -> None:
    owner = next(kind for kind in pv.Plotter.__mro__ if name in vars(kind))
    original = vars(owner)[name]

    def enable(plotter: Any, arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
        through = name == "enable_cell_picking" and named.get("through", arguments[1] if len(arguments) > 1 else True)
        if not through and _shows_engine(plotter):
            warnings.warn(
                f"PyVista's {name} of what is visible finds triangles, not lines; "
                "plotter.fiblets.enable_picking(mode='box') finds the streamlines that are seen in a rectangle, and "
                "enable_rectangle_through_picking all that run through it",
                UserWarning,
                stacklevel=3,
            )
        return original(plotter, *arguments, **named)

    component = method_of_plotters(name, enable, inspect.cleandoc(original.__doc__ or ""), inspect.signature(original))
    component.__module__ = __name__
    pv.register_plotter_component(name, owner, override=True)(component)


def _shows_engine(plotter: Any) -> bool:
    from pvfiblets.mappers.engine_mapper import shows_engine

    return any(shows_engine(renderer) for renderer in plotter.renderers)


for _name in METHODS:
    _register(_name)
