"""Looks: names for settings that give a finished picture together, of one bundle as of a whole brain.

`LOOKS` declares each as a table of settings of `pvfiblets.plotting.fiblets.settings`; `settings_of` makes it into
values for some data, `look_of` says which look some settings are. What is to be as wide as the lines leave room for
goes by the distance between lines (`pvfiblets.mappers.effects.spacing`): widths and radii here, halos and occlusion in
their own defaults.

A look has nothing to do with colours, nor with the whole picture (``plotter.picture``): tone mapping would turn a white
background grey, and change what else is in the scene.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pvfiblets.plotting.settings import shared


@dataclass(frozen=True)
class Apart:
    """A width that follows the distance between lines."""

    times: float  # of that distance
    # the least and the greatest width, as shares of the diagonal of the data's bounds; the greatest where the distance
    # is not known
    least: float
    most: float
    unit: float = 0.0  # what the diagonal is of the width's own unit; 0 for the diagonal in mm

    def value_for(self, data: Any) -> float:
        """Return the width for some data."""
        from pvfiblets.mappers.effects.spacing import line_spacing_of

        size, spacing = shared.bounds_size(data), line_spacing_of(data)
        share = self.most if spacing is None else min(max(self.times * spacing / size, self.least), self.most)
        return float(f"{share * (self.unit or size):.3g}")


@dataclass(frozen=True)
class Fewer:
    """An opacity that falls with the number of streamlines, which lie on each other."""

    # of 300 streamlines. It falls with the fourth root of their number: more of them also lie beside each other.
    opacity: float
    least: float
    most: float

    def value_for(self, data: Any) -> float:
        """Return the opacity for some data."""
        share = self.opacity * (300.0 / max(data.n_streamlines, 1)) ** 0.25
        return float(f"{min(max(share, self.least), self.most):.2g}")


@dataclass(frozen=True)
class Look:
    """One look."""

    doc: str  # its description, for people
    settings: Mapping[str, Any]  # by name; values as they are set, or an `Apart` or `Fewer`


WINDOW = 1000.0  # pixels that the data take of a window, roughly, where they fill it

RADIUS = Apart(0.35, 1.0 / 1600.0, 1.0 / 400.0)
THICK = Apart(0.5, 1.0 / 1100.0, 1.0 / 270.0)
WIDTH = Apart(0.4, 1.0 / WINDOW, 2.5 / WINDOW, WINDOW)

GLASS = Fewer(0.3, 0.05, 0.5)

PLAIN = {
    "line_width": 1.0,
    "style": "surface",
    "tube_radius": None,
    "tube_shading": False,
    "opacity": 1.0,
    "transparency": "all",
    "lighting": True,
    "illuminated": False,
    "ambient_occlusion": False,
    "depth_cue": False,
    "halos": False,
}
"""Settings of every look, in the order in which they are set."""

LOOKS: dict[str, Look] = {
    "plain": Look("thin lines in gentle light", PLAIN),
    "illuminated": Look(
        "lines that shine and lie in each other's shade",
        PLAIN | {"line_width": WIDTH, "illuminated": True, "ambient_occlusion": True},
    ),
    "tubes": Look("round tubes", PLAIN | {"tube_radius": RADIUS}),
    "glass": Look(
        "lines through which one sees all others",
        PLAIN | {"line_width": WIDTH, "opacity": GLASS},
    ),
    "density": Look("light that adds up where lines lie on each other", PLAIN | {"style": "density"}),
    "ink": Look(
        "a drawing in black or white, with gaps between near and far lines",
        PLAIN | {"line_width": WIDTH, "style": "ink", "halos": {"color": "background"}, "depth_cue": {"strength": 0.5}},
    ),
    "studio": Look(
        "thick tubes in soft shade, which fade with the distance",
        PLAIN | {"tube_radius": THICK, "ambient_occlusion": {"strength": 0.7}, "depth_cue": {"strength": 0.35}},
    ),
}


def check_look(name: str, value: Any) -> str | None:
    """Return the name of a look, or None for none."""
    if value is None or (isinstance(value, str) and value in LOOKS):
        return value
    raise ValueError(f"{name} is {value!r}; give one of {', '.join(map(repr, LOOKS))}")


def settings_of(look: str, data: Any) -> dict[str, Any]:
    """Return what a look sets for some data, by name."""
    declared = LOOKS[look].settings
    return {
        name: value.value_for(data) if isinstance(value, (Apart, Fewer)) else value for name, value in declared.items()
    }


def look_of(settings: Mapping[str, Any], data: Any) -> str | None:
    """Return the look that some settings are; None if they are none."""
    for look in LOOKS:
        if all(_same(settings[name], value) for name, value in settings_of(look, data).items()):
            return look
    return None


def _same(value: Any, wanted: Any) -> bool:
    if isinstance(wanted, Mapping):
        given = value if isinstance(value, Mapping) else wanted if value is True else {}
        return all(given.get(key) == one for key, one in wanted.items())
    if wanted is True:
        return value is True or isinstance(value, Mapping)
    return bool(value == wanted)
