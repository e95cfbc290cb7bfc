"""Quantiles of Student's distribution, of whole degrees of freedom, without SciPy."""

from __future__ import annotations

import math


def _share(t: float, freedom: int) -> float:
    """Probability of a value between -t and t: Abramowitz and Stegun 1964, equations 26.7.3 and 26.7.4."""
    angle = math.atan2(t, math.sqrt(freedom))
    cosine, sine = math.cos(angle), math.sin(angle)
    term = total = 1.0 if freedom % 2 == 0 else cosine
    for k in range(2 if freedom % 2 == 0 else 3, freedom - 1, 2):
        term *= (k - 1) / k * cosine * cosine
        total += term
    if freedom % 2 == 0:
        return sine * total
    return 2.0 / math.pi * (angle + (sine * total if freedom > 1 else 0.0))


def student_quantile(confidence: float, freedom: int) -> float:
    """Return t so that a number lies between -t and t with this probability."""
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence is {confidence}; give a number between 0 and 1, such as 0.95")
    if freedom < 1:
        raise ValueError(f"{freedom} degrees of freedom; at least 1 is needed")
    if freedom > 10_000:  # where the normal distribution's differs by less than 1e-4 of it
        from statistics import NormalDist

        return NormalDist().inv_cdf(0.5 + confidence / 2.0)
    low, high = 0.0, 1.0
    while _share(high, freedom) < confidence:
        high *= 2.0
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _share(middle, freedom) < confidence else (low, middle)
    return 0.5 * (low + high)
