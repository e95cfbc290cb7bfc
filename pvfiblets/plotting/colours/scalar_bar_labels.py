"""Labels beside a scalar bar."""

from __future__ import annotations

import math

import numpy as np

LABELS = 5  # default number of labels beside a bar of PyVista

WHOLE = 2.0**53


def label_format(low: float, high: float) -> str | None:
    """Return what tells the numbers of a range apart; None where VTK's three digits do, as for most."""
    if not (math.isfinite(low) and math.isfinite(high)) or low >= high or max(-low, high) >= WHOLE:
        return None
    if len({f"{value:#.3g}" for value in np.linspace(low, high, LABELS)}) == LABELS:
        return None
    step = (high - low) / (LABELS - 1)
    return f"%.{max(math.ceil(-math.log10(step)) + 1, 0)}f"


def label_text(value: float, form: str | None) -> str:
    """Return a number as it stands beside a bar."""
    return f"{value:#.3g}" if form is None else form % value
