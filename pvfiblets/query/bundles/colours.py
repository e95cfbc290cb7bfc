"""Colours that are easily told apart, and colours as people write them, without a drawing library."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt


def distinct_colours(count: int) -> npt.NDArray[np.float64]:
    """Return n bright colours, (n, 3) from 0 to 1, with different neighbours."""
    # The hues are multiples of the golden ratio, so that no two of the first thousands are the same; saturation and
    # brightness change with a rhythm of their own.
    return _colours(np.arange(count))


def distinct_colour(number: int) -> tuple[float, float, float]:
    """Return the colour of a number from 0 on, as :func:`distinct_colours` has it."""
    red, green, blue = _colours(np.array([number]))[0].tolist()
    return red, green, blue


def _colours(index: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
    hue = np.modf(index * 0.6180339887498949)[0][:, None]
    saturation, value = (np.array(some)[index % 3][:, None] for some in ((0.9, 0.6, 0.75), (1.0, 0.9, 0.75)))
    # Travis, "Effective Color Displays", 1991: the hexagon of hues as three ramps.
    ramp = np.clip(np.abs(np.mod(hue * 6.0 + [0.0, 4.0, 2.0], 6.0) - 3.0) - 1.0, 0.0, 1.0)
    return np.asarray(value * (1.0 - saturation * (1.0 - ramp)))


def hex_colour(parts: Iterable[float]) -> str:
    """Return red, green, blue from 0 to 1 as ``#rrggbb``."""
    return "#" + "".join(f"{round(255 * part):02x}" for part in parts)


def as_colour(given: Any) -> tuple[float, float, float]:
    """Return a colour as red, green, blue from 0 to 1."""
    if isinstance(given, str):
        try:
            if re.fullmatch("#.{6}", given):  # PyVista takes longer to load
                parts = [int(given[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
                return parts[0], parts[1], parts[2]
            from pyvista import Color

            red, green, blue = Color(given).float_rgb
        except ValueError:
            raise ValueError(f"{given!r} is no colour; give '#rrggbb', a name, or three numbers") from None
        return float(red), float(green), float(blue)
    values = np.asarray(given)
    whole = values.dtype.kind in "iu"
    top = 255.0 if whole else 1.0
    if values.shape != (3,) or values.dtype.kind not in "iuf" or not ((values >= 0) & (values <= top)).all():
        raise ValueError(f"{given!r} is no colour; give '#rrggbb', a name, or three numbers from 0 to 1 (or 255)")
    scaled = values.astype(np.float64) / (255.0 if whole else 1.0)
    return float(scaled[0]), float(scaled[1]), float(scaled[2])
