"""Arguments of ``add_mesh`` that mean the same for lines, so that scripts written for it run."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv

from pvfiblets.plotting.actors.source_changes import is_dataset
from pvfiblets.plotting.settings.settings import Argument
from pvfiblets.plotting.settings.shared import Common
from pvfiblets.plotting.settings.unsupported_arguments import why_not

OUTLINES = {"add_fiblets": "halos", "add_spline_tubes": "silhouette"}
LIGHT = ("ambient", "diffuse", "specular", "specular_power", "metallic", "roughness")


def _of_property(name: str, what: str) -> Argument:
    return Argument(None, f"{what}: ``actor.prop.{name}``.", kind="float | None")


class LineCommon(Common):
    """Arguments of every ``add_...`` of lines."""

    ambient = _of_property("ambient", "Share of ambient light, 0 to 1")
    diffuse = _of_property("diffuse", "Share of diffuse light, 0 to 1")
    specular = _of_property("specular", "Share of highlights, 0 to 1")
    specular_power = _of_property("specular_power", "Sharpness of highlights, 0 to 128")
    metallic = _of_property("metallic", "Share of metal with ``pbr``, 0 to 1")
    roughness = _of_property("roughness", "Roughness with ``pbr``, 0 to 1")
    pbr = Argument(False, "Physically based light: ``actor.prop.interpolation``.", kind="bool")
    smooth_shading = Argument(None, "Lines are shaded smoothly in any case.", kind="bool | None")
    component = Argument(
        None,
        "Column of ``scalars`` with several. By default vectors of a name are coloured by their magnitude.",
        kind="int | None",
    )
    nan_opacity = Argument(None, "Opacity of ``nan_color``, 0 to 1.", kind="float | None")
    copy_mesh = Argument(
        False, "Data are copied in any case; with True, later changes of a data set give no warning.", kind="bool"
    )


class ThickLineCommon(LineCommon):
    """The same for lines with an outline."""

    silhouette = Argument(None, "Draw an outline around the lines.", kind="bool | None")
    render_lines_as_tubes = Argument(None, "Shade wide lines as tubes.", kind="bool | None")


def translate(add: str, given: dict[str, Any], source: Any, arguments: dict[str, Any], theme: Any) -> None:
    """Put arguments of ``add_mesh`` into those of the actor that have the same meaning."""
    if given.get("smooth_shading") not in (None, True):
        raise TypeError(why_not(add, "smooth_shading"))
    if given.get("silhouette") not in (None, True, False):
        raise TypeError(why_not(add, "silhouette"))
    if given.get("render_lines_as_tubes") is False and add == "add_spline_tubes":
        raise TypeError(why_not(add, "render_lines_as_tubes"))
    if (opacity := given.get("nan_opacity")) is not None:
        if not 0.0 <= opacity <= 1.0:
            raise ValueError(f"nan_opacity is {opacity!r}; give a number from 0 to 1")
        arguments["nan_color"] = pv.Color(arguments.get("nan_color"), default_color=theme.nan_color, opacity=opacity)
    if (component := given.get("component")) is not None:
        arguments["scalars"] = _column(add, component, arguments.get("scalars"), source)


def _column(add: str, component: int, scalars: Any, source: Any) -> np.ndarray:
    rows = scalars
    if isinstance(scalars, str) and is_dataset(source):
        rows = pv.wrap(source).point_data.get(scalars)
    if rows is None or isinstance(rows, str) or np.ndim(rows) != 2:
        raise TypeError(why_not(add, "component"))
    table = np.asarray(rows)
    if not 0 <= component < table.shape[1]:
        most = table.shape[1] - 1
        raise ValueError(f"component is {component!r}; give a column of the scalars, 0 to {most}")
    return table[:, component]


def apply(add: str, given: dict[str, Any], actor: Any) -> None:
    """Set the arguments that are an actor's or its property's."""
    of_property = [*LIGHT, "render_lines_as_tubes"] if add == "add_fiblets" else LIGHT  # tubes are round as they are
    for name in of_property:
        if given.get(name) is not None:
            setattr(actor.prop, name, given[name])
    if given.get("pbr"):
        actor.prop.interpolation = "pbr"
    if given.get("silhouette"):
        setattr(actor, OUTLINES[add], True)
