"""How edges in pictures are smoothed: the values of ``plotter.picture.antialias``, and its default.

The module imports nothing that draws: actors ask it whether there is anything to be done.
"""

from __future__ import annotations

import os
from numbers import Integral
from typing import Any

MODES = ("off", "coverage", "refined")

REFINED = 16  # samples of a pixel in refined pictures

MOST = 256

VARIABLE = "PVFIBLETS_ANTIALIAS"  # environment variable that names another default


def default_antialias() -> str | int:
    """Return the default: ``"refined"``, or what the environment variable `VARIABLE` says."""
    text = os.environ.get(VARIABLE, "refined")
    return check_antialias(VARIABLE, int(text) if text.isdecimal() else text)


def check_antialias(name: str, value: Any) -> str | int:
    """Return a value of the setting."""
    if isinstance(value, str) and value in MODES:
        return value
    if isinstance(value, Integral) and not isinstance(value, bool) and 2 <= int(value) <= MOST:
        return int(value)
    *first, last = (f"{mode!r}" for mode in MODES)
    raise ValueError(f"{name} is {value!r}; give {', '.join(first)}, {last} or a number of samples from 2 to {MOST}")


def samples_of(value: str | int) -> int:
    """Return how many samples of a pixel a still picture has."""
    if isinstance(value, str):
        return REFINED if value == "refined" else 1
    return value
