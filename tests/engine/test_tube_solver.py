"""The solver of spline tubes alone, on rays and halves at random and degenerate ones, against float64."""

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from pvfiblets.engine.tubes import SOLVERS
from pvfiblets.report.studies.tubes.rays import of_class
from pvfiblets.report.studies.tubes.reference import CAP, ENTRY, EXIT, Hits, hits, surface_distance
from pvfiblets.report.studies.tubes.solver_probe import SolverProbe
from pvfiblets.tubes.curves import sample_spheres

from .tubes import KINDS, grazing, halves, rays_past, unit

WAYS = [(solver, chain) for solver in SOLVERS for chain in (False, True) if chain or solver != "bisection"]
COUNT = 3000


@pytest.fixture(scope="module")
def sample():
    """Return of each kind halves, rays, the reference's answer and which rays graze."""
    found = {}

    def make(kind):
        if kind not in found:
            rng = np.random.default_rng(sorted(KINDS).index(kind))
            points = halves(rng, COUNT, **KINDS[kind])
            o, d = rays_past(rng, points)
            found[kind] = points, o, d, hits(points, o, d), grazing(points, o, d)
        return found[kind]

    return make


def probe(gl, solver, points, o, d, *, iterations=None, chain=False, hollow=False, **limits):
    asked = SolverProbe(gl, solver, iterations, chain=chain, hollow=hollow)
    try:
        return asked.hits(points, o, d, **limits)
    finally:
        asked.release()


def errors_of(points, o, d, found, expected):
    """Distance along the ray between two answers, and of the place from the tube's surface, over the largest radius."""
    place, _, kind = found
    both = np.flatnonzero((kind > 0) & (expected.kind > 0))
    largest = points[both, :, 3].max(axis=1)
    off = np.abs(surface_distance(points[both], o[both] + place[both, None] * d[both])) / largest
    return np.abs(place[both] - expected.l[both]) / largest, off


# Error along the ray over the radius, of half of all and of 99 in 100, and off the surface: twice what is measured.
BOUNDS = {
    "thin": (1e-5, 1e-4, 1e-5), "usual": (1e-5, 1e-4, 5e-6), "bent": (2e-5, 2e-4, 2e-5),
    "thick": (5e-7, 1e-5, 2e-6), "blob": (5e-7, 1e-5, 2e-6), "cone": (5e-6, 2e-4, 1e-5), "needle": (5e-5, 5e-4, 1e-4),
}  # fmt: skip


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("solver", "chain"), WAYS)
def test_rays_meet_halves_where_the_reference_says(gl, sample, solver, chain, kind):
    points, o, d, expected, graze = sample(kind)
    found = probe(gl, solver, points, o, d, chain=chain)
    wrong = ((found[2] > 0) != (expected.kind > 0)) & ~graze
    assert wrong.sum() == 0
    assert graze.sum() < 10
    assert ((found[2] == 0) | (found[2] == ENTRY)).all()
    along, off = errors_of(points, o, d, found, expected)
    assert len(along) > 0.6 * COUNT
    half, most, surface = BOUNDS[kind]
    assert np.quantile(along, 0.5) < half
    assert np.quantile(along, 0.99) < most
    assert np.quantile(off, 0.99) < surface
    # Rays that graze are met anywhere along where they do, but on the surface; and the one loop may take the farther
    # of two minima that lie between two of its stops.
    clear = np.minimum(along, off)
    if chain:
        assert clear.max() < 1e-3
    else:
        assert (clear > 1e-3).mean() < (1e-3 if kind in ("bent", "cone") else 1e-9)


@pytest.mark.parametrize(("solver", "chain"), WAYS)
def test_minima_beside_nodes_without_slopes_are_found(gl, solver, chain):
    """At such a node f' is 0, and f may fall from there, or rise towards there, with its minimum close by."""
    rays = of_class("flat-ended", 8192)
    found = probe(gl, solver, rays.controls, rays.origins, rays.directions, chain=chain)
    wrong = (found[2] > 0) != (rays.truth.kind > 0)
    assert (np.abs(rays.clearance[wrong]) < 1e-5).all()  # a silhouette
    along, off = errors_of(rays.controls, rays.origins, rays.directions, found, rays.truth)
    assert np.minimum(along, off).max() < 1e-3


@pytest.mark.parametrize(("solver", "chain"), WAYS)
def test_t_is_that_of_the_sphere_which_is_met(gl, sample, solver, chain):
    """The point that is met lies on the sphere at t, and nothing of the half on the ray is nearer."""
    points, o, d, expected, _ = sample("usual")
    place, t, kind = probe(gl, solver, points, o, d, chain=chain)
    met = np.flatnonzero(kind)
    weights = np.stack([(1 - t) ** 2, 2 * t * (1 - t), t**2], 1)[met]
    ball = np.einsum("nk,nkd->nd", weights, points[met])
    at = o[met] + place[met, None] * d[met]
    assert np.abs(np.linalg.norm(at - ball[:, :3], axis=1) / ball[:, 3] - 1).max() < 1e-3


def test_steps_of_bisection_halve_the_error(gl, sample):
    """The error along the ray is quadratic in that of t at a minimum: from n to n + 1 steps t's error halves."""
    points, o, d, expected, _ = sample("usual")
    inner = (expected.t > 0.02) & (expected.t < 0.98)
    medians = []
    for n in range(2, 11):
        place, t, kind = probe(gl, "bisection", points, o, d, iterations=n)
        both = inner & (kind > 0) & (expected.kind > 0)
        medians.append(np.median(np.abs(t - expected.t)[both]))
    ratios = np.array(medians[1:]) / np.array(medians[:-1])
    assert (ratios < 0.65).all()
    assert 0.45 < np.exp(np.log(ratios).mean()) < 0.55


@pytest.mark.every("value")
@pytest.mark.parametrize(("solver", "chain"), WAYS)
@pytest.mark.parametrize("iterations", [1, 2, 200])
def test_any_number_of_steps_is_allowed(gl, sample, solver, chain, iterations):
    points, o, d, expected, graze = (a[:500] if isinstance(a, np.ndarray) else a for a in sample("bent"))
    place, t, kind = probe(gl, solver, points, o, d, chain=chain, iterations=iterations)
    assert np.isfinite(place[kind > 0]).all()
    assert ((t >= 0) & (t <= 1)).all()
    if iterations == 200:
        assert (((kind > 0) != (expected.kind[:500] > 0)) & ~graze).sum() == 0


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("kind", ["usual", "bent", "thick", "cone"])
def test_rays_that_begin_inside_leave_where_the_reference_says(gl, sample, solver, kind):
    """Starts all along the stretch inside and around it: entries where one is ahead, else exits or cuts."""
    points, o, d, whole, graze = sample(kind)
    rng = np.random.default_rng(1)
    leave = hits(points, o, -d)
    inside = np.flatnonzero((whole.kind > 0) & (leave.kind > 0) & ~graze)
    points, o, d = points[inside], o[inside], d[inside]
    enter, leave = whole.l[inside], -leave.l[inside]
    start = enter + rng.uniform(-0.3, 1.3, len(inside)) * (leave - enter)
    gap = np.minimum(np.abs(start - enter), np.abs(start - leave)) / points[:, :, 3].max(axis=1)
    for capped, within in ((False, EXIT), (True, CAP)):
        expected = hits(points, o, d, start=start, capped=capped)
        place, _, got = probe(gl, solver, points, o, d, chain=True, hollow=True, start=start, capped=capped)
        wrong = (gap > 1e-4) & (got != expected.kind)
        assert wrong.mean() < 1e-3
        same = (got == expected.kind) & (got > 0)
        assert (got[same] == within).mean() > 0.3
        error = np.abs(place - expected.l)[same] / points[same, :, 3].max(axis=1)
        assert np.quantile(error, 0.99) < 5e-4
        assert (error > 2e-2).mean() < 1e-3


RARE = {
    "two roots of f'''": (
        [[0, 0, 0, 0.56386533], [-0.1598382, 0.47045471, -0.10475066, 0.060463501],
         [-0.41588641, 0.90853921, -0.039937526, 0.46529062]],
        [0.88783252, 5.4784392, -8.6534089], [-0.099692745, -0.49322792, 0.86416872],
    ),
    "three roots of f'''": (
        [[0, 0, 0, 0.53999923], [0.066080128, -0.19119571, -0.46654834, 0.016651728],
         [0.095674476, -0.045741495, -0.99436116, 0.49259195]],
        [1.2797924, -8.8876143, 3.8656131], [-0.13651259, 0.88547954, -0.44417373],
    ),
    "a sliver at the end": (
        [[0, 0, 0, 0.54432633], [0.20167911, -0.33254913, -0.40759859, 0.10698721],
         [0.43918512, -0.48334548, -0.75729358, 0.363973]],
        [5.8635884, -6.1577577, -6.5549012], [-0.56112456, 0.55220487, 0.6166109],
    ),
    "a sliver at the start": (
        [[0, 0, 0, 0.4444798], [0.25060566, -0.33511105, 0.22612694, 0.07273412],
         [0.20286107, -0.94080283, 0.27154636, 0.12547209]],
        [-5.4987363, 3.7116999, -6.675589], [0.57381232, -0.43725948, 0.69249084],
    ),
}  # fmt: skip
"""Half, origin and direction where a chain of derivatives breaks easily: a few in a hundred thousand."""


@pytest.mark.every("value")
@pytest.mark.parametrize("name", RARE)
@pytest.mark.parametrize("solver", SOLVERS)
def test_the_chain_misses_no_root(gl, solver, name):
    """More roots of f''' than the paper found, where the radius changes as fast as the place; hardly any of g."""
    points, o, d = (np.array([a]) for a in RARE[name])
    place, _, kind = probe(gl, solver, points, o, d, chain=True)
    assert kind[0] == ENTRY
    assert abs(place[0] - hits(points, o, d).l[0]) < 1e-4


# ------------------------------------------------------------------------------------- halves that are hardly any

LINE = [[-1.0, 0, 0], [0, 0, 0], [1, 0, 0]]
DEGENERATE = {
    "one place": ([[0, 0, 0]] * 3, [1, 1, 1]),
    "one place, radii": ([[0, 0, 0]] * 3, [0.5, 2, 1]),
    "returns": ([[0, 0, 0], [0, 2, 0], [0, 0, 0]], [0.3, 0.2, 0.3]),
    "cusp beyond": ([[0, 0, 0], [3, 0, 0], [1, 0, 0]], [0.2, 0.2, 0.2]),
    "hairpin": ([[-1, 0, 0], [30, 0.01, 0], [-1, 0.02, 0]], [0.2, 0.3, 0.2]),
    "opposite": ([[0, 0, 0], [-1, 0, 0], [1, 0, 0]], [0.2, 0.1, 0.2]),
    "a point at the start": (LINE, [0, 0.2, 0.4]),
    "a point at the end": (LINE, [0.4, 0.2, 0]),
    "a waist of nothing": (LINE, [0.5, 0, 0.5]),
    "nothing": (LINE, [0, 0, 0]),
    "radius outruns length": (LINE, [0.1, 3, 9]),
    "radius outruns length, bent": ([[0, 0, 0], [0.1, 0.2, 0], [0.3, 0.1, 0]], [2, 0.1, 5]),
    "a ball 1000 times its length": ([[0, 0, 0], [5e-4, 1e-4, 0], [1e-3, 0, 0]], [1, 1, 1]),
    "a ball a million times its length": ([[0, 0, 0], [5e-7, 1e-7, 0], [1e-6, 0, 0]], [1, 1, 1]),
    "tangents 100 times too long": ([[0, 0, 0], [100, 0, 0], [50, 50, 0]], [0.5, 0.5, 0.5]),
    "a thread": (LINE, [1e-3, 1e-3, 1e-3]),
    "denormal radii": (LINE, [1e-40, 2e-40, 1e-40]),
    "almost straight": ([[-1, 0, 0], [0, 1e-7, 0], [1, 0, 0]], [0.3, 0.3, 0.3]),
    "almost even radius": (LINE, [0.3, 0.3 + 1e-8, 0.3]),
    "a parabola of radius": (LINE, [0.5, -0.0, 0.5]),
}
"""Places and radii of control points."""


def rays_at(points, count=250, seed=0):
    """Rays past a half: random ones, along its chord and its coordinate axes, exactly and nearly."""
    rng = np.random.default_rng(seed)
    size = size_of(points)
    weights = rng.dirichlet((0.7, 0.7, 0.7), count)
    aims = weights @ points[:, :3] + rng.normal(0, 0.6, (count, 3)) * (weights @ points[:, 3])[:, None]
    d = unit(rng.normal(size=(count, 3)))
    axes = np.concatenate([np.eye(3), -np.eye(3), [[1, 1e-6, 0], [1, 0, 1e-20], [-1, 1e-12, 1e-12]]])
    d[: 8 * len(axes)] = unit(np.repeat(axes, 8, axis=0))
    aims[: 8 * len(axes) : 8] = 0.0  # through the very middle, and so 0 in many terms
    aims[1 : 8 * len(axes) : 8] = points[0, :3]
    return aims - 3 * size * d, d


def size_of(points):
    return np.abs(points[..., :3]).max(axis=(-1, -2)) + points[..., 3].max(axis=-1) + 1e-300


def judged(points, o, d):
    """Reference, and the rays whose hit hangs on 1e-4 of the radius, or on 1e-6 of the size this way or that.

    So does all about a ray that touches the sphere at an end, or that of a place between and no other near it, or goes
    through a place without radius: g is 0 there, and what else vanishes is up to the last bit.
    """
    size = size_of(points)[:, None]
    thick, thin, thicker = points.copy(), points.copy(), points.copy()
    thick[..., 3] *= 1 + 1e-4
    thin[..., 3] *= 1 - 1e-4
    thicker[..., 3] += 1e-6 * size
    aside = [o + 1e-6 * size * axis for axis in (*np.eye(3), -np.ones(3))]
    every = [points, thick, thin, thicker, *[points] * len(aside)]
    met = hits(np.concatenate(every), np.concatenate([o] * 4 + aside), np.tile(d, (len(every), 1)))
    met_all = met.kind.reshape(len(every), -1) > 0
    expected = Hits(*(a[: len(points)] for a in (met.l, met.t, met.kind)))
    vague = (met_all != met_all[0]).any(axis=0)
    balls = sample_spheres(points, 129)
    beside = np.linalg.norm(np.cross(balls[..., :3] - o[:, None], d[:, None]), axis=2)
    gap = (beside - balls[..., 3]) / size
    touched = np.abs(gap) < 1e-6
    touched[:, 1:-1] &= gap[:, :-2] * gap[:, 2:] > 0  # and not gone through
    vague |= touched.any(axis=1)
    vague |= (np.maximum(beside, balls[..., 3]) < 1e-4 * size).any(axis=1)
    return expected, vague


def compared(points, o, d, found, expected, vague, scale=1.0, *, surface=True):
    """Wrong covers, errors along the ray and distances from the surface over the size; never a number that is none."""
    place, t, kind = found
    met = kind > 0
    assert np.isfinite(place[met]).all()
    assert ((t >= 0) & (t <= 1)).all()
    size = np.broadcast_to(size_of(points), len(place))
    wrong = ((met != (expected.kind > 0)) & ~vague).sum()
    both = met & (expected.kind > 0) & ~vague
    along = np.abs(place - scale * expected.l)[both] / (scale * size[both])
    if not surface:
        return int(wrong), along, None
    met &= ~vague
    off = np.abs(surface_distance(points[met], o[met] + place[met, None] / scale * d[met])) / size[met]
    return int(wrong), along, off


@pytest.fixture(scope="module")
def table():
    """Return halves, rays, the reference's answers and names, one row for each ray."""
    rows = []
    for name, (places, radii) in DEGENERATE.items():
        half = np.column_stack([places, radii]).astype(float)
        o, d = rays_at(half)
        points = np.repeat(half[None], len(o), axis=0)
        rows.append((name, points, o, d, *judged(points, o, d)))
    return rows


@pytest.mark.few(2)
@pytest.mark.every("value")
@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e6])
@pytest.mark.parametrize(("solver", "chain"), WAYS)
def test_degenerate_halves(gl, table, solver, chain, scale):
    """All of the table in one go, at three scales: the size of things is none of the solver's business."""
    points, o, d = (np.concatenate([row[k] for row in table]) for k in (1, 2, 3))
    found = probe(gl, solver, points * scale, o * scale, d, chain=chain)
    first = 0
    for name, half, origins, directions, expected, vague in table:
        part = slice(first, first + len(half))
        first += len(half)
        got = [a[part] for a in found]
        wrong, along, off = compared(half, origins, directions, got, expected, vague, scale)
        assert wrong <= (0 if chain else 2), name
        if name not in ("nothing", "denormal radii"):
            assert vague.mean() < 0.15, name
            assert len(along) > 40, name
            assert np.quantile(along, 0.9) < 5e-6, name
            missed = 0 if chain else 0.04 if name == "opposite" else 0.01
            assert (along > 1e-3).mean() <= missed, name
            assert (off > 1e-3).mean() <= missed, name


def no_tiny(number):
    """0 for what is lost in float32 beside anything else; some such are in the lists."""
    return number if abs(number) > 1e-30 else 0.0


NUMBERS = st.one_of(st.sampled_from([0.0, 1.0, -1.0, 0.5, 1e-20, -1e-20, 1e-7, 1e-38]), st.floats(-1, 1).map(no_tiny))
RADII = st.one_of(st.sampled_from([0.0, 1e-20, 1e-6, 1.0, 100.0]), st.floats(0, 3).map(no_tiny))


@hypothesis.given(
    st.lists(st.tuples(NUMBERS, NUMBERS, NUMBERS, RADII), min_size=3, max_size=3), st.integers(0, 99),
    st.sampled_from([1.0, 1e-6, 1e6]),
)  # fmt: skip
@hypothesis.settings(suppress_health_check=[hypothesis.HealthCheck.function_scoped_fixture])
def test_any_half(probes, half, seed, scale):
    """Whatever the control points are; what they come to at a pixel's size is for the picture to say."""
    half = np.array(half)
    hypothesis.assume(size_of(half) > 1e-3)  # scales are tried by the factor
    o, d = rays_at(half, count=90, seed=seed)
    points = np.repeat(half[None], len(o), axis=0)
    expected, vague = judged(points, o, d)
    for (_, chain), asked in probes.items():
        found = asked.hits(points * scale, o * scale, d)
        wrong, along, _ = compared(points, o, d, found, expected, vague, scale, surface=False)
        if half[:, 3].max() > 1e-3 * size_of(half):  # thinner, and float32 is what is seen
            few = 1 if chain else 4
            assert wrong <= few
            assert (along > 2e-3).sum() <= few


@pytest.fixture
def probes(gl):
    """Return a probe of every kind, for as many questions as one likes."""
    found = {(solver, chain): SolverProbe(gl, solver, chain=chain) for solver, chain in WAYS}
    yield found
    for asked in found.values():
        asked.release()


def test_a_solver_is_given_other_steps_released_twice_and_refuses_bad_choices(gl, sample):
    points, o, d, *_ = sample("usual")
    asked = SolverProbe(gl, "bisection", clock=iter(range(9)).__next__)
    for iterations in (2, 9):
        asked.limit(iterations)
        found = asked.hits(points, o, d)
        for got, wanted in zip(found, probe(gl, "bisection", points, o, d, iterations=iterations), strict=True):
            np.testing.assert_array_equal(got, wanted)
    assert asked.seconds == 1.0  # by the clock that was given
    with pytest.raises(ValueError, match="iterations is 0"):
        asked.limit(0)
    asked.release()
    asked = SolverProbe(gl, "itp")
    asked.release()
    asked.release()
    with pytest.raises(ValueError, match=r"solver is 'secant'; use one of .*illinois"):
        SolverProbe(gl, "secant")
    with pytest.raises(ValueError, match="iterations is 0; give a whole number above 0"):
        SolverProbe(gl, "itp", 0)
