"""Shapes and expressions: against closed forms and NumPy's own boolean algebra."""

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvfiblets import regions
from pvfiblets.query.regions.region import AND, MAX_STACK, NOT, OR

RNG = np.random.default_rng(7)
POINTS = RNG.uniform(-3.0, 3.0, (4000, 3))


def rotation(seed=1):
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return turn * np.sign(np.linalg.det(turn))


def placement(linear, shift):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = linear, shift
    return matrix


def place(matrix, points):
    return points @ matrix[:3, :3].T + matrix[:3, 3]


SHEAR = placement(np.array([[2.0, 0.7, 0.0], [0.0, 1.0, -0.4], [0.3, 0.0, 0.5]]), (1.0, -2.0, 0.5))

SHAPES = {
    "plane": regions.Plane((1.0, 2.0, -0.5), (0.3, 0.2, 0.1)),
    "slab": regions.Slab((0.2, 0.0, 3.0), (0.0, 0.1, 0.4), 1.3),
    "box": regions.Box((-1.0, 2.0, -0.5, 0.7, -2.0, 0.1)),
    "turned box": regions.Box(center=(0.4, 0.1, -0.2), size=(1.0, 2.0, 3.0), rotation=rotation()),
    "sphere": regions.Sphere((0.5, -0.5, 0.25), 1.75),
    "sheared box": regions.Box((-1.0, 1.0, -1.0, 1.0, -1.0, 1.0)).moved(SHEAR),
    "ellipsoid": regions.Sphere((0.0, 0.0, 0.0), 1.0).moved(SHEAR),
}


def test_plane_slab_box_and_sphere_hold_what_their_definitions_say():
    n = np.array([1.0, 2.0, -0.5])
    assert (SHAPES["plane"].contains(POINTS) == ((POINTS - (0.3, 0.2, 0.1)) @ n >= 0)).all()
    n = np.array([0.2, 0.0, 3.0]) / np.hypot(0.2, 3.0)
    assert (SHAPES["slab"].contains(POINTS) == (np.abs((POINTS - (0.0, 0.1, 0.4)) @ n) <= 0.65)).all()
    low, high = np.array([-1.0, -0.5, -2.0]), np.array([2.0, 0.7, 0.1])
    assert (SHAPES["box"].contains(POINTS) == ((low <= POINTS) & (high >= POINTS)).all(axis=1)).all()
    own = (POINTS - (0.4, 0.1, -0.2)) @ rotation()
    assert (SHAPES["turned box"].contains(POINTS) == (np.abs(own) <= (0.5, 1.0, 1.5)).all(axis=1)).all()
    far = np.linalg.norm(POINTS - (0.5, -0.5, 0.25), axis=1)
    assert (SHAPES["sphere"].contains(POINTS) == (far <= 1.75)).all()


@given(st.tuples(*[st.floats(-1e6, 1e6)] * 3), st.tuples(*[st.floats(1e-6, 1e6)] * 3))
def test_a_box_holds_its_own_corners(low, size):
    low = np.array(low)
    high = low + size
    box = regions.Box(np.stack([low, high], axis=1).ravel())
    corners = np.where(list(np.ndindex(2, 2, 2)), high, low)
    assert box.contains(corners).all()
    beyond = np.spacing(np.abs(low) + np.abs(high)) * 4
    assert not box.contains(np.where(list(np.ndindex(2, 2, 2)), high + beyond, low - beyond)).any()


@pytest.mark.parametrize("offset", [0.0, 1e6])
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_extreme_places_and_sizes(offset, size):
    centre = np.array([offset, -offset, offset])
    resolution = float(np.spacing(offset)) * 8
    sphere, box = regions.Sphere(centre, size), regions.Box(center=centre, size=2 * size)
    towards = RNG.normal(size=(500, 3))
    towards /= np.linalg.norm(towards, axis=1)[:, None]
    assert sphere.contains(centre + towards * (size * 0.999 - resolution)).all()
    assert not sphere.contains(centre + towards * (size * 1.001 + resolution)).any()
    towards /= np.abs(towards).max(axis=1)[:, None]
    assert box.contains(centre + towards * (size * 0.999 - resolution)).all()
    assert not box.contains(centre + towards * (size * 1.001 + resolution)).any()


def test_what_is_not_finite_is_nowhere():
    bad = np.array([[np.nan, 0, 0], [0, np.inf, 0], [0, 0, -np.inf], [np.nan] * 3])
    for shape in SHAPES.values():
        assert not shape.contains(bad).any()
        assert not (~shape).contains(bad).any()
        assert np.isnan(shape.distance(bad)).all()
        assert (regions.classify(shape, bad, 1.0) == 0).all()
    assert not SHAPES["box"].contains(np.array([[1e308, 1e308, -1e308]])).any()
    assert SHAPES["box"].contains(np.zeros((0, 3))).shape == (0,)
    assert SHAPES["box"].contains((0.0, 0.0, 0.0)).tolist() == [True]
    with pytest.raises(ValueError, match=r"shape \(4, 2\); give \(n, 3\)"):
        SHAPES["box"].contains(np.zeros((4, 2)))


@st.composite
def expressions(draw, depth=4):
    """A region, and the same as a function of a table of flags."""
    if depth == 0 or draw(st.booleans()):
        name = draw(st.sampled_from(list(SHAPES)))
        return SHAPES[name], lambda flags: flags[name]
    a, of_a = draw(expressions(depth - 1))
    what = draw(st.sampled_from("&|-~"))
    if what == "~":
        return ~a, lambda flags: ~of_a(flags)
    b, of_b = draw(expressions(depth - 1))
    if what == "&":
        return a & b, lambda flags: of_a(flags) & of_b(flags)
    if what == "|":
        return a | b, lambda flags: of_a(flags) | of_b(flags)
    return a - b, lambda flags: of_a(flags) & ~of_b(flags)


@given(expressions())
def test_expressions_follow_boolean_algebra(case):
    region, expected = case
    flags = {name: shape.contains(POINTS) for name, shape in SHAPES.items()}
    assert (region.contains(POINTS) == expected(flags)).all()
    assert len(set(region.leaves)) == len(region.leaves)
    low, high = region.bounds.reshape(3, 2).T
    held = POINTS[region.contains(POINTS)]
    assert not len(held) or ((held >= low - 1e-12) & (held <= high + 1e-12)).all()


@given(expressions(), st.integers(0, 1000))
def test_what_is_said_of_a_ball_holds_for_all_of_it(case, seed):
    region, _ = case
    rng = np.random.default_rng(seed)
    centres = rng.uniform(-3, 3, (300, 3))
    radii = rng.exponential(0.4, 300) * (rng.random(300) > 0.1)
    sides = regions.classify(region, centres, radii)
    towards = rng.normal(size=(300, 20, 3))
    towards /= np.linalg.norm(towards, axis=2)[..., None]
    towards *= rng.choice([0.0, 0.5, 1.0], (300, 20, 1))
    within = region.contains((centres[:, None] + radii[:, None, None] * towards).reshape(-1, 3)).reshape(300, 20)
    assert within[sides > 0].all()
    assert not within[sides < 0].any()


@pytest.mark.parametrize("offset", [0.0, 1e6])
@pytest.mark.parametrize("size", [1e-6, 1.0])
def test_balls_far_away_and_tiny_are_never_misjudged(offset, size):
    centre = np.array([offset, -offset, 0.5 * offset])
    shapes = [regions.Sphere(centre, size), regions.Box(center=centre, size=size, rotation=rotation()),
              regions.Plane((1, 1, 1), centre), regions.Slab((1, -1, 1), centre, size)]  # fmt: skip
    points = centre + RNG.normal(size=(3000, 3)) * size
    for shape in shapes:
        sides, held = regions.classify(shape, points, 0.0), shape.contains(points)
        assert held[sides > 0].all()
        assert not held[sides < 0].any()
        if offset == 0.0:
            assert (sides != 0).all(), "single positions are undecided only where rounding decides"


def test_balls_are_settled_wherever_they_can_be():
    centres, radii = RNG.uniform(-4, 4, (5000, 3)), RNG.exponential(0.5, 5000)
    far = np.linalg.norm(centres - (0.5, -0.5, 0.25), axis=1) - 1.75
    assert (regions.classify(SHAPES["sphere"], centres, radii) == np.select([far < -radii, far > radii], [1, -1])).all()
    box = SHAPES["box"]
    apart = box.distance(centres)
    inner = np.minimum(centres - box.bounds[::2], box.bounds[1::2] - centres).min(axis=1)
    sides = regions.classify(box, centres, radii)
    assert ((sides == 1) == (inner > radii)).all()
    # Past corners the box counts as stretched to a cube's: most that miss it are known to.
    assert (sides == -1).sum() > 0.9 * (apart > radii).sum()
    with pytest.raises(ValueError, match="a radius is -1"):
        regions.classify(box, centres[:1], -1.0)
    with pytest.raises(ValueError, match="radii have shape"):
        regions.classify(box, centres, [1.0, 2.0])


def test_moving_a_region_moves_what_it_holds():
    region = (SHAPES["box"] | SHAPES["sphere"]) - SHAPES["plane"] & ~SHAPES["slab"]
    for matrix in (SHEAR, placement(np.diag([1.0, -1.0, 2.0]), (5.0, 0.0, 0.0)), placement(rotation(), (1e6, 0, 0))):
        moved = region.moved(matrix)
        settled = regions.classify(region, POINTS, 1e-8) != 0
        assert (moved.contains(place(matrix, POINTS)) == region.contains(POINTS))[settled].all()
    back = region.moved(SHEAR).moved(np.linalg.inv(SHEAR))
    assert (back.contains(POINTS) == region.contains(POINTS))[regions.classify(region, POINTS, 1e-8) != 0].all()
    leaf = SHAPES["box"]
    assert (leaf.matrix @ [2.0, 0.7, 0.1, 1.0]) == pytest.approx([1.0, 1.0, 1.0, 1.0])


def test_distances_of_simple_shapes():
    n = np.array([1.0, 2.0, -0.5])
    height = (POINTS - (0.3, 0.2, 0.1)) @ (n / np.linalg.norm(n))
    assert SHAPES["plane"].distance(POINTS) == pytest.approx(np.maximum(-height, 0.0), abs=1e-14)
    n = np.array([0.2, 0.0, 3.0]) / np.hypot(0.2, 3.0)
    height = np.abs((POINTS - (0.0, 0.1, 0.4)) @ n) - 0.65
    assert SHAPES["slab"].distance(POINTS) == pytest.approx(np.maximum(height, 0.0), abs=1e-14)
    box = SHAPES["box"].bounds
    apart = np.linalg.norm(np.maximum(0.0, np.maximum(box[::2] - POINTS, POINTS - box[1::2])), axis=1)
    assert SHAPES["box"].distance(POINTS) == pytest.approx(apart, abs=1e-13)
    away = np.maximum(np.linalg.norm(POINTS - (0.5, -0.5, 0.25), axis=1) - 1.75, 0.0)
    assert SHAPES["sphere"].distance(POINTS) == pytest.approx(away, abs=1e-13)
    either = SHAPES["sphere"] | SHAPES["box"]
    assert either.distance(POINTS) == pytest.approx(np.minimum(away, apart), abs=1e-13)
    for region in (~SHAPES["box"], SHAPES["box"] & SHAPES["sphere"], SHAPES["box"] - SHAPES["sphere"]):
        with pytest.raises(NotImplementedError, match="no distance from a region made with"):
            region.distance(POINTS)


@pytest.mark.more
@pytest.mark.parametrize("name", ["ellipsoid", "sheared box"])
def test_distances_of_stretched_shapes(name):
    """The nearest point by projected gradients in the solid's own frame, started from the nearest of many samples."""
    shape = SHAPES[name]
    points = POINTS[:150] * 2.0
    found = shape.distance(points)
    unit = np.random.default_rng(3).uniform(-1, 1, (200_000, 3))
    if name == "ellipsoid":
        unit /= np.maximum(np.linalg.norm(unit, axis=1), 1.0)[:, None]
    solid = place(SHEAR, unit)
    for point, distance in zip(points, found, strict=True):
        # Projected gradient descent towards the point: convex, so that it ends at the nearest one.
        best = unit[np.linalg.norm(solid - point, axis=1).argmin()]
        for _ in range(3000):
            best = best - 0.2 * SHEAR[:3, :3].T @ (place(SHEAR, best) - point)
            best = best / max(np.linalg.norm(best), 1.0) if name == "ellipsoid" else np.clip(best, -1.0, 1.0)
        assert distance == pytest.approx(np.linalg.norm(place(SHEAR, best) - point), abs=1e-7)
    assert (found == 0)[shape.contains(points)].all()


def test_distances_of_ellipsoids_on_their_axes():
    ellipsoid = regions.Sphere((0.0, 0.0, 0.0), 1.0).moved(np.diag([1e3, 1.0, 1e-3, 1.0]))
    places = np.array([[2e3, 0, 0], [0, 3, 0], [0, 0, 5], [0, 0, -5], [0, 0, 0]], float)
    assert ellipsoid.distance(places) == pytest.approx([1e3, 2.0, 4.999, 4.999, 0.0], rel=1e-9)


def test_equal_content_is_equal_and_counts_once():
    a, b = regions.Sphere((1, 2, 3), 4), regions.Sphere((1.0, 2.0, 3.0), 4.0)
    assert a == b
    assert hash(a) == hash(b)
    assert regions.Plane((0, 0, 1), (0, 0, -0.0)) == regions.Plane((0, 0, 2), (0, 0, 0.0))
    assert a != regions.Sphere((1, 2, 3), 5)
    assert (a & ~b).leaves == (a,)
    assert (a | SHAPES["box"]) == (b | SHAPES["box"])
    assert ~~a == a
    assert (a - SHAPES["box"]).program == (0, 1, NOT, AND)
    assert pickle.loads(pickle.dumps(a - SHAPES["box"])) == a - SHAPES["box"]
    assert len({a, b, a | b}) == 2
    with pytest.raises(TypeError, match="combine regions with &"):
        bool(a)
    with pytest.raises(TypeError):
        a & 3


def test_stacks_stay_low_and_sizes_are_limited():
    spheres = [regions.Sphere((i, 0, 0), 1) for i in range(33)]
    right = spheres[31]
    for sphere in spheres[30::-1]:
        right = sphere | right
    depth = deepest = 0
    for op in right.program:
        depth += 1 if op >= 0 else -1 if op in (AND, OR) else 0
        deepest = max(deepest, depth)
    assert deepest == 2 <= MAX_STACK
    assert right.contains(np.array([[31.5, 0, 0], [33.5, 0, 0]])).tolist() == [True, False]
    with pytest.raises(ValueError, match=r"33 shapes and 65 operations is more than 32 and 64"):
        right | spheres[32]
    many = spheres[0]
    for _ in range(3):
        many = many & ~(spheres[1] | many)
    with pytest.raises(ValueError, match="2 shapes and 73 operations is more than 32 and 64"):
        many & many


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: regions.Plane((0, 0, 0)), "normal is .*; give a direction that is not 0"),
        (lambda: regions.Plane((0, np.nan, 1)), "normal is .*; give 3 finite numbers"),
        (lambda: regions.Plane((0, 0, 1), (0, np.inf, 0)), "origin is .*; give 3 finite numbers"),
        (lambda: regions.Plane((0, 1)), "normal is .*; give 3 finite numbers"),
        (lambda: regions.Slab((0, 0, 1), (0, 0, 0), 0.0), "thickness is 0.0; give a finite number of mm above 0"),
        (lambda: regions.Sphere((0, 0, 0), -1.0), "radius is -1.0; give"),
        (lambda: regions.Sphere((0, 0, 0), np.inf), "radius is inf; give"),
        (lambda: regions.Sphere((0, 0, np.nan), 1.0), "center is .*; give 3 finite numbers"),
        (lambda: regions.Box((1, 0, 0, 1, 0, 1)), "bounds are .*; give xmin < xmax"),
        (lambda: regions.Box((0, 1, 0, 1, 2, 2)), "bounds are .*; give xmin < xmax"),
        (lambda: regions.Box((0, 1, 0, 1)), "bounds is .*; give 6 finite numbers"),
        (lambda: regions.Box(), "a box needs bounds="),
        (lambda: regions.Box((0, 1, 0, 1, 0, 1), size=1), "leave one out"),
        (lambda: regions.Box(center=(0, 0, 0), size=(1, 0, 1)), "size is 0.0; give"),
        (lambda: regions.Box(center=(0, 0, 0), size=(1, 1)), "size is .*; give one number of mm, or three"),
        (lambda: regions.Box(center=(0, 0, 0), size=1, rotation=np.ones((3, 3))), "rotation is .*; give an orthogonal"),
        (lambda: SHAPES["box"].moved(np.diag([1.0, 0.0, 1.0, 1.0])), "flattens space; give one that can be inverted"),
        (lambda: SHAPES["box"].moved(np.eye(3)), r"finite \(4, 4\) matrix"),
        (lambda: SHAPES["box"].moved(np.full((4, 4), np.nan)), r"finite \(4, 4\) matrix"),
    ],
)
def test_bad_input_is_named(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_bounds():
    assert SHAPES["plane"].bounds.tolist() == [-np.inf, np.inf] * 3
    assert regions.Plane((0, 0, -2), (1, 2, 3)).bounds.tolist() == [-np.inf, np.inf, -np.inf, np.inf, -np.inf, 3.0]
    assert (~regions.Plane((0, 0, -2), (1, 2, 3))).bounds.tolist()[4:] == [3.0, np.inf]
    assert regions.Slab((0, 1, 0), (1, 2, 3), 1).bounds.tolist()[2:4] == [1.5, 2.5]
    assert (SHAPES["box"] & SHAPES["sphere"]).bounds == pytest.approx([-1, 2, -0.5, 0.7, -1.5, 0.1])
    apart = regions.Sphere((0, 0, 0), 1) & regions.Sphere((9, 0, 0), 1)
    assert apart.bounds.tolist() == [1, -1, 1, -1, 1, -1]
    assert (apart | SHAPES["box"]).bounds == pytest.approx(SHAPES["box"].bounds)
    corners = place(SHEAR, np.array(list(np.ndindex(2, 2, 2))) * 2.0 - 1.0)
    assert SHAPES["sheared box"].bounds == pytest.approx(
        np.stack([corners.min(axis=0), corners.max(axis=0)], axis=1).ravel()
    )
