"""What a user sets about lines and points with halos, and the `HaloStyle` that this means for what is drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
from pvfiblets.halos.displacement import as_displacement
from pvfiblets.halos.spacing import default_widths
from pvfiblets.plotting.halos.settings import WIDTH_CUE

if TYPE_CHECKING:
    from pvfiblets.plotting.halos.settings import Threshold

TAPERED = (2, 0.2)  # vertices over which ends narrow, and where along the mask those end: the paper's (section 3.4)

_OF_POINTS = (("line_width", "point_size"), ("strip_width", "halo_size"))


class Spacing:
    """What is measured of lines or points for those settings that are not given, each once and when first needed."""

    def __init__(self, drawn: HaloLines | HaloPoints) -> None:
        self._drawn = drawn
        self._width: float | None = None
        self._widths: dict[tuple[float | None, ...], tuple[float, float, float]] = {}
        self._step: float | None = None

    def widths(
        self, line_width: float | None, strip_width: float | None, max_displacement: float | None
    ) -> tuple[float, float, float]:
        """Return widths of lines and strips and the greatest displacement, mm: what is given, and what suits it."""
        given = line_width, strip_width, max_displacement
        if given not in self._widths:
            if line_width is None:
                if self._width is None:
                    self._width = default_widths(self._drawn)[0]
                # A strip has room for halos, however narrow it is wanted.
                line_width = self._width if strip_width is None else min(self._width, 0.5 * strip_width)
            self._widths = {given: default_widths(self._drawn, line_width, strip_width, max_displacement)}
        return self._widths[given]

    @property
    def step(self) -> float:
        """Mean length (mm) of the segments that have one; 0 where there are none."""
        if self._step is None:
            self._step = _mean_step(self._drawn)
        return self._step


@dataclass(frozen=True)
class LookSettings:
    """What a user may set about lines, or points, with halos; ``None`` means what suits the data.

    Of points `line_width` and `strip_width` are the diameters of point and halo, mm.
    """

    line_width: float | None = None
    strip_width: float | None = None
    max_displacement: float | None = None
    displacement: Any = "linear"
    tapering: Any = True
    width_cue: float = WIDTH_CUE
    min_width: float = 1.0
    smooth: bool = True
    filter_by: str | None = None
    threshold: Threshold = None
    filter_taper: float | None = None

    def look(self, drawn: HaloLines | HaloPoints, spacing: Spacing) -> HaloStyle:
        """Return what this means."""
        try:
            return self._look(isinstance(drawn, HaloLines), spacing)
        except ValueError as error:
            if isinstance(drawn, HaloLines):
                raise
            message = str(error)
            for theirs, ours in _OF_POINTS:
                message = message.replace(theirs, ours)
            raise ValueError(message) from None

    def _look(self, lines: bool, spacing: Spacing) -> HaloStyle:
        given = {
            name: _number(name, getattr(self, name), "mm")
            for name in ("line_width", "strip_width", "max_displacement", "filter_taper")
        }
        low, high = _limits(self.threshold)
        if self.filter_by is None and self.threshold is not None:
            raise ValueError(
                f"threshold is {self.threshold!r}, but there are no numbers to filter by; name some, or give an array, "
                "as filter_by"
            )
        n_tapered, t_tapered = _tapering(self.tapering) if lines else (0, TAPERED[1])
        # What is out of range is refused before anything is measured.
        for name in ("line_width", "strip_width", "max_displacement"):
            _refuse(name, given[name], least=0.0, above=name != "max_displacement")
        taper = given["filter_taper"]
        if taper is None:
            taper = 2.0 * spacing.step if lines and self.filter_by is not None else 0.0
        line, strip, displacement = spacing.widths(given["line_width"], given["strip_width"], given["max_displacement"])
        return HaloStyle(
            line_width=line,
            strip_width=strip,
            max_displacement=displacement,
            displacement=as_displacement(self.displacement),
            n_tapered=n_tapered,
            t_tapered=t_tapered,
            width_cue=_number("width_cue", self.width_cue, "0 to 1") or 0.0,
            min_width=_number("min_width", self.min_width, "pixels") or 0.0,
            smooth=bool(self.smooth),
            filter_by=self.filter_by,
            low=low,
            high=high,
            filter_taper=taper,
        )


def _number(name: str, value: Any, unit: str) -> float | None:
    if value is None:
        return None
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name} is {value!r}; give a number ({unit})") from None


def _refuse(name: str, value: float | None, *, least: float, above: bool) -> None:
    if value is None:
        return
    if not math.isfinite(value) or value < least or (above and value == least):
        raise ValueError(f"{name} is {value}; give a number of mm, {'above 0' if above else '0 or more'}")


def _limits(threshold: Any) -> tuple[float, float]:
    """Return the least and the greatest number that a threshold keeps."""
    wrong = f"threshold is {threshold!r}; give the least number that is kept, (least, greatest), or None"
    if threshold is None:
        return -math.inf, math.inf
    try:
        ends = [threshold, None] if np.ndim(threshold) == 0 else list(threshold)
        if isinstance(threshold, str) or len(ends) != 2:
            raise ValueError(wrong)
        low = -math.inf if ends[0] is None else float(ends[0])
        high = math.inf if ends[1] is None else float(ends[1])
    except (TypeError, ValueError):
        raise ValueError(wrong) from None
    if math.isnan(low) or math.isnan(high):
        raise ValueError(wrong)
    return low, high


def _tapering(tapering: Any) -> tuple[Any, float]:
    """Return vertices over which ends narrow, and where along the mask those end."""
    if tapering is True:
        return TAPERED
    if tapering is False or tapering is None:
        return 0, TAPERED[1]
    try:
        n, t = tapering
        return int(n) if float(n) % 1 == 0 else n, float(t)
    except (TypeError, ValueError):
        raise ValueError(
            f"tapering is {tapering!r}; give True, False, or (n, t): vertices over which ends narrow, and how far "
            "along the mask those go"
        ) from None


def _mean_step(drawn: HaloLines | HaloPoints) -> float:
    if not isinstance(drawn, HaloLines) or len(drawn.points) < 2:
        return 0.0
    lengths = np.linalg.norm(np.diff(drawn.points, axis=0), axis=1)
    inside = np.ones(len(lengths), bool)
    ends = drawn.offsets[1:-1]
    inside[ends[(ends > 0) & (ends <= len(lengths))] - 1] = False
    lengths = lengths[inside & (lengths > 0.0)]
    return float(lengths.mean(dtype=np.float64)) if len(lengths) else 0.0
