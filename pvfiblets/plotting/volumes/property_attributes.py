"""Attributes of a volume's ``prop`` that change its picture, by mode, and warnings for the rest.

Actors of meshes and of ``add_volume`` have settings in their property that mean nothing to rays through values, or mean
something in some modes only. Each is declared once here.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import pyvista as pv

from pvfiblets.plotting.volumes.settings import LIGHT, SURFACE
from pvfiblets.volumes.raycast_options import PROJECTIONS

_PEAKS = "what peaks and projections show is the colour of a value, which no lamp shines on"
_RAYS = "rays through a volume have neither lines nor points"


class Lit(Protocol):
    """What of a volume's actor says which attributes are used."""

    @property
    def prop(self) -> pv.Property:
        """VTK's settings."""
        ...

    @property
    def mode(self) -> str:
        """What a ray shows."""
        ...

    @property
    def shade(self) -> bool:
        """Whether lamps shine on it."""
        ...


@dataclass(frozen=True)
class _Word:
    """A setting of the property: how VTK calls it, where it is used, and what to use elsewhere."""

    vtk: str
    used: tuple[str, ...]
    instead: str
    light: str = ""  # message where light could use it, and its `shade` is off; empty: light never uses it
    reset: bool = False  # whether the old value is restored, because VTK would draw something else by the new one


_SHADE = "set actor.shade = True to have light shaded"
_WORDS = {
    "color": _Word("DiffuseColor", (), "set actor.color for one colour, or actor.cmap"),
    "ambient": _Word("Ambient", (*PROJECTIONS, SURFACE), "", _SHADE),
    "diffuse": _Word("Diffuse", (*PROJECTIONS, SURFACE), "", _SHADE),
    "specular": _Word("Specular", (SURFACE,), _PEAKS, _SHADE),
    "specular_power": _Word("SpecularPower", (SURFACE,), _PEAKS, _SHADE),
    "lighting": _Word("Lighting", (SURFACE,), f"{_PEAKS}; of light, set actor.shade", reset=True),
    "interpolation": _Word(
        "Interpolation", (SURFACE,), "actor.filter says how values between voxels are found; 'pbr' is of surfaces",
        reset=True,
    ),
    "line_width": _Word("LineWidth", (), _RAYS),
    "point_size": _Word("PointSize", (), _RAYS),
    "render_lines_as_tubes": _Word("RenderLinesAsTubes", (), _RAYS),
    "render_points_as_spheres": _Word("RenderPointsAsSpheres", (), _RAYS),
}  # fmt: skip


class PropertyAttributes:
    """The last state of an actor's property."""

    def __init__(self, actor: Lit) -> None:
        self.note(actor)

    def note(self, actor: Lit) -> None:
        """Take what the property says as it is."""
        self._prop, self._said = actor.prop, _read(actor.prop)

    def look(self, actor: Lit) -> None:
        """Warn of changes without effect; a replaced property is taken as it is."""
        prop, known, before = actor.prop, self._prop, self._said
        self.note(actor)
        if prop is not known:
            return
        for name, word in _WORDS.items():
            if self._said[name] == before[name] or _used(word, actor):
                continue
            if word.reset:
                getattr(prop, f"Set{word.vtk}")(before[name])
                self._said[name] = before[name]
            instead = _instead(word, actor)
            warnings.warn(
                f"prop.{name} changes nothing in mode {actor.mode!r}: {instead}", UserWarning, stacklevel=2
            )


def tell_given(actor: Lit, given: Mapping[str, Any]) -> None:
    """Warn of arguments of light that change nothing in an actor's mode."""
    unused = {
        name: _instead(word, actor)
        for name, word in _WORDS.items()
        if word.light and given.get(name) is not None and not _used(word, actor)
    }
    if given.get("shade") is False and actor.mode == LIGHT:
        return  # an explicit shade=False needs no warning
    if given.get("shade") and actor.mode in PROJECTIONS:
        unused["shade"] = _PEAKS
    if unused:
        names = " and ".join(f"{name}={given[name]!r}" for name in unused)
        warnings.warn(
            f"{names} changes nothing in mode {actor.mode!r}: {next(iter(unused.values()))}", UserWarning, stacklevel=6
        )


def _used(word: _Word, actor: Lit) -> bool:
    return actor.mode in word.used or (bool(word.light) and actor.mode == LIGHT and actor.shade)


def _instead(word: _Word, actor: Lit) -> str:
    return word.light if word.light and actor.mode == LIGHT else word.instead


def _read(prop: pv.Property) -> dict[str, Any]:
    return {name: getattr(prop, f"Get{word.vtk}")() for name, word in _WORDS.items()}
