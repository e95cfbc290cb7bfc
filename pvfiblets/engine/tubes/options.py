"""Options of drawing spline tubes, with defaults."""

from __future__ import annotations

from dataclasses import dataclass

from pvfiblets.support.real_numbers import is_number

from ..view import Style, check_at_least

AUTO = "auto"

SILHOUETTES: dict[str, str] = {
    "rectangles": "one rectangle of the window for each segment, by vertex pulling",
    "boxes": "two oriented boxes for each segment, by the geometry stage (the paper's)",
    "pulled-boxes": "the same boxes by vertex pulling",
}
"""How a segment covers the pixels whose rays may meet it."""


@dataclass(frozen=True)
class Solver:
    """A way to find roots."""

    feature: str | None  # its switch in the shaders
    iterations: int  # steps of one search at most, by default
    about: str


SOLVERS: dict[str, Solver] = {
    "illinois": Solver("TUBE_ILLINOIS", 48, "regula falsi that halves the weight of an end that stays"),
    "itp": Solver("TUBE_ITP", 32, "interpolate, truncate, project (Oliveira and Takahashi 2020)"),
    "newton": Solver("TUBE_NEWTON", 40, "Newton's steps inside the bracket, bisection where they leave it"),
    "bisection": Solver(None, 20, "the paper's: all derivatives, a fixed number of halvings"),
}
"""How roots are found inside a bracket; all but the paper's leave the chain of derivatives out where f is convex."""


@dataclass(frozen=True)
class TubeStyle(Style):
    """How spline tubes become pixels; ``values`` names an attribute of the nodes."""

    # pixels: thinner tubes are widened to that, or many of their pixels would be missed. 0 leaves them as they are.
    min_width: float = 1.0

    def __post_init__(self) -> None:
        check_at_least("min_width", self.min_width, 0.0, "pixels")

    @property
    def half_width(self) -> float:
        """Pixels that a tube reaches to either side of its axis at least."""
        return self.drawn_width / 2.0

    @property
    def drawn_width(self) -> float:
        """Pixels that a tube is drawn with at least: all of one, where edges say how much of it is tube."""
        return max(self.min_width, 1.0) if self.edges and not self.exact else self.min_width

    @property
    def relief(self) -> str:
        """Normals of the surface."""
        return "normal"


def check_choices(
    silhouettes: str = AUTO,
    solver: str = AUTO,
    iterations: int | None = None,
    min_width: float = 1.0,
    culling: str | None = None,
) -> None:
    """Raise where a choice is none."""
    for name, value, known in (("silhouettes", silhouettes, SILHOUETTES), ("solver", solver, SOLVERS)):
        if not isinstance(value, str) or (value != AUTO and value not in known):
            raise ValueError(f"{name} is {value!r}; use one of {[AUTO, *known]}")
    if culling not in (None, "two-phase"):
        raise ValueError(f"culling is {culling!r}; use 'two-phase' or None")
    if iterations is not None and not (is_number(iterations) and iterations % 1 == 0 and iterations >= 1):
        raise ValueError(f"iterations is {iterations!r}; give a whole number above 0, or None for the solver's own")
    if not (is_number(min_width) and 0.0 <= min_width <= 64.0):
        raise ValueError(f"min_width is {min_width!r}; give pixels from 0 (as thin as they are) to 64")
