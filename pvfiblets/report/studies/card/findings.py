"""The findings of a check of a graphics card: one line for each test, in plain words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

EMPTY = "empty"
"""The figure that is 1 where a picture shows nothing at all."""
WORKS, DRAWN, DIFFERS, SLOW, MISSING, FAILS = "works", "drawn", "differs", "too slow", "missing", "fails"
BAD = (DIFFERS, FAILS)
"""Verdicts that make a check exit with 1."""


@dataclass(frozen=True)
class Finding:
    """One thing that was tried."""

    # Its group, and its name
    part: str
    feature: str
    verdict: str  # One of `'works'`, `'drawn'` (not compared), `'differs'`, `'too slow'`, `'missing'` and `'fails'`
    note: str = ""  # Why, in a few words
    # What was measured; errors are shares of 1 unless their name says otherwise
    figures: dict[str, float] = field(default_factory=dict)
    limits: dict[str, float] = field(default_factory=dict)  # What the figures may be at most
    ms: float | None = None  # Of one picture, once all is compiled
    first_ms: float | None = None  # Of the first picture, with compiling

    @property
    def bad(self) -> bool:
        """Whether it makes the check fail."""
        return self.verdict in BAD

    def as_dict(self) -> dict[str, Any]:
        """Return plain values."""
        return asdict(self)

    @property
    def words(self) -> str:
        """The note, and figures that are above their limits, or else the worst beside its limit."""
        names = [name for name in self.limits if name != EMPTY or self.figures[name]]
        worst = sorted(names, key=lambda name: -self.figures[name] / max(self.limits[name], 1e-300))
        above = [name for name in worst if not self.figures[name] <= self.limits[name]]
        told = [_with_limit(name, self.figures[name], self.limits[name]) for name in above or worst[:1]]
        return "; ".join([self.note] * bool(self.note) + told)


def verdict_of(figures: Mapping[str, float], limits: Mapping[str, float], compared: bool = True) -> str:
    """Return whether all figures are within their limits; NaN is not."""
    good = WORKS if compared else DRAWN
    return good if all(figures[name] <= limit for name, limit in limits.items()) else DIFFERS


def table(findings: Iterable[Finding]) -> str:
    """Return all as a person reads them, one a line."""
    rows = [("part", "what", "verdict", "ms", "worst error, of pixels if no unit is named; or why")]
    rows += [
        (one.part, one.feature, one.verdict, "" if one.ms is None else f"{one.ms:,.1f}", one.words) for one in findings
    ]
    widths = [max(len(row[column]) for row in rows) for column in range(4)]
    lines = []
    for row in rows:
        cells = [row[column].ljust(widths[column]) for column in range(3)]
        lines.append("  ".join([*cells, row[3].rjust(widths[3]), row[4]]).rstrip())
    return "\n".join(lines)


def totals(findings: Iterable[Finding]) -> str:
    """Return a sentence with the number of each verdict."""
    found = Counter(one.verdict for one in findings)
    words = {WORKS: ("works", "work"), DRAWN: ("was drawn and not compared", "were drawn and not compared"),
             SLOW: ("works slowly", "work slowly"),
             MISSING: ("is missing in this OpenGL", "are missing in this OpenGL")}  # fmt: skip
    parts = [f"{found[verdict]} {both[found[verdict] > 1]}" for verdict, both in words.items() if found[verdict]]
    return ", ".join(parts) or "nothing works"


def _with_limit(name: str, value: float, limit: float) -> str:
    """Return an error and its limit: in the unit that its name ends with, else as a share."""
    name, _, unit = name.partition(", ")
    if not unit:
        return f"{name} {100.0 * value:.2g} % (at most {100.0 * limit:.3g} %)"
    return f"{name} {value:.2g} {unit} (at most {limit:.3g} {unit})"
