"""Pictures of spline tubes against float64: every pixel's ray, met with every half."""

import numpy as np
import pytest

from pvfiblets.engine import View
from pvfiblets.engine.tubes import SILHOUETTES, SOLVERS
from pvfiblets.report.studies.tubes.reference import CAP, EXIT
from pvfiblets.tubes import NodeValues, SplineTubes
from pvfiblets.tubes.curves import controls, evaluate

from .line_tubes import rays
from .pictures import near
from .tubes import (
    EYE,
    assert_all_show,
    assert_shows,
    bundle,
    degrees,
    distances,
    draw_splines,
    moved,
    seen,
    tube_through,
    winding,
)  # fmt: skip

SIZE = (160, 120)


def hermite_halves(values, slopes, tubes, expected, t):
    """What an attribute is at each pixel: the same two quadratics as of positions, written out once more."""
    i, j = tubes.segments[np.maximum(expected.owner, 0)].transpose(2, 0, 1)
    chord = np.linalg.norm(tubes.points[j] - tubes.points[i], axis=-1) if tubes.scaled else 1.0
    shape = (..., *([None] * (values.ndim - 1)))
    chord = np.asarray(chord)[shape] if tubes.scaled else 1.0
    a, b = values[i] + 0.25 * chord * slopes[i], values[j] - 0.25 * chord * slopes[j]
    middle, u = 0.5 * (a + b), t[shape]
    second = (expected.half % 2 == 1)[shape]
    p = np.where(second, middle, values[i]), np.where(second, b, a), np.where(second, values[j], middle)
    return p[0] * (1 - u) ** 2 + 2 * u * (1 - u) * p[1] + u * u * p[2]


# --------------------------------------------------------------------------------------------------- one set, views


@pytest.fixture(scope="module")
def tubes():
    return bundle()


@pytest.fixture(scope="module")
def view(camera):
    return View(SIZE, camera(SIZE, **EYE))


@pytest.fixture(scope="module")
def expected(tubes, view):
    return seen(tubes, view)


@pytest.mark.few(2)
@pytest.mark.parametrize("solver", SOLVERS)
def test_every_pixel_shows_what_its_ray_meets(gl, tubes, view, expected, solver):
    for silhouettes in SILHOUETTES:
        picture = draw_splines(gl, tubes, view, silhouettes=silhouettes, solver=solver, min_width=0.0)
        assert_shows(picture, tubes, view, expected=expected, least=1500)


def test_silhouettes_are_the_reference_s_to_a_sliver(gl, tubes, view, expected):
    """Tubes 0.2 % thinner lie within the picture, and the picture within tubes 0.2 % thicker."""
    picture = draw_splines(gl, tubes, view, min_width=0.0)
    assert not (seen(tubes, view, grow=0.998).drawn & ~picture.drawn).any()
    assert not (picture.drawn & ~seen(tubes, view, grow=1.002).drawn).any()


def test_the_paper_s_middle(gl, tubes, view, expected):
    """A third of the derivatives is another curve; what is shown follows it."""
    picture = draw_splines(gl, tubes, view, min_width=0.0, middle=1 / 3)
    shown = assert_shows(picture, tubes, view, middle=1 / 3)
    assert (np.abs(shown.z - expected.z) > 1e-5).sum() > 0.2 * shown.drawn.sum()


@pytest.mark.parametrize("name", ["number", "colour"])
@pytest.mark.parametrize("scaled", [False, True])
def test_attributes_are_interpolated_as_places_are(gl, tubes, view, expected, name, scaled):
    if scaled:  # the same derivatives, by length at each node's chord: another curve, hence another reference
        chord = np.linalg.norm(np.diff(tubes.points.reshape(6, 6, 3), axis=1), axis=-1).mean()
        kept = {key: NodeValues(v.values, v.slopes / chord) for key, v in tubes.values.items()}
        tubes = SplineTubes(
            tubes.points, tubes.segments, tubes.radius, tubes.tangents / chord, tubes.radius_slopes / chord, True,
            tubes.tubes, tubes.n_tubes, kept,
        )  # fmt: skip
        expected = seen(tubes, view)
    picture = draw_splines(gl, tubes, view, name, min_width=0.0)
    assert_shows(picture, tubes, view, expected=expected, least=1500)
    attribute = tubes.values[name]
    same = picture.drawn & (picture.owner == expected.owner) & (np.abs(expected.facing) > 0.1)
    wanted = hermite_halves(attribute.values, attribute.slopes, tubes, expected, expected.t)
    if name == "number":
        assert picture.colour is None
        off = np.abs(picture.value - wanted)[same]
        assert np.median(off) < 1e-4
        assert np.quantile(off, 0.995) < 0.02
    else:
        off = np.abs(picture.colour - np.clip(wanted, 0, 1))[same]
        assert np.median(off) < 0.5 / 255
        assert np.quantile(off, 0.995) < 3 / 255


def oblique(matrix):
    """The same view through a window beside the axis, and sheared."""
    shift = np.eye(4)
    shift[0, 3], shift[1, 3] = 0.4, -0.3
    shift[0, 1] = 0.2
    return shift @ matrix


USER = {
    "mirrored": np.diag([-1.0, 1, 1, 1]),
    "scaled": np.diag([0.7, 0.7, 0.7, 1]),
    "turned and moved": np.array([[0.6, -0.8, 0, 2], [0.8, 0.6, 0, -1], [0, 0, 1, 3], [0, 0, 0, 1.0]]),
    "stretched": np.diag([1.3, 0.8, 0.5, 1]),
}


@pytest.mark.few(2)
@pytest.mark.parametrize("name", ["parallel", "oblique", "oblique parallel", *USER])
def test_any_matrix(gl, camera, tubes, name):
    matrix = camera(SIZE, **EYE, **({"height": 46.0} if "parallel" in name else {}))
    matrix = oblique(matrix) if "oblique" in name else matrix @ USER.get(name, np.eye(4))
    view = View(SIZE, matrix)
    assert_all_show(gl, tubes, view, least=500)


def same_pictures(a, b, *, some=0.002, depth=1e-5):
    count = a.drawn.sum()
    assert count > 500
    assert (a.drawn != b.drawn).sum() <= some * count
    both = a.drawn & b.drawn
    assert (a.owner != b.owner)[both].sum() <= 2 * some * count
    assert (np.abs(a.z - b.z) > depth)[both].sum() <= some * count
    assert (degrees(a.normal, b.normal) > 1.0)[both].sum() <= 2 * some * count


@pytest.mark.parametrize("offset", [1e6, -3e6])
def test_far_from_the_origin_the_picture_is_the_same(gl, tubes, view, offset):
    """Two millimetres of tube at a thousand kilometres: float32 alone would place them to a tenth."""
    away = np.eye(4)
    away[:3, 3] = offset, -0.7 * offset, 0.3 * offset
    far_view = View(SIZE, view.model_view_projection @ np.linalg.inv(away))
    found = draw_splines(gl, moved(tubes, away), far_view, min_width=0.0)
    same_pictures(draw_splines(gl, tubes, view, min_width=0.0), found)


@pytest.mark.parametrize("scale", [1e-5, 1e5])
def test_any_scale_gives_the_same_picture(gl, tubes, view, scale):
    change = np.diag([scale, scale, scale, 1])
    other = View(SIZE, view.model_view_projection @ np.linalg.inv(change))
    found = draw_splines(gl, moved(tubes, change), other, min_width=0.0)
    same_pictures(draw_splines(gl, tubes, view, min_width=0.0), found)


@pytest.mark.parametrize("parallel", [False, True])
def test_silhouettes_give_one_picture(gl, camera, tubes, parallel):
    view = View(SIZE, camera(SIZE, **EYE, **({"height": 46.0} if parallel else {})))
    first, *others = [draw_splines(gl, tubes, view, silhouettes=name) for name in SILHOUETTES]
    for other in others:
        same_pictures(first, other, some=0.0005, depth=1e-6)


# ------------------------------------------------------------------------------------------ cut by planes of the view


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize(("near_plane", "far_plane"), [(57.0, 120.0), (20.0, 62.0), (60.0, 66.0)])
def test_near_and_far_plane_cut_tubes(gl, camera, tubes, near_plane, far_plane, parallel):
    """Where the near plane opens a tube its inner wall shows; beyond the far plane there is nothing."""
    more = {**EYE, "near": near_plane, "far": far_plane, **({"height": 46.0} if parallel else {})}
    view = View((72, 54), camera((72, 54), **more))
    shown, _ = assert_all_show(gl, tubes, view, inside=near_plane > 30, wrong=0.006, least=150)
    if near_plane > 30:
        assert (shown.kind == EXIT).sum() > 20


@pytest.mark.more
def test_from_inside_of_a_tube(gl, camera):
    """Nodes and halves go on into each other: of their spheres no wall is seen."""
    tube = winding()
    eye = tube.points[3] + [0.2, 0.3, 0.2]
    size = (64, 48)
    view = View(size, camera(size, eye=eye, target=tube.points[6], near=0.05, far=100.0, angle=75))
    shown = seen(tube, view, inside=True)
    for silhouettes, solver in (*((name, "auto") for name in SILHOUETTES), *(("auto", name) for name in SOLVERS)):
        picture = draw_splines(gl, tube, view, silhouettes=silhouettes, solver=solver)
        assert_shows(picture, tube, view, expected=shown, wrong=0.01, least=2500)
    assert (shown.kind == EXIT).mean() > 0.5


@pytest.mark.few(1)
@pytest.mark.parametrize("solver", ["auto", "newton"])
def test_tubes_around_the_eye_and_behind_it(gl, camera, solver):
    """The eye is in the boxes of some segments but in no tube; some tubes are partly behind it."""
    tubes = bundle(6, 6, seed=3, spread=10.0, radius=0.6)
    view = View(SIZE, camera(SIZE, eye=(0, -4, 1), target=(0, 4, 0), near=0.05, far=60.0, angle=90))
    assert_all_show(gl, tubes, view, solver=solver, wrong=0.004, least=1000)


PLANES = {
    "one": [[0.3, 1.0, 0.2, 2.0]],
    "two": [[0.0, 1.0, 0.0, 6.0], [1.0, 0.2, 0.0, 3.0]],
    "six": [(1.0, 0, 0, 9), (-1.0, 0, 0, 10), (0, 1.0, 0, 8), (0, -1.0, 0, 9), (0, 0, 1.0, 9), (0, 0, -1.0, 10)],
    "not of length 1": [[30.0, 100.0, 20.0, 200.0]],
}


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("planes", PLANES)
def test_planes_cut_and_close(gl, camera, tubes, planes, parallel):
    """The cut lies in the plane and has its normal; what is beyond is gone, and what it hid shows."""
    matrix = camera(SIZE, **EYE, **({"height": 46.0} if parallel else {}))
    view = View(SIZE, matrix, PLANES[planes])
    shown, picture = assert_all_show(gl, tubes, view, wrong=0.004, least=150)
    cap = shown.kind == CAP
    assert cap.sum() > 5
    plane = np.array(PLANES[planes])[shown.plane[cap]]
    o, d = rays(matrix, SIZE)
    at = (o + distances(picture, view)[..., None] * d)[cap]
    height = ((at * plane[:, :3]).sum(1) + plane[:, 3]) / np.linalg.norm(plane[:, :3], axis=1)
    assert (np.abs(height) > 1e-3).mean() < 0.01


@pytest.mark.few(1)
@pytest.mark.parametrize("solver", SOLVERS)
def test_planes_cut_with_every_solver(gl, camera, tubes, solver):
    view = View(SIZE, camera(SIZE, **EYE), PLANES["two"])
    picture = draw_splines(gl, tubes, view, solver=solver, min_width=0.0)
    assert_shows(picture, tubes, view, wrong=0.004, least=150)


def test_the_near_plane_and_a_plane_at_once(gl, camera, tubes):
    """Where the plane makes the start of a ray there is a cap; where the near plane does, the wall shows."""
    view = View((72, 54), camera((72, 54), **{**EYE, "near": 60.0}), [[0.9, 0.3, 0.2, 4.0]])
    picture = draw_splines(gl, tubes, view, min_width=0.0)
    shown = assert_shows(picture, tubes, view, inside=True, wrong=0.008, least=150)
    assert (shown.kind == CAP).sum() > 10
    assert (shown.kind == EXIT).sum() > 10


def test_what_planes_leave_nothing_of_is_gone(gl, tubes, view):
    nothing = View(SIZE, view.model_view_projection, [[0, 0, 1.0, -500.0]])
    assert not draw_splines(gl, tubes, nothing).drawn.any()
    everything = View(SIZE, view.model_view_projection, [[0, 0, 1.0, 500.0]])
    same_pictures(draw_splines(gl, tubes, view), draw_splines(gl, tubes, everything), some=0.0)


# ------------------------------------------------------------------------------------------------------------- shapes


def components(mask):
    """Number of parts that hang together by sides or corners."""
    left, count = mask.copy(), 0
    while left.any():
        part = np.zeros_like(mask)
        part[tuple(np.argwhere(left)[0])] = True
        size = 0
        while part.sum() != size:
            size = part.sum()
            part = near(part) & left
        left &= ~part
        count += 1
    return count


def holes(mask):
    """Pixels of the background from which no way leads out by sides."""
    h, w = mask.shape
    out = np.zeros((h + 2, w + 2), bool)
    out[0] = out[-1] = out[:, 0] = out[:, -1] = True
    free, size = ~np.pad(mask, 1), 0
    while out.sum() != size:
        size = out.sum()
        for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
            out |= np.roll(out, step, axis) & free
    return int((free & ~out).sum())


@pytest.mark.few(1)
@pytest.mark.parametrize("radius", [0.0, 1e-7, 1e-3, 0.2])
def test_thin_tubes_have_the_least_width(gl, camera, radius):
    """A pixel wide however far: one line without a gap. With a width of 0 they are as thin as they are."""
    tube = winding(radius=radius, vary=0.0)
    for more in ({}, {"height": 120.0}):
        view = View(SIZE, camera(SIZE, eye=(20, -160, 60), target=(20, 0, 0), near=50.0, far=400.0, angle=35, **more))
        expected, thin = seen(tube, view, min_width=1.0), seen(tube, view)
        for silhouettes in SILHOUETTES:
            wide = draw_splines(gl, tube, view, silhouettes=silhouettes, min_width=1.0)
            assert_shows(wide, tube, view, expected=expected, wrong=0.02, depth=0.02, least=40)
            assert components(wide.drawn) == 1
            exact = draw_splines(gl, tube, view, silhouettes=silhouettes, min_width=0.0)
            assert (exact.drawn != thin.drawn).sum() <= 2
            assert exact.drawn.sum() < 0.8 * wide.drawn.sum()


def test_least_width_is_in_pixels(gl, camera):
    tube = winding(radius=0.0)
    view = View(SIZE, camera(SIZE, eye=(20, -90, 0), target=(20, 0, 0), near=20.0, far=400.0, angle=35))
    areas = [draw_splines(gl, tube, view, min_width=width).drawn.sum() for width in (2.0, 4.0, 8.0)]
    assert areas[1] / areas[0] == pytest.approx(2.0, abs=0.15)
    assert areas[2] / areas[1] == pytest.approx(2.0, abs=0.2)


def test_corners_forks_and_balls(gl, camera):
    """A corner by two nodes at one place, a fork by a node of three segments, a ball by a segment to its own node."""
    points = [[-12, 0, -4], [-4, 0, 4], [-4, 0, 4], [4, 0, -4], [12, 0, 4], [12, 4, -8], [0, 0, 10]]
    tangents = [[8, 0, 8], [8, 0, 8], [8, 0, -8], [8, 0, -6], [6, 0, 8], [6, 3, -4], [0, 0, 0]]
    tubes = SplineTubes(
        points, [[0, 1], [2, 3], [3, 4], [3, 5], [6, 6]], [1.5, 1.2, 1.2, 1.6, 0.8, 0.7, 2.5], tangents,
        [0, 0, 0, -0.3, 0, 0, 0], False, [0, 0, 0, 1, 2], 3,
    )  # fmt: skip
    view = View(SIZE, camera(SIZE, eye=(2, -60, 8), target=(0, 0, 1), near=20.0, far=120.0, angle=30))
    for silhouettes in SILHOUETTES:
        picture = draw_splines(gl, tubes, view, silhouettes=silhouettes, min_width=0.0)
        assert set(np.unique(picture.owner)) == {-1, 0, 1, 2, 3, 4}
        assert set(np.unique(picture.tube[picture.drawn])) == {0, 1, 2}
        shown = seen(tubes, view)
        ball = shown.owner == 4
        assert ball.sum() > 100
        # A ball has no direction and no place along it.
        assert (picture.owner[ball] == 4).all()
        rest = shown._replace(
            drawn=shown.drawn & ~ball, tangent=np.where(ball[..., None], picture.tangent, shown.tangent)
        )
        assert_shows(picture._replace(drawn=picture.drawn & (picture.owner != 4)), tubes, view, expected=rest)
        normals = degrees(picture.normal, shown.normal)[ball & (np.abs(shown.facing) > 0.1)]
        assert normals.max() < 0.5


@pytest.mark.few(3)
@pytest.mark.parametrize("angle", range(0, 180, 30))
def test_no_holes_between_segments(gl, camera, angle):
    """A line of many segments without a background pixel inside, from all around, and along itself."""
    t = np.linspace(0, 1, 25)
    tube = tube_through(np.stack([40 * t - 20, 3 * np.sin(7 * t), 3 * np.cos(5 * t)], 1), 1.5 + 0.4 * np.sin(30 * t))
    turn = np.radians(angle)
    eye = 70 * np.array([np.cos(turn), -np.sin(turn), 0.1 * np.sin(3 * turn)])
    view = View(SIZE, camera(SIZE, eye=eye, near=20.0, far=150.0, angle=36))
    assert holes(seen(tube, view).drawn) == 0
    for silhouettes in SILHOUETTES:
        picture = draw_splines(gl, tube, view, silhouettes=silhouettes, min_width=0.0)
        assert picture.drawn.sum() > 40
        assert holes(picture.drawn) == 0
        assert components(picture.drawn) == 1


def test_normals_go_on_across_nodes(gl, camera):
    """Left and right of a node the normal turns as little as between any two neighbours."""
    tube = winding(m=8)
    view = View((480, 360), camera((480, 360), eye=(20, -60, 10), target=(20, 0, 0), near=20.0, far=150.0, angle=42))
    picture = draw_splines(gl, tube, view)
    both = picture.drawn[:, 1:] & picture.drawn[:, :-1]
    turn = degrees(picture.normal[:, 1:], picture.normal[:, :-1])
    slope = np.abs(picture.normal[:, 1:] @ (view.model_view_projection[3, :3]))
    inner = both & (slope > 0.3 * np.linalg.norm(view.model_view_projection[3, :3]))
    inner &= np.abs(np.diff(picture.z, axis=1)) < 1e-3
    across = inner & (picture.owner[:, 1:] != picture.owner[:, :-1])
    assert across.sum() > 100
    assert turn[across].max() < 1.2 * turn[inner & ~across].max() + 0.5
    assert np.median(turn[across]) < 2 * np.median(turn[inner & ~across])


def test_shown_places_lie_on_the_tube(gl, tubes, view):
    """Depth, normal, owner and t of a pixel agree: along the normal of the sphere at t is what is seen."""
    picture = draw_splines(gl, tubes, view, min_width=0.0)
    o, d = rays(view.model_view_projection, SIZE)
    at = (o + distances(picture, view)[..., None] * d)[picture.drawn]
    owner, t = picture.owner[picture.drawn], picture.t[picture.drawn]
    second = (t >= 0.5).astype(int)
    ball = evaluate(controls(tubes)[owner, second], np.clip(2 * t - second, 0, 1))
    off = np.linalg.norm(ball[:, :3] + ball[:, 3:] * picture.normal[picture.drawn] - at, axis=1) / ball[:, 3]
    assert np.quantile(off, 0.99) < 5e-3
