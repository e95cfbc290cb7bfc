"""Files of PyVista's that hold scenes: ``export_gltf``, ``export_obj`` and ``export_vrml``.

VTK's exporters read the data of mappers, not their pictures. So while one of these writes, mappers have real lines
with the colours of the picture as their data (`pvfiblets.mappers.vtk_pipeline.readable_lines`). ``export_html`` and
``export_vtksz`` need nothing: their serializers ask each mapper (`pvfiblets.mappers.vtk_pipeline.browser_views`).
``save_graphic`` holds the picture itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pvfiblets.plotting.settings.call_signature import replace_method

if TYPE_CHECKING:
    import pyvista as pv

METHODS = ("export_gltf", "export_obj", "export_vrml")

_MORE = (
    "\n\nOf this package's actors the file holds lines, tubes as surfaces, with the colours of the picture:\n"
    "see pvfiblets.mappers.readable."
)


def _export(plotter: pv.BasePlotter, original: Any, arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
    window = getattr(plotter, "render_window", None)
    if window is None:
        return original(plotter, *arguments, **named)
    from pvfiblets.mappers.vtk_pipeline.readable_lines import readable

    with readable(window):
        return original(plotter, *arguments, **named)


for _name in METHODS:
    replace_method(_name, _export, __name__, _MORE)
