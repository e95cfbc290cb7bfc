"""How the rendering equation is integrated from samples along a ray, and how far each way is from a closed form.

Source: Lesar, "Real-time ray casting of volumetric data" (2015), section III-E. Along a ray towards the eye light obeys
``dI/ds = g - kappa I`` (equation 6). That is linear: for every stretch, the light out of its front is

    I_front = b + a I_back

with the transparency ``a`` and the light ``b`` of the stretch itself. Each integrator is a formula for ``a`` and ``b``
from the samples of one panel of steps; panels are then put together front to back, which is exact.

==================  =====  =======  =============================================================================
integrator          steps  samples  a and b, with h the length of a step and tau the optical depth from the front
==================  =====  =======  =============================================================================
``riemann``         1      middle   ``1 - kappa h``, ``kappa c h``: the paper's sum, Euler's method on equation 6
``exponential``     1      middle   ``exp(-kappa h)``, ``c (1 - a)``: exact where both are constant over the step
``simpson``         2      ends     ``exp(-tau)``, Simpson's rule for equation 7; tau by the same parabola
``romberg``         4      ends     the same with the trapezoidal rule of 1, 2 and 4 intervals, extrapolated twice
``rk4``             2      ends     the classic Runge-Kutta method on equation 6 from back to front
``preintegrated``   1      ends     exact where the value is linear over the step: a table by both ends' values
==================  =====  =======  =============================================================================

Stability. The factor of the light behind must not exceed 1, whatever the optical depth ``x = kappa h`` of a step:

* ``riemann`` has ``a = 1 - x``: negative, so that light turns dark and back, from 1 on, and unbounded from 2 on.
* ``rk4`` has over its two steps ``a = 1 - y + y^2/2 - y^3/6 + y^4/24`` with ``y = 2 x``: unbounded from y = 2.785 on.
* ``simpson`` and ``romberg`` have an ``a`` in 0..1 always, as all their weights are positive, but a ``b`` of about
  ``x / 3`` and ``14 x / 45`` where x is large: not unstable, and yet of no use beyond x of about 1.
* ``exponential`` and ``preintegrated`` have ``a`` in 0..1 and a ``b`` that is a mean of colours times ``1 - a``: the
  result is in 0..1 always. Only the latter accounts for values between samples.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.volumes.transfer import Transfer

from .reference_profiles import Profile

Array = npt.NDArray[np.float64]
Floats = npt.NDArray[Any]  # float32 or float64

PANELS = {"riemann": 1, "exponential": 1, "simpson": 2, "romberg": 4, "rk4": 2}
"""Steps that each integrator of samples takes at a time."""

INTEGRATORS = (*PANELS, "preintegrated")

MIDDLE = ("riemann", "exponential")  # integrators that take a sample in the middle of each step, not at its ends

STABLE_UP_TO = {"riemann": 2.0, "rk4": 2.785293563405282 / 2.0}
"""Largest ``kappa h`` at which light does not grow from panel to panel, for the integrators with a limit."""

PHASES = 5
"""Rays of a profile in a study. They begin at different places, so that no sample lies well or badly by chance."""

LATEST = 1 / 16  # part of a profile before which they begin; all are shorter than it by this part


def integrate(method: str, kappa: npt.ArrayLike, colour: npt.ArrayLike, ds: npt.ArrayLike) -> tuple[Floats, Floats]:
    """Colour and opacity of rays from samples, n steps of each."""
    if method not in PANELS:
        hint = ": call preintegrated() with values" if method == "preintegrated" else ""
        raise ValueError(f"integrator is {method!r}; choose one of {', '.join(map(repr, PANELS))}{hint}")
    kappa = np.asarray(kappa)
    kappa = kappa.astype(np.float32 if kappa.dtype == np.float32 else np.float64, copy=False)
    colour, h = np.asarray(colour, kappa.dtype), np.asarray(ds, kappa.dtype)
    panel = PANELS[method]
    if colour.shape != (*kappa.shape, 3):
        raise ValueError(f"colours have the shape {colour.shape}; extinction has {kappa.shape}, so give (..., 3) of it")
    steps = kappa.shape[-1] - (0 if method in MIDDLE else 1)
    if steps < 1 or steps % panel:
        raise ValueError(f"{steps} steps; {method!r} takes {panel} at a time: give a multiple of it, 1 or more")
    # Panels last but one: (..., panels, samples)
    if method in MIDDLE:
        kappa, colour = kappa[..., None], colour[..., None, :]
    else:
        at = np.arange(0, steps, panel)[:, None] + np.arange(panel + 1)
        kappa, colour = kappa[..., at], colour[..., at, :]
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        a, b = _FORMULAE[method](kappa, colour, h[..., None])
        return composed(b, a)


def composed(light: Floats, transparency: Floats) -> tuple[Floats, Floats]:
    """Put stretches of rays together, front to back: colour and opacity of the whole."""
    through = np.cumprod(transparency, axis=-1)
    before = np.concatenate([np.ones_like(through[..., :1]), through[..., :-1]], axis=-1)
    rgb: Floats = (before[..., None] * light).sum(axis=-2, dtype=light.dtype)
    return rgb, 1 - through[..., -1]


def preintegrated(values: npt.ArrayLike, transfer: Transfer, ds: float) -> tuple[Floats, Floats]:
    """Colour and opacity of rays from values at the ends of steps, between which the value counts as linear."""
    table = transfer.preintegrated(float(ds))
    low, high = transfer.clim
    where = np.clip((np.asarray(values, np.float64) - low) / (high - low), 0.0, 1.0) * (len(table) - 1)
    below = np.minimum(where.astype(np.int64), len(table) - 2)
    share = (where - below).astype(np.float32)[..., None]
    i, j, u, v = below[..., :-1], below[..., 1:], share[..., :-1, :], share[..., 1:, :]
    front, back = (1 - v) * table[i, j] + v * table[i, j + 1], (1 - v) * table[i + 1, j] + v * table[i + 1, j + 1]
    steps = (1 - u) * front + u * back
    return composed(steps[..., :3], 1 - steps[..., 3])


# ------------------------------------------------------------------------------------------------------- the formulae
# Each takes kappa (..., panels, samples), colours with one axis more, and h, to be broadcast over panels; and gives
# a (..., panels) and b (..., panels, 3).


def _riemann(kappa: Floats, colour: Floats, h: Floats) -> tuple[Floats, Floats]:
    x = kappa[..., 0] * h
    return 1 - x, x[..., None] * colour[..., 0, :]


def _exponential(kappa: Floats, colour: Floats, h: Floats) -> tuple[Floats, Floats]:
    x = kappa[..., 0] * h
    return np.exp(-x), -np.expm1(-x)[..., None] * colour[..., 0, :]


def _transparencies(kappa: Floats, h: Floats) -> Floats:
    """``exp(-tau)`` at each sample, by the polynomial through all of them."""
    # Such a polynomial may dip below 0 where extinction rises steeply; tau is kept from falling, and from getting
    # beyond that of the whole panel, which is positive.
    tau = np.einsum("kj,...j->...k", _cumulative(kappa.shape[-1]).astype(kappa.dtype), kappa) * h[..., None]
    return np.exp(-np.minimum(np.maximum.accumulate(np.maximum(tau, 0), axis=-1), np.maximum(tau[..., -1:], 0)))


def _cumulative(samples: int) -> Array:
    """``(samples, samples)`` weights that integrate the polynomial through samples at 0, 1, ... up to each of them."""
    x = np.arange(float(samples))
    powers = np.arange(samples)
    weights: Array = x[:, None] ** (powers + 1) / (powers + 1) @ np.linalg.inv(x[:, None] ** powers)
    return weights


def _simpson(kappa: Floats, colour: Floats, h: Floats) -> tuple[Floats, Floats]:
    through = _transparencies(kappa, h)
    f = (kappa * through)[..., None] * colour
    return through[..., -1], (f[..., 0, :] + 4 * f[..., 1, :] + f[..., 2, :]) * (h / 3)[..., None]


def _romberg(kappa: Floats, colour: Floats, h: Floats) -> tuple[Floats, Floats]:
    through = _transparencies(kappa, h)
    f = (kappa * through)[..., None] * colour
    ends = (f[..., 0, :] + f[..., 4, :]) / 2
    sums = [4 * ends, 2 * (ends + f[..., 2, :]), ends + f[..., 1:4, :].sum(axis=-2)]
    for order in (4, 16):
        sums = [finer + (finer - coarser) / (order - 1) for coarser, finer in pairwise(sums)]
    return through[..., -1], sums[0] * h[..., None]


def _rk4(kappa: Floats, colour: Floats, h: Floats) -> tuple[Floats, Floats]:
    """The method is affine in the incoming light: b is its result for none, and a for 1 without emission."""
    front, middle, back = (kappa[..., k, None] for k in range(3))
    emission = kappa[..., None] * colour
    h = (2 * h)[..., None]

    def out(light: Floats, g: Floats) -> Floats:
        k1 = g[..., 2, :] - back * light
        k2 = g[..., 1, :] - middle * (light + h / 2 * k1)
        k3 = g[..., 1, :] - middle * (light + h / 2 * k2)
        k4 = g[..., 0, :] - front * (light + h * k3)
        return light + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)

    nothing = np.zeros_like(emission)
    a = out(np.ones_like(back), nothing[..., :1])
    return a[..., 0], out(nothing[..., 0, :], emission)


_FORMULAE = {
    "riemann": _riemann,
    "exponential": _exponential,
    "simpson": _simpson,
    "romberg": _romberg,
    "rk4": _rk4,
}


# ---------------------------------------------------------------------------------------------------------- the study


@dataclass(frozen=True)
class Row:
    """One integrator on one profile."""

    profile: str
    method: str
    dtype: str
    steps: int  # Per ray
    kappa_ds: float  # Optical depth of a step where the profile is densest
    error: float  # Largest difference of colour or opacity to the closed form; inf where a result is not finite
    # Least and greatest colour or opacity
    low: float
    high: float

    @property
    def bounded(self) -> bool:
        """Whether all results are colours and opacities, 0 to 1, but for what rounding adds."""
        return self.low >= -1e-4 and self.high <= 1.0 + 1e-4


def study(
    profiles: Iterable[Profile],
    steps: Sequence[int],
    *,
    methods: Sequence[str] = INTEGRATORS,
    dtypes: Sequence[str] = ("float32",),
) -> list[Row]:
    """Errors of integrators against closed forms, by step."""
    rows = []
    for profile in profiles:
        part = (1.0 - LATEST) * profile.length
        starts = np.linspace(0.0, profile.length - part, PHASES)
        exact = np.array([profile.light(start, start + part) for start in starts])
        for n in steps:
            h = part / n
            for method in methods:
                at = starts[:, None] + h * (np.arange(n) + 0.5 if method in MIDDLE else np.arange(n + 1))
                values = profile.value(at)
                for dtype in dtypes if method != "preintegrated" else ("float32",):
                    if method == "preintegrated":
                        rgb, alpha = preintegrated(values, profile.transfer, h)
                    else:
                        kappa = profile.transfer.extinction(values).astype(dtype)
                        rgb, alpha = integrate(method, kappa, profile.transfer.colour(values), h)
                    found = np.concatenate([rgb, alpha[:, None]], axis=1).astype(np.float64)
                    fine = bool(np.isfinite(found).all())
                    error = float(np.abs(found - exact).max()) if fine else np.inf
                    low, high = (float(found.min()), float(found.max())) if fine else (-np.inf, np.inf)
                    rows.append(Row(profile.name, method, dtype, n, profile.densest * h, error, low, high))
    return rows
