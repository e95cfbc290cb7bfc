"""Small charts as SVG text; what a user wrote is escaped in them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np
from numpy.typing import ArrayLike

from pvfiblets.query.measures.band_plot import runs

WAY = "share of the streamline's length"
COLOURS = ("#4e9ad6", "#e8953a", "#58b368", "#d65a7c", "#9d7fd1", "#b8a13b", "#5ec2c2", "#b0745a")


def histogram_chart(counts: ArrayLike) -> str:
    """Return bars of the square roots of counts, so that rare values are seen beside frequent ones."""
    # A few bars that stand far above the others, such as that of the air around a head, are cut off.
    heights = np.sqrt(np.maximum(np.nan_to_num(np.asarray(counts, np.float64)), 0.0))
    if not heights.size or heights.max() <= 0.0:
        return ""
    usual = np.sort(heights)[-1 - len(heights) // 24]
    heights = np.minimum(heights / (min(heights.max(), 1.5 * usual) if usual > 0.0 else heights.max()), 1.0)
    bars = "".join(
        f'<rect x="{i}" y="{1 - h:.3f}" width=".92" height="{h:.3f}"/>' for i, h in enumerate(heights) if h > 0.0
    )
    return (
        f'<svg viewBox="0 0 {len(heights)} 1" preserveAspectRatio="none" fill="currentColor" opacity=".45" '
        f'role="img" aria-label="histogram">{bars}</svg>'
    )


@dataclass(frozen=True, eq=False)
class Band:
    """A mean with its band along streamlines."""

    name: str  # its subject, and its colour
    color: str
    mean: np.ndarray  # (n,): values; non-finite ones leave a gap, also in the band alone
    low: np.ndarray
    high: np.ndarray


def profile_chart(positions: ArrayLike, mean: ArrayLike, low: ArrayLike, high: ArrayLike, title: str = "value") -> str:
    """Return a mean with its band along streamlines."""
    y, below, above = (np.asarray(values, np.float64) for values in (mean, low, high))
    return profiles_chart(positions, [Band(title, COLOURS[0], y, below, above)], title)


def profiles_chart(positions: ArrayLike, bands: Sequence[Band], title: str = "value") -> str:
    """Return several means with their bands over the same places; see :func:`profile_chart`."""
    x = np.asarray(positions, np.float64)
    every = np.array([values for one in bands for values in (one.mean, one.low, one.high)], np.float64)
    shown = every[np.isfinite(every) & np.isfinite(np.repeat(every[::3], 3, axis=0))]
    if not shown.size:
        return ""
    least, most = float(shown.min()), float(shown.max())
    reach = (most - least) or 1.0
    width, height, left, bottom = 290.0, 146.0, 58.0, 30.0
    named = escape(title if len(title) <= 24 else f"{title[:23]}…")

    def across(values: ArrayLike) -> np.ndarray:
        return left + np.asarray(values) * (width - left - 6.0)

    def down(values: ArrayLike) -> np.ndarray:
        return height - bottom - (np.asarray(values) - least) / reach * (height - bottom - 6.0)

    def drawn(one: Band) -> str:
        color, known = escape(one.color), np.isfinite(one.mean)
        edges = [
            np.concatenate(
                [np.c_[across(x[run]), down(one.high[run])], np.c_[across(x[run]), down(one.low[run])][::-1]]
            )
            for run in runs(known & np.isfinite(one.low) & np.isfinite(one.high))
        ]
        curves = [np.c_[across(x[run]), down(one.mean[run])] for run in runs(known)]
        return "".join(
            f'<polygon points="{_points(edge)}" fill="{color}" opacity=".3"/>' for edge in edges
        ) + "".join(  # a line to the place itself is a dot
            f'<polyline points="{_points(curve if len(curve) > 1 else curve.repeat(2, axis=0))}" fill="none" '
            f'stroke="{color}" stroke-width="1.8" stroke-linecap="round"/>'
            for curve in curves
        )

    lines = "".join(map(drawn, bands))
    ticks = "".join(_label(left - 4.0, float(down(value)) + 4.0, f"{value:.3g}", "end") for value in (least, most))
    ends = "".join(
        _label(float(across(share)), height - 17.0, text, anchor)
        for share, text, anchor in (
            (0.0, "0 %", "start"),
            (0.5, "50 %", "middle"),
            (1.0, "100 %", "end"),
        )
    )
    middle = (height - bottom) / 2.0
    axes = (
        f'<polyline points="{left:g},6 {left:g},{height - bottom:g} {width - 6.0:g},{height - bottom:g}" fill="none" '
        f'stroke="currentColor" stroke-width=".6" opacity=".6"/>'
        f"{_label(left + (width - left) / 2, height - 3.0, WAY, 'middle')}"
        f'<g transform="rotate(-90 10 {middle:g})">{_label(10.0, middle + 3.0, named, "middle")}</g>'
    )
    # Tooltips with the values under the pointer.
    step = (width - left - 6.0) / max(len(x) - 1, 1)
    told = "".join(
        f'<rect x="{float(across(a)) - step / 2:.1f}" y="0" width="{step:.2f}" height="{height - bottom:g}" '
        f'fill="transparent"><title>{100.0 * a:.0f} % of the way: {_told(bands, k)}</title></rect>'
        for k, a in enumerate(x)
        if any(np.isfinite(one.mean[k]) for one in bands)
    )
    subjects = ", ".join(one.name for one in bands if one.name != title)
    label = escape(f"{title} along {subjects or 'streamlines'}")
    return (
        f'<svg viewBox="0 0 {width:g} {height:g}" width="100%" role="img" aria-label="{label}">'
        f"{lines}{axes}{ticks}{ends}{told}</svg>"
    )


def _points(places: np.ndarray) -> str:
    return " ".join(f"{a:.1f},{b:.1f}" for a, b in places)


def _told(bands: Sequence[Band], place: int) -> str:
    """Return the values at a place, for people."""
    return ", ".join(_value(one, place) for one in bands if np.isfinite(one.mean[place]))


def _value(one: Band, place: int) -> str:
    low, high = one.low[place], one.high[place]
    reach = f" ({low:.4g} to {high:.4g})" if low < high else ""
    return f"{escape(one.name if len(one.name) <= 24 else f'{one.name[:23]}…')} {one.mean[place]:.4g}{reach}"


def _label(x: float, y: float, text: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="10" fill="currentColor" text-anchor="{anchor}">{text}</text>'


def steps(limits: Sequence[float]) -> float:
    """Return a slider's step for limits: a round number that divides them into a few hundred."""
    reach = abs(float(limits[1]) - float(limits[0]))
    if not np.isfinite(reach) or reach <= 0.0:
        return 1.0
    return float(10.0 ** np.floor(np.log10(reach / 200.0)))


def short(value: float) -> str:
    """Return a number as panels show it."""
    return f"{value:.4g}"
