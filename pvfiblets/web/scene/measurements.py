"""Measured distances of a scene; they are part of its document, as layers and cuts are."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pvfiblets.web.scene.cameras import NEAR
from pvfiblets.web.scene.distance_label import hidden_distances
from pvfiblets.web.session.document import Measurement
from pvfiblets.web.values import numbers, shown, whole

if TYPE_CHECKING:
    from pvfiblets.web.scene.scene import Scene

MOST_MEASUREMENTS = 64
_FARTHEST = 1e12  # mm from the origin


class SceneMeasurements:
    """Measured distances of a scene; pixels count from the lower left corner."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    def place_at(self, x: float, y: float) -> list[float] | None:
        """Return the position on the surface, line or slice at a pixel, mm; distances are looked through."""
        pane = self.scene.slicing.pane_at(x, y)
        if pane is not None:
            return [float(part) for part in pane.position_at(x, y)]
        with hidden_distances(self.scene.plotter):
            return self.scene.cameras.place_at(x, y, tolerance=NEAR)

    def add_measurement(self, begin: Any, end: Any) -> Measurement:
        """Keep the distance between two places, mm, in the picture; it can be undone."""
        before = self.scene.state.measurements
        found = next(iter(check_measurements([[begin, end]])), None)
        if found is None:
            raise ValueError("both ends of the distance are the same point; choose two points")
        if len(before) >= MOST_MEASUREMENTS:
            raise ValueError(f"there are {MOST_MEASUREMENTS} measurements, which is the most; remove one first")
        self.scene.become(replace(self.scene.state, measurements=(*before, found)), f"measure {found.text}")
        return found

    def remove_measurement(self, row: int) -> None:
        """Take one measurement away."""
        before = self.scene.state.measurements
        if not before:
            raise ValueError("there are no measurements")
        at = whole(row, "row of a measurement", 0, len(before) - 1)
        kept = (*before[:at], *before[at + 1 :])
        self.scene.become(replace(self.scene.state, measurements=kept), f"remove {before[at].text}")

    def clear_measurements(self) -> None:
        """Take all measurements away."""
        self.scene.become(replace(self.scene.state, measurements=()), "clear measurements")


def check_measurements(value: Any) -> tuple[Measurement, ...]:
    """Return measurements of pairs of places, mm; pairs without a distance are dropped."""
    if not isinstance(value, list) or len(value) > MOST_MEASUREMENTS:
        raise ValueError(f"measurements is {shown(value)}; give a list of {MOST_MEASUREMENTS} at most")
    found = []
    for pair in value:
        if not isinstance(pair, list) or len(pair) != 2:
            raise ValueError(f"a measurement is {shown(pair)}; give two places of x, y and z, mm")
        begin, end = (numbers(place, "place of a measurement", 3) for place in pair)
        if max(map(abs, (*begin, *end))) > _FARTHEST:
            raise ValueError(f"a measurement is from {begin} to {end}; give places within {_FARTHEST:g} mm")
        measured = Measurement((begin[0], begin[1], begin[2]), (end[0], end[1], end[2]))
        if measured.mm > 0.0:  # older sessions hold some that clicks without a drag have left
            found.append(measured)
    return tuple(found)
