"""Components of plotters that are imported when somebody first asks for them.

PyVista's entry points do the same for `pyvista.Plotter`; a `pyvistaqt.QtInteractor` finds what its classes have. So
each name is an attribute of `pyvista.BasePlotter` that puts the component in its own place.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

import pyvista as pv

AnyComponent = TypeVar("AnyComponent", bound=type)

HOMES = {
    "add_fiblets": "fiblets.component",
    "fiblets": "fiblets.component",
    "add_spline_tubes": "tubes.component",
    "spline_tubes": "tubes.component",
    "add_halo_lines": "halos.component",
    "halo_lines": "halos.component",
    "add_halo_points": "halos.component",
    "halo_points": "halos.component",
    "add_raycast_volume": "volumes.component",
    "raycast_volumes": "volumes.component",
    "add_slices": "slices.component",
    "slices": "slices.component",
    "add_connectome": "connectomes.component",
    "connectomes": "connectomes.component",
    "picture": "picture_component",
}
"""Modules of components by name, as the entry points of ``pyproject.toml`` have them."""


class _Pending:
    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, plotter: pv.BasePlotter, owner: type) -> Any:
        import_module(f"pvfiblets.plotting.{HOMES[self._name]}")
        return getattr(owner if plotter is None else plotter, self._name)


def await_components() -> None:
    """Have plotters import each component when it is first asked for."""
    for name in HOMES:
        if name not in vars(pv.BasePlotter):
            setattr(pv.BasePlotter, name, _Pending(name))


def register(name: str) -> Callable[[AnyComponent], AnyComponent]:
    """Return a decorator that makes a class a component of plotters: ``plotter.NAME``."""
    if isinstance(vars(pv.BasePlotter).get(name), _Pending):
        delattr(pv.BasePlotter, name)
    return pv.register_plotter_component(name)
