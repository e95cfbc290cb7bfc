"""Files of PyVista's that hold scenes: ``export_gltf``, ``export_obj`` and ``export_vrml``.

VTK's exporters read the data of mappers, not their pictures. So while one of these writes, mappers have real lines
with the colours of the picture as their data (`pvfiblets.mappers.readable_lines`). PyVista's own way to put a component
in the place of a method is used, ``register_plotter_component(..., override=True)``, from the import of
`pvfiblets.plotting` on; ``pyvista.unregister_plotter_component(name)`` undoes it. ``export_html`` and ``export_vtksz``
need nothing: their serializers ask each mapper (`pvfiblets.mappers.browser_views`). ``save_graphic`` holds the picture
itself.
"""

from __future__ import annotations

import inspect
from typing import Any

import pyvista as pv

from pvfiblets.plotting.call_signature import method_of_plotters

__all__ = ["METHODS"]

METHODS = ("export_gltf", "export_obj", "export_vrml")

_MORE = (
    "\n\nOf this package's actors the file holds lines, tubes as surfaces, with the colours of the picture:\n"
    "see pvfiblets.mappers.readable."
)


def _register(name: str) -> None:
    """Put a component in the place of a method of plotters."""
    owner = next(kind for kind in pv.Plotter.__mro__ if name in vars(kind))
    original = vars(owner)[name]
    signature = inspect.signature(original)

    def export(plotter: Any, arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
        window = getattr(plotter, "render_window", None)
        if window is None:
            return original(plotter, *arguments, **named)
        from pvfiblets.mappers.readable_lines import readable

        with readable(window):
            return original(plotter, *arguments, **named)

    component = method_of_plotters(name, export, inspect.cleandoc(original.__doc__ or "") + _MORE, signature)
    component.__module__ = __name__
    pv.register_plotter_component(name, owner, override=True)(component)


for _name in METHODS:
    _register(_name)
