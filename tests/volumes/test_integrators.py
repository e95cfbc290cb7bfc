"""Integrators of the rendering equation against closed forms: orders, limits of stability, and the study of both."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.report.studies.volumes.formulae import (
    MIDDLE,
    PANELS,
    STABLE_UP_TO,
    integrate,
    study,
)  # fmt: skip
from pvfiblets.report.studies.volumes.reference_profiles import Profile, profiles
from pvfiblets.volumes.transfer import Transfer


def named(name, depth=1.0, length=64.0):
    return next(profile for profile in profiles([depth], length) if profile.name == name)


def sampled(method, profile, n, dtype=np.float64):
    """RGBA of a profile by n steps."""
    h = profile.length / n
    values = profile.value(h * (np.arange(n) + 0.5 if method in MIDDLE else np.arange(n + 1)))
    kappa, colour = profile.transfer.extinction(values).astype(dtype), profile.transfer.colour(values)
    rgb, alpha = integrate(method, kappa, colour, h)
    assert rgb.dtype == alpha.dtype == dtype
    return np.append(rgb, alpha)


# --------------------------------------------------------------------------------------------------------- profiles


@pytest.mark.few(10)
@pytest.mark.parametrize("depth", [0.01, 1.0, 30.0])
@pytest.mark.parametrize("name", ["constant", "fade", "ramp", "edge", "peak", "haze", "teeth"])
def test_the_closed_forms_are_the_integral(name, depth):
    """By very many steps of the equation as it stands, from the profile's own functions."""
    profile = named(name, depth)
    assert abs(profile.densest * profile.length - depth) < 1e-5 * depth
    start, end, n = 3.0, 61.0, 400_000
    s = np.linspace(start, end, n + 1)
    s = (s[1:] + s[:-1]) / 2
    kappa, colour = profile.transfer.extinction(profile.value(s)), profile.transfer.colour(profile.value(s))
    passed = np.cumsum(kappa) * (end - start) / n
    weights = kappa * (end - start) / n * np.exp(-passed + kappa * (end - start) / n / 2)
    expected = np.append(weights @ colour, -np.expm1(-passed[-1]))
    assert np.abs(profile.light(start, end) - expected).max() < 2e-6


# ------------------------------------------------------------------------------------------------------ integrators


@pytest.mark.parametrize(
    ("method", "order"), [("riemann", 1), ("exponential", 2), ("simpson", 4), ("rk4", 4), ("romberg", 6)]
)
@pytest.mark.parametrize("table", [[(0.1, 0.3, 1, 0.9), (1, 0.6, 0.1, 0.9)], [(1, 0.6, 0.1, 0.0), (1, 0.6, 0.1, 0.6)]])
def test_orders(method, order, table):
    """Halving the step of a smooth ray divides the error by 2 to the order."""
    profile = Profile("smooth", np.array([0.0, 1.0]), 64.0, Transfer(table, (0.0, 1.0), 30.0))
    exact = profile.light()
    coarse, fine = (np.abs(sampled(method, profile, n) - exact).max() for n in (16, 32))
    assert order - 0.5 < np.log2(coarse / fine) < order + 0.8
    assert coarse < 5 * 0.25**order


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("x", [1e-6, 1.0, 1e3, 1e6])
def test_exponential_steps_are_exact_where_nothing_changes_in_them(x, dtype):
    rng = np.random.default_rng(0)
    kappa, colour = (x * rng.random((3, 5, 8))).astype(dtype), rng.random((3, 5, 8, 3))
    h = np.array([1.0, 0.5, 2.0])[:, None] * np.ones((3, 5))
    rgb, alpha = integrate("exponential", kappa, colour, h)
    depth = kappa.astype(np.float64) * h[..., None]
    before = np.exp(-np.cumsum(depth, axis=-1) + depth)
    expected = ((before * -np.expm1(-depth))[..., None] * colour).sum(axis=-2)
    tolerance = 1e-13 if dtype == np.float64 else 1e-6
    assert np.abs(rgb - expected).max() < tolerance
    assert np.abs(alpha + np.expm1(-depth.sum(axis=-1))).max() < tolerance
    assert rgb.min() >= 0
    assert max(rgb.max(), alpha.max()) <= 1 + 1e-6


def test_rk4_is_the_classic_method_on_equation_6():
    rng = np.random.default_rng(2)
    kappa, colour, h = 3 * rng.random(13), rng.random((13, 3)), 0.2
    rgb, alpha = integrate("rk4", kappa, colour, h)

    def slope(i, light):
        return kappa[i, None] * colour[i] - kappa[i] * light

    for start, found in ((np.zeros(3), rgb), (np.ones(3), rgb + 1 - alpha)):
        light = start
        for i in range(12, 0, -2):
            k1 = slope(i, light)
            k2 = slope(i - 1, light + h * k1)
            k3 = slope(i - 1, light + h * k2)
            k4 = slope(i - 2, light + 2 * h * k3)
            light = light + h / 3 * (k1 + 2 * k2 + 2 * k3 + k4)
        assert np.abs(found - light).max() < 1e-13


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("method", STABLE_UP_TO)
def test_explicit_methods_grow_beyond_their_limits_and_not_before(method, dtype):
    left = []
    for x in (0.99 * STABLE_UP_TO[method], 1.01 * STABLE_UP_TO[method]):
        n = 800
        kappa = np.full(n if method in MIDDLE else n + 1, x, dtype)
        left.append(abs(1 - integrate(method, kappa, np.ones((*kappa.shape, 3)), 1.0)[1]))
    assert left[0] < 1e-1
    assert left[1] > 1e3


@pytest.mark.parametrize(
    ("method", "shape", "colours", "message"),
    [
        ("euler", (4,), (4, 3), "'romberg'"), ("preintegrated", (4,), (4, 3), "call preintegrated"),
        ("simpson", (4,), (4, 3), "3 steps"), ("romberg", (7,), (7, 3), "takes 4"), ("rk4", (1,), (1, 3), "0 steps"),
        ("riemann", (2, 4), (4, 3), r"\(2, 4\)"),
    ],
)  # fmt: skip
def test_bad_input_is_named(method, shape, colours, message):
    with pytest.raises(ValueError, match=message):
        integrate(method, np.ones(shape), np.ones(colours), 0.1)


# -------------------------------------------------------------------------------------------------------- the study


def test_the_study_shows_what_is_stable():
    """From thin to stiff: which integrators stay in bounds, and how far the good ones are from the closed form."""
    methods = tuple(PANELS)
    chosen = [profile for depth in (64e-3, 64.0, 64e3) for profile in profiles([depth]) if profile.name != "teeth"]
    rows = study(chosen, (16, 64, 256), methods=methods, dtypes=("float32", "float64"))
    assert len(rows) == len(chosen) * 3 * len(methods) * 2
    steps = [row.kappa_ds for row in rows]
    assert min(steps) < 1e-3
    assert max(steps) > 1e3
    for row in rows:
        thin = row.kappa_ds < 5e-3
        if row.method == "exponential" or thin:
            assert row.bounded
        if thin:
            assert row.error < (3e-3 if row.profile in ("edge", "peak", "haze") else 2e-4)
        if row.method in STABLE_UP_TO and row.profile in ("constant", "fade") and row.steps >= 64:
            # Steps take turns in the panels' light: below half the limit all is well.
            assert row.bounded or row.kappa_ds > 0.5 * STABLE_UP_TO[row.method]
            assert not row.bounded or row.kappa_ds < STABLE_UP_TO[row.method]
        assert np.isinf(row.error) == np.isinf(row.high)
    constant = [row for row in rows if row.profile == "constant"]
    assert max(row.error for row in constant if row.method == "exponential") < 1e-4
    assert all(row.error == np.inf or row.error > 1 for row in constant if row.method == "rk4" and row.kappa_ds > 3)
