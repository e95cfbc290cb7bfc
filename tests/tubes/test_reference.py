"""Rays against tubes: closed forms of spheres, capsules and round cones, dense sampling of everything else."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from pvfiblets.report.studies.tubes.reference import CAP, ENTRY, EXIT, MISS, hits, nearest_hits, surface_distance


def curve(controls, t):
    return (1 - t) ** 2 * controls[0] + 2 * t * (1 - t) * controls[1] + t**2 * controls[2]


def stretches(controls, origin, direction, count=100_001, least=0.0):
    """Entry and exit of every interval of one half, by sampling; with `least`, of where ``g`` is at least that."""
    t = np.linspace(0.0, 1.0, count)[:, None]
    spheres = curve(controls, t)
    unit = direction / np.linalg.norm(direction)
    away = spheres[:, :3] - origin
    x = away @ unit
    g = spheres[:, 3] ** 2 - ((away - x[:, None] * unit) ** 2).sum(axis=1)
    inside = np.flatnonzero(g >= least)
    runs = np.split(inside, np.flatnonzero(np.diff(inside) > 1) + 1) if len(inside) else []
    return [((x[r] - np.sqrt(g[r])).min(), (x[r] + np.sqrt(g[r])).max()) for r in runs]


def attained(controls, origins, directions, found):
    """How far places met are from the surface of the sphere whose `t` they name."""
    met = found.kind > 0
    unit = directions[met] / np.linalg.norm(directions[met], axis=1, keepdims=True)
    spheres = np.array([curve(c, t) for c, t in zip(controls[met], found.t[met], strict=True)]).reshape(-1, 4)
    places = origins[met] + found.l[met, None] * unit
    return np.abs(np.linalg.norm(places - spheres[:, :3], axis=1) - spheres[:, 3])


def straight(start, stop, radius, end_radius):
    return np.array([[*start, radius], [*(np.add(start, stop) / 2), (radius + end_radius) / 2], [*stop, end_radius]])


def aimed(controls, rng, aside=0.5):
    """A ray at each half: it passes a sphere's centre at up to about `aside` radii."""
    n = len(controls)
    spheres = np.array([curve(c, t) for c, t in zip(controls, rng.random(n), strict=True)])
    directions = rng.normal(size=(n, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    span = np.abs(controls[:, :, :3] - spheres[:, None, :3]).max(axis=(1, 2)) + controls[:, :, 3].max(axis=1)
    origins = spheres[:, :3] + aside * rng.normal(size=(n, 3)) * spheres[:, 3:] - 3.0 * span[:, None] * directions
    return origins, directions


# -------------------------------------------------------------------------------------------------- closed forms


def sphere_stretch(origin, unit, centre, radius):
    along = (centre - origin) @ unit
    square = radius**2 - ((centre - origin - along * unit) ** 2).sum()
    return (along - np.sqrt(square), along + np.sqrt(square)) if square >= 0.0 else None


def cone_stretch(origin, unit, start, stop, radius, end_radius):
    """Entry and exit of the hull of two spheres: the spheres, and the cone that touches both between its circles."""
    axis = stop - start
    length = np.linalg.norm(axis)
    axis = axis / length
    sine = (radius - end_radius) / length  # the cone's surface: distance from axis * cosine + place on axis * sine = r
    cosine2 = 1.0 - sine**2
    w, a0, a1 = origin - start, (origin - start) @ axis, unit @ axis
    b0, b1 = radius - sine * a0, -sine * a1
    p = cosine2 * (1.0 - a1**2) - b1**2
    q = cosine2 * (w @ unit - a0 * a1) - b0 * b1
    s = cosine2 * (w @ w - a0**2) - b0**2
    found = []
    if q * q - p * s >= 0.0 and p != 0.0:
        for root in ((-q - np.sqrt(q * q - p * s)) / p, (-q + np.sqrt(q * q - p * s)) / p):
            place = a0 + root * a1
            rest = radius - sine * place
            # The sphere that touches there lies ahead of or behind the place by the slope.
            of = (place - sine * radius) / cosine2
            if rest >= 0.0 and 0.0 <= of <= length:
                found.append(root)
    for ball in ((start, radius), (stop, end_radius)):
        found += sphere_stretch(origin, unit, *ball) or ()
    return (min(found), max(found)) if found else None


def test_a_sphere():
    rng = np.random.default_rng(0)
    for _ in range(50):
        centre, radius = rng.normal(size=3), rng.random() + 0.1
        origin, unit = rng.normal(size=3) * 3, rng.normal(size=3)
        unit /= np.linalg.norm(unit)
        found = hits(np.tile([*centre, radius], (3, 1)), origin, 7.0 * unit)
        expected = sphere_stretch(origin, unit, centre, radius)
        if expected is None:
            assert found.kind[0] == MISS
            assert np.isnan([found.l[0], found.t[0]]).all()
        else:
            assert found.kind[0] == ENTRY
            assert found.l[0] == pytest.approx(expected[0], abs=1e-12)


@pytest.mark.parametrize("widening", [0.0, 0.3, -0.7, 0.999])
@pytest.mark.parametrize("rate", [0.5, 0.2])
def test_capsules_and_round_cones(widening, rate):
    rng = np.random.default_rng(1)
    n = 150
    starts, stops = rng.normal(size=(2, n, 3)) * 2.0
    lengths = np.linalg.norm(stops - starts, axis=1)
    radii = rng.random(n) + np.maximum(0.0, -widening) * lengths + 0.05
    halves = np.array(
        [straight(a, b, r, r + widening * m) for a, b, r, m in zip(starts, stops, radii, lengths, strict=True)]
    )
    # A middle control point off the middle runs through the same shape at another speed.
    halves[:, 1] = halves[:, 0] + rate * (halves[:, 2] - halves[:, 0])
    origins, directions = aimed(halves, rng)
    inside = [cone_stretch(origins[k], directions[k], starts[k], stops[k], radii[k], halves[k, 2, 3]) for k in range(n)]
    hit = np.array([s is not None for s in inside])
    assert 0.5 < hit.mean() < 1.0
    entry, leave = np.array([s or (np.nan, np.nan) for s in inside]).T
    found = hits(halves, origins, directions)
    np.testing.assert_array_equal(found.kind, np.where(hit, ENTRY, MISS))
    np.testing.assert_allclose(found.l, entry, atol=1e-10)
    assert attained(halves, origins, directions, found).max() < 1e-12

    middle = np.where(hit, 0.5 * (entry + leave), 0.0)
    behind = hits(halves, origins, directions, start=middle)
    np.testing.assert_array_equal(behind.kind[hit], EXIT)
    np.testing.assert_allclose(behind.l[hit], leave[hit], atol=1e-10)
    cut = hits(halves, origins, directions, start=middle, capped=True)
    np.testing.assert_array_equal(cut.kind[hit], CAP)
    np.testing.assert_array_equal(cut.l[hit], middle[hit])
    assert ((cut.t[hit] >= 0.0) & (cut.t[hit] <= 1.0)).all()


# ------------------------------------------------------------------------------------------------ dense sampling


def assert_as_sampled(half, origin, direction):
    """The entry is on the sphere it names, so not below the true one; and no sample lies below it, so not above."""
    found = hits(half, origin, direction)
    size = np.abs(half).max() + np.abs(origin).max()
    # Where a ray grazes a sphere the samples themselves are not exact: g is known to about 1e-15 size^2.
    sampled = stretches(half, origin, direction, 20_001, least=1e-10 * size**2)
    if sampled:
        assert found.kind[0] == ENTRY
        assert found.l[0] <= min(s[0] for s in sampled) + 1e-10 * size
    if found.kind[0]:
        assert attained(half[None], np.array([origin]), np.array([direction]), found).max() <= 1e-9 * size


def test_both_legs_of_a_parabola():
    half = np.array([[-2, 0, 0, 0.4], [0, 8, 0, 0.6], [2, 0, 0, 0.2]], float)
    origin, direction = np.array([-9.0, 1.0, 0.1]), np.array([1.0, 0.05, 0.0])
    first, second = stretches(half, origin, direction)
    between = 0.5 * (first[1] + second[0])
    cases = [
        (-np.inf, ENTRY, first[0]),
        (0.5 * sum(first), EXIT, first[1]),
        (between, ENTRY, second[0]),
        (0.5 * sum(second), EXIT, second[1]),
        (second[1] + 0.1, MISS, np.nan),
    ]
    for start, kind, place in cases:
        found = hits(half, origin, direction, start=start)
        assert found.kind[0] == kind
        np.testing.assert_allclose(found.l[0], place, atol=1e-6)
    capped = hits(half, origin, direction, start=[0.5 * sum(first), between], capped=True)
    np.testing.assert_array_equal(capped.kind, [CAP, ENTRY])
    # Nothing lies beyond the end: neither an entry nor an exit.
    limits = [first[0] - 0.1, first[0] + 0.1]
    np.testing.assert_array_equal(hits(half, origin, direction, end=limits).kind, [MISS, ENTRY])
    assert hits(half, origin, direction, start=0.5 * sum(first), end=first[1] - 0.01).kind[0] == MISS


def test_the_nearest_of_several_stretches_is_not_always_the_one_entered_first():
    """From inside the wide start a ray sees the narrow end, which lies within the same sphere, before the wall."""
    half = np.array([[0, 0, 0, 3], [6, 4, 0, 0.05], [0, 1, 0, 0.05]], float)
    origin, direction = np.array([-8.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])
    sampled = stretches(half, origin, direction)
    assert len(sampled) == 2
    wide, narrow = sorted(sampled)
    assert narrow[0] < wide[1]
    found = hits(half, origin, direction, start=[narrow[0] - 0.1, narrow[1] + 0.1])
    np.testing.assert_allclose(found.l, [narrow[0], wide[1]], atol=1e-6)
    np.testing.assert_array_equal(found.kind, [ENTRY, EXIT])


positions = hnp.arrays(np.float64, (3, 3), elements=st.floats(-10, 10))
radii = hnp.arrays(np.float64, 3, elements=st.floats(0, 4))
vectors = hnp.arrays(np.float64, 3, elements=st.floats(-1, 1)).filter(lambda v: np.abs(v).max() > 1e-3)


@given(positions, radii, st.floats(0, 1), hnp.arrays(np.float64, 3, elements=st.floats(-1, 1)), vectors)
@example(np.zeros((3, 3)), np.zeros(3), 0.0, np.zeros(3), np.array([1.0, 0, 0]))
@example(np.zeros((3, 3)), np.ones(3), 0.5, np.array([0, 1.0, 0]), np.array([1.0, 0, 0]))
def test_any_half_and_ray_as_sampled(places, radius, t, aside, direction):
    half = np.column_stack([places, radius])
    sphere = curve(half, t)
    unit = direction / np.linalg.norm(direction)
    assert_as_sampled(half, sphere[:3] + aside * sphere[3] - 30.0 * unit, direction)


@pytest.mark.parametrize("thickness", [1.0, 0.1, 0.01])
def test_many_halves_as_sampled(thickness):
    rng = np.random.default_rng(5)
    halves = rng.normal(size=(300, 3, 4))
    halves[:, :, 3] = thickness * np.abs(halves[:, :, 3])
    origins, directions = aimed(halves, rng)
    found = hits(halves, origins, directions)
    assert attained(halves, origins, directions, found).max() < 1e-11
    met = found.kind > 0
    places = origins[met] + found.l[met, None] * directions[met]
    assert np.abs(surface_distance(halves[met], places)).max() < 1e-11
    for k in range(300):
        sampled = stretches(halves[k], origins[k], directions[k], 8001)
        if sampled:
            assert found.l[k] <= min(s[0] for s in sampled) + 1e-12


# ------------------------------------------------------------------------------------------------------- extremes


DEGENERATE = {
    "all one sphere": np.array([[1, 2, 3, 0.5]] * 3),
    "one point": np.zeros((3, 4)),
    "no radius": np.array([[0, 0, 0, 0], [1, 1, 0, 0], [2, 0, 1, 0.0]]),
    "from no radius": np.array([[0, 0, 0, 0], [1, 1, 0, 0], [2, 0, 1, 1.0]]),
    "first two alike": np.array([[0, 0, 0, 0.3], [0, 0, 0, 0.3], [2, 0, 1, 0.4]]),
    "there and back": np.array([[0, 0, 0, 0.3], [2, 0, 0, 0.3], [0, 0, 0, 0.3]]),
    "a sphere that grows": np.array([[0, 0, 0, 0.1], [0, 0, 0, 0.5], [0, 0, 0, 2.0]]),
    "one sphere within the other": np.array([[0, 0, 0, 3.0], [0.5, 0, 0, 1.0], [1, 0, 0, 0.1]]),
    "denormal": np.full((3, 4), 5e-324) * [[0, 1, 2, 4], [1, 1, 3, 4], [5, 1, 0, 4]],
    "a needle": np.array([[0, 0, 0, 1e-6], [0.5, 0.1, 0, 1e-6], [1, 0, 0, 1e-6]]),
    "very wide": np.array([[0, 0, 0, 1e6], [0.5, 0.1, 0, 1e6], [1, 0, 0, 1e6]]),
}


@pytest.mark.few(6)
@pytest.mark.parametrize("name", DEGENERATE)
def test_degenerate_halves(name):
    half = DEGENERATE[name]
    rng = np.random.default_rng(6)
    halves = np.tile(half, (100, 1, 1))
    origins, directions = aimed(halves, rng)
    directions[:10] = np.eye(3)[0]  # along the axis of most
    origins[:10] = half[0, :3] - [9 * np.abs(half).max(), 0, 0] + origins[:10] * 0.0
    for start in (-np.inf, 0.0, 3.0 * np.abs(half).max()):
        for capped in (False, True):
            found = hits(halves, origins, directions, start=start, capped=capped)
            met = found.kind > 0
            assert np.isfinite(found.l[met]).all()
            assert np.isnan(found.l[~met]).all()
            assert ((found.t[met] >= 0.0) & (found.t[met] <= 1.0)).all()
    if half[:, 3].min() > 1e-300:  # samples of denormal spheres tell nothing
        for k in range(0, 100, 5):
            assert_as_sampled(half, origins[k], directions[k])


@pytest.mark.parametrize("scale", [1e-300, 1e-30, 1e-6, 1e6, 1e150])
def test_scale_changes_nothing(scale):
    rng = np.random.default_rng(7)
    halves = np.abs(rng.normal(size=(500, 3, 4)))
    origins, directions = aimed(halves, rng)
    found, scaled = hits(halves, origins, directions), hits(halves * scale, origins * scale, directions)
    np.testing.assert_array_equal(scaled.kind, found.kind)
    np.testing.assert_allclose(scaled.l / scale, found.l, rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize("slender", [1e3, 1e6])
def test_capsules_far_longer_than_thick(slender):
    """In the capsule's own measures: where a ray across meets it is known to a part of its radius."""
    rng = np.random.default_rng(9)
    n, radius = 400, 1.0 / slender
    half = straight([0, 0, 0], [1, 0, 0], radius, radius)
    aside = rng.uniform(-0.9, 0.9, n) * radius
    centre = rng.uniform(0.1, 0.9, n)
    unit = np.column_stack([rng.normal(size=n), np.zeros(n), np.ones(n)])
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    origins = np.column_stack([centre, aside, np.zeros(n)]) - 0.125 * unit
    found = hits(half, origins, unit)
    expected = 0.125 - np.sqrt(radius**2 - aside**2) / unit[:, 2]
    assert (found.kind == ENTRY).all()
    np.testing.assert_allclose((found.l - expected) / radius, 0.0, atol=1e-14 * slender)
    # Along it, and not quite: into the round end.
    tilted = np.array([[1.0, 0.3 * radius, 0.0]])
    along = hits(half, [[-1.0, -0.3 * radius, 0.2 * radius]], tilted)
    ends = cone_stretch(
        np.array([-1.0, -0.3 * radius, 0.2 * radius]), tilted[0] / np.linalg.norm(tilted[0]),
        np.zeros(3), np.array([1.0, 0, 0]), radius, radius,
    )  # fmt: skip
    assert along.l[0] == pytest.approx(ends[0], abs=1e-13)


# ------------------------------------------------------------------------------------------------ many halves, points


def test_nearest_of_many_is_the_least_of_each():
    rng = np.random.default_rng(10)
    halves = rng.normal(size=(80, 1, 4)) * [4, 4, 4, 0] + rng.normal(size=(80, 3, 4))
    halves[:, :, 3] = 0.3 * np.abs(halves[:, :, 3])
    halves = np.concatenate([halves, halves[:5]])  # the same again: the first counts
    origins = rng.normal(size=(120, 3)) * 10.0
    directions = -origins + rng.normal(size=(120, 3)) * 3.0
    start, end = rng.uniform(0, 12, 120), rng.uniform(8, 20, 120)
    for capped in (False, True):
        found = nearest_hits(halves, origins, directions, start=start, end=end, capped=capped)
        assert 20 < np.count_nonzero(found.kind) < 120
        for k in range(120):
            each = hits(halves, origins[k], directions[k], start=start[k], end=end[k], capped=capped)
            if not each.kind.any():
                assert (found.kind[k], found.half[k]) == (MISS, -1)
                continue
            best = np.nanmin(each.l)
            assert found.l[k] == pytest.approx(best, abs=1e-12)
            assert found.half[k] == np.flatnonzero(each.l <= best + 1e-12)[0]
            assert found.kind[k] == each.kind[found.half[k]]
            assert found.t[k] == pytest.approx(each.t[found.half[k]], abs=1e-9)


def test_without_halves_or_rays():
    none = nearest_hits(np.zeros((0, 3, 4)), np.zeros((2, 3)), [1, 0, 0])
    np.testing.assert_array_equal(none.half, [-1, -1])
    assert len(nearest_hits(np.zeros((2, 3, 4)), np.zeros((0, 3)), [1, 0, 0]).l) == 0
    assert len(hits(np.zeros((0, 3, 4)), np.zeros((0, 3)), np.zeros((0, 3))).l) == 0
    assert len(surface_distance(np.zeros((0, 3, 4)), np.zeros((0, 3)))) == 0


def test_surface_distance_as_sampled():
    rng = np.random.default_rng(11)
    halves = rng.normal(size=(200, 3, 4))
    halves[:, :, 3] = np.abs(halves[:, :, 3]) * np.repeat([1.0, 1e-3], 100)[:, None]
    points = rng.normal(size=(200, 3)) * np.repeat([2.0, 0.5], 100)[:, None]
    points[::7] = [curve(h, 0.3)[:3] for h in halves[::7]]  # on the axis
    found = surface_distance(halves, points)
    t = np.linspace(0.0, 1.0, 20_001)[:, None]
    for half, point, distance in zip(halves, points, found, strict=True):
        spheres = curve(half, t)
        sampled = (np.linalg.norm(point - spheres[:, :3], axis=1) - spheres[:, 3]).min()
        assert sampled - 1e-3 < distance <= sampled + 1e-12
    capsule = straight([0, 0, 0], [4, 0, 0], 1.0, 1.0)
    found = surface_distance(capsule, [[2, 3, 0], [2, 0.5, 0], [-2, 0, 0], [2, 0, 0]])
    np.testing.assert_allclose(found, [2, -0.5, 1, -1])


def test_surface_distance_by_a_thin_cusp():
    """Its roots lie so close together that they are told apart only from near."""
    half = np.array([[0, -1, 1, 0], [1, 2, -2, 1e-3], [1, 2, -2, 0.0]])
    found = hits(half, [1, -1, -2], [0, 3, 0])
    assert surface_distance(half, [1, found.l[0] - 1, -2])[0] == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"controls": np.zeros((2, 3, 3))}, r"controls have the shape \(2, 3, 3\), expected \(n, 3, 4\)"),
        ({"controls": np.full((1, 3, 4), np.nan)}, "controls 0 is .*expected finite numbers"),
        ({"controls": np.full((1, 3, 4), -1.0)}, r"controls 0 have the radii \[-1.0, .*expected 0 or more"),
        ({"origins": np.zeros(2)}, r"origins have the shape \(2,\), expected \(n, 3\)"),
        ({"origins": [[0, 0, np.inf]]}, "origins 0 is .*expected finite numbers"),
        ({"directions": [[1, 0, 0], [0, 0, 0]]}, "directions 1 is 0, expected a vector of any other length"),
        ({"start": np.nan}, "start is nan, expected one number of mm"),
        ({"end": np.zeros((2, 2))}, "(?s)end is .*expected one number of mm"),
    ],
)
def test_bad_input_is_named(change, message):
    good = {"controls": np.ones((1, 3, 4)), "origins": np.zeros(3), "directions": np.ones(3)}
    for ask in (hits, nearest_hits):
        with pytest.raises(ValueError, match=message):
            ask(**good | change)
