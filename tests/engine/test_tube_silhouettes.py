"""Silhouettes of spline tubes: boxes that hold their halves, rectangles that hold every pixel of their segment."""

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from pvfiblets.engine import View
from pvfiblets.engine.gl.bindings import TUBES
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.shaders import Programs
from pvfiblets.engine.lattice import TOP
from pvfiblets.engine.tubes.nodes import Nodes
from pvfiblets.engine.tubes.uniform_blocks import TubeBlocks
from pvfiblets.report.studies.tubes.reference import nearest_hits
from pvfiblets.tubes import SplineTubes
from pvfiblets.tubes.curves import MIDDLE, boxes, controls, sample_spheres

from .line_tubes import rays
from .tubes import bundle, far_ends

SIZE = (96, 72)


@pytest.fixture
def vertices(gl):
    """Return a function: clip coordinates of the vertices that a stage makes of a set."""
    programs, library = Programs(gl, {}), GLExtras(gl)
    target = gl.simple_framebuffer((1, 1))  # none is drawn into, and yet one must be bound

    def run(stage, corners, tubes, view, *, min_width=0.0, planes=False):
        features = ["TUBES", *(["CLIP_PLANES"] if planes else [])]
        program = programs.render({"vertex": f"tubes/{stage}.vert"}, features, ["gl_Position"])
        nodes = Nodes(gl, library, tubes)
        blocks = TubeBlocks(gl, (nodes.origin, nodes.scale, TOP), tubes.scaled)
        count = corners * tubes.n_segments
        found = gl.buffer(reserve=16 * count)
        array = gl.vertex_array(program, [])
        try:
            blocks.write(
                view, reach=100.0, middle=MIDDLE, min_width=min_width, drawn_width=min_width, iterations=9,
                n_segments=tubes.n_segments,
            )  # fmt: skip
            nodes.bind()
            for sampler, unit in TUBES.items():
                library.set_sampler(program, sampler, unit)
            program["first_segment"] = 0
            if planes:
                program["drawn_sides"] = 3
            with library.framebuffers_kept():
                target.use()
                array.transform(found, vertices=count)
            return np.frombuffer(found.read(), "<f4").reshape(tubes.n_segments, corners, 4).astype(float)
        finally:
            for thing in (array, found, nodes, blocks):
                thing.release()

    yield run
    programs.release()
    target.release()


def around(tubes):
    """A parallel view of all of a set and no more: clip coordinates are places then."""
    low, high = np.reshape(tubes.bounds, (3, 2)).T
    half = max((high - low).max(), 1e-30)
    matrix = np.eye(4)
    matrix[:3, :3] /= half
    matrix[:3, 3] = -0.5 * (low + high) / half
    return View(SIZE, matrix), half


def assert_boxes_hold(vertices, tubes):
    """Every sphere along both halves lies in its box; return edges and controls."""
    view, extent = around(tubes)
    clip = vertices("boxes", 16, tubes, view).reshape(-1, 8, 4)
    places = (clip[..., :3] / clip[..., 3:] - view.model_view_projection[:3, 3]) * extent
    points = controls(tubes).reshape(-1, 3, 4)
    balls = sample_spheres(points, 65)
    edges = places[:, [1, 2, 4]] - places[:, :1]
    lengths = np.linalg.norm(edges, axis=2)
    middle = points[:, :, :3].mean(axis=1, keepdims=True)
    size = np.linalg.norm(points[:, :, :3] - middle, axis=2).max(axis=1) + points[:, :, 3].max(axis=1)
    slack = 2e-6 * extent + 1e-5 * size
    for k in range(3):
        # An edge of hardly any length has no direction to speak of: then the other two tell it.
        thin = lengths < 1e-2 * size[:, None] + 100 * slack[:, None]
        other = np.cross(edges[:, k - 2], edges[:, k - 1])
        told = np.where(thin[:, k, None], other, edges[:, k])
        known = ~thin[:, k] | ~(thin[:, k - 2] | thin[:, k - 1])
        axis = told / np.maximum(np.linalg.norm(told, axis=1, keepdims=True), 1e-300)
        shortest = np.where(thin[:, k], np.minimum(lengths[:, k - 2], lengths[:, k - 1]), lengths[:, k])
        off = (slack + 4e-7 * extent / np.maximum(shortest, 1e-300) * size)[:, None]  # as float32 turns the axis
        along = np.einsum("nsd,nd->ns", balls[..., :3] - places[:, :1], axis)
        assert (along - balls[..., 3] >= -off)[known].all()
        assert (along + balls[..., 3] <= lengths[:, k, None] + off)[known].all()
    return lengths, points


def segments_of(places, radius, tangents, slopes):
    """A set of segments of nodes of their own; arrays are (n, 2, ...)."""
    n = len(places)
    return SplineTubes(
        np.reshape(places, (-1, 3)), np.arange(2 * n).reshape(n, 2), np.ravel(radius), np.reshape(tangents, (-1, 3)),
        np.ravel(slopes), False, np.arange(n), n,
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(4))
def test_boxes_hold_their_halves_and_no_more(vertices, seed):
    """As large as those of the reference, all of whose sides touch."""
    rng = np.random.default_rng(seed)
    n = 300
    start = rng.uniform(-20, 20, (n, 1, 3))
    places = np.concatenate([start, start + rng.normal(0, 4, (n, 1, 3))], axis=1)
    tubes = segments_of(places, rng.uniform(0, 2, (n, 2)), rng.normal(0, 6, (n, 2, 3)), rng.normal(0, 2, (n, 2)))
    lengths, points = assert_boxes_hold(vertices, tubes)
    wanted = 2 * boxes(points).half
    # Which way across is free where a half does not bend, hence the volume.
    assert np.abs(lengths.prod(axis=1) / wanted.prod(axis=1) - 1).max() < 2e-3
    assert np.abs(lengths[:, 0] - wanted[:, 0]).max() < 1e-3


def test_boxes_of_degenerate_halves(vertices):
    rng = np.random.default_rng(9)
    ends = {
        "no length": ([[1, 2, 3], [1, 2, 3]], [1, 2], [[0, 0, 0], [0, 0, 0]], [0, 0]),
        "no length, tangents": ([[1, 2, 3], [1, 2, 3]], [1, 2], [[9, 0, 0], [-9, 3, 0]], [0, 0]),
        "no radius": ([[0, 0, 0], [5, 0, 0]], [0, 0], [[5, 2, 0], [5, -2, 0]], [0, 0]),
        "no radius, straight": ([[0, 0, 0], [5, 0, 0]], [0, 0], [[5, 0, 0], [5, 0, 0]], [0, 0]),
        "long tangents": ([[0, 0, 0], [1, 0, 0]], [0.5, 0.2], [[100, 30, 0], [50, 0, 70]], [0, 0]),
        "opposite": ([[0, 0, 0], [1, 0, 0]], [0.5, 0.2], [[-4, 0, 0], [-4, 0, 0]], [0, 0]),
        "to a point": ([[0, 0, 0], [1, 0, 0]], [1, 0], [[1, 0, 0], [1, 0, 0]], [9, -9]),
        "wide": ([[0, 0, 0], [0.01, 0, 0]], [10, 8], [[0.01, 0, 0], [0, 0.01, 0]], [0, 5]),
        "steep": ([[0, 0, 0], [3, 0, 1]], [1, 2], [[3, 1, 0], [3, 0, 1]], [80, -90]),
    }
    places, radius, tangents, slopes = (np.array([end[k] for end in ends.values()], float) for k in range(4))
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    assert_boxes_hold(vertices, segments_of(places, radius, tangents, slopes))
    assert_boxes_hold(vertices, segments_of(places @ turn, radius, tangents @ turn, slopes))


NUMBERS = st.one_of(st.sampled_from([0.0, 1.0, -1.0, 1e-7, 1e-20]), st.floats(-3, 3))
PLACES = st.tuples(NUMBERS, NUMBERS, NUMBERS)


@hypothesis.given(
    st.lists(PLACES, min_size=4, max_size=4), st.lists(st.floats(0, 3), min_size=2, max_size=2),
    st.lists(NUMBERS, min_size=2, max_size=2), st.sampled_from([1.0, 1e-5, 1e5]),
)  # fmt: skip
@hypothesis.settings(suppress_health_check=[hypothesis.HealthCheck.function_scoped_fixture])
def test_boxes_of_any_segment(vertices, places, radius, slopes, scale):
    places, radius, slopes = (scale * np.array(a, float) for a in (places, radius, slopes))
    hypothesis.assume(np.abs(places).max() + radius.max() > 1e-3 * scale)
    assert_boxes_hold(vertices, segments_of(places[None, :2], radius, places[None, 2:], slopes))


# --------------------------------------------------------------------------------------------------------- rectangles


def rectangles_of(vertices, tubes, view, **options):
    """(n, 4, 2) pixels of the corners, and which have any."""
    clip = vertices("rectangles", 4, tubes, view, **options)
    pixels = (clip[..., :2] / clip[..., 3:] + 1) / 2 * view.size
    return pixels, (clip[..., :2] != 2.0).any(axis=(1, 2))


def covered(tubes, view, number):
    """(h, w) pixels whose ray meets one segment between near and far plane, from outside or inside."""
    o, d = (a.reshape(-1, 3) for a in rays(view.model_view_projection, view.size))
    points = controls(tubes, [number])[0]
    met = nearest_hits(points, o, d, start=0.0, end=far_ends(view).reshape(-1))
    return (met.kind > 0).reshape(view.size[::-1])


def places_in(corners, pixels):
    """Pixels' middles in steps from the first corner along the sides, in pixels; and the sides' lengths."""
    x, y = corners[1] - corners[0], corners[2] - corners[0]
    lengths = np.linalg.norm([x, y], axis=1)
    axes = np.array([x, y]) / np.maximum(lengths, 1e-9)[:, None]
    return (pixels[:, ::-1] + 0.5 - corners[0]) @ axes.T, lengths


VIEWS = {
    "usual": {"eye": (3, -62, 14), "near": 20.0, "far": 120.0, "angle": 42.0},
    "parallel": {"eye": (3, -62, 14), "near": 20.0, "far": 120.0, "height": 40.0},
    "among": {"eye": (0, -9, 2), "near": 0.1, "far": 120.0, "angle": 90.0},
    "very wide": {"eye": (4, 2, 1), "target": (9, 2, 3), "near": 0.05, "far": 120.0, "angle": 140.0},
    "inside": {"eye": None, "near": 0.05, "far": 120.0, "angle": 70.0},
}


@pytest.mark.few(1)
@pytest.mark.parametrize("name", VIEWS)
def test_rectangles_hold_every_pixel_of_their_segment(vertices, camera, name):
    tubes = bundle(radius=1.2)
    more = dict(VIEWS[name])
    if more["eye"] is None:
        more |= {"eye": tubes.points[2] + 0.1, "target": tubes.points[4]}
    view = View(SIZE, camera(SIZE, **more))
    corners, some = rectangles_of(vertices, tubes, view)
    slack = []
    for number in range(tubes.n_segments):
        pixels = np.argwhere(covered(tubes, view, number))
        if not len(pixels):
            continue
        assert some[number]
        at, lengths = places_in(corners[number], pixels)
        assert (at > -1e-3).all()
        assert (at < lengths + 1e-3).all()
        if pixels.min() > 0 and (pixels.max(axis=0) < np.array(SIZE[::-1]) - 1).all():  # none is cut by the window
            slack += [at.min(axis=0), lengths - at.max(axis=0)]
    if name in ("usual", "parallel"):
        assert len(slack) > 40
        # Half a pixel to the next middle, and what the controls' hull is larger by than the tube.
        assert np.median(slack) < 1.2
        assert np.quantile(slack, 0.95) < 4.0


def test_rectangles_hold_widened_tubes(vertices, camera):
    """Thinner than a pixel: the rectangle is as wide as the least width all the same."""
    tubes = bundle(radius=1e-4)
    view = View(SIZE, camera(SIZE, **VIEWS["usual"]))
    for width in (0.0, 1.0, 6.0):
        corners, some = rectangles_of(vertices, tubes, view, min_width=width)
        sides = np.linalg.norm(corners[some][:, 2] - corners[some][:, 0], axis=1)
        assert (sides > width).all()
        assert np.median(sides) < width + 3.0


def test_segments_beyond_the_view_have_none(vertices, camera):
    tubes = bundle(radius=1.0)
    away = View(SIZE, camera(SIZE, eye=(0, -62, 0), target=(0, -100, 0), near=1.0, far=50.0))
    assert not rectangles_of(vertices, tubes, away)[1].any()
    aside = View(SIZE, camera(SIZE, eye=(90, -62, 0), target=(90, 0, 0), near=1.0, far=500.0))
    assert not rectangles_of(vertices, tubes, aside)[1].any()


@pytest.mark.parametrize("stage", ["rectangles", "boxes"])
def test_segments_beyond_a_plane_have_none(vertices, camera, stage):
    """Those that have spheres on the kept side, and no others, whatever kind the silhouette is."""
    tubes = bundle(radius=1.0)
    plane = np.array([0.4, 1.0, -0.2, 1.0])
    view = View(SIZE, camera(SIZE, **VIEWS["usual"]), [plane])
    clip = vertices(stage, {"rectangles": 4, "boxes": 16}[stage], tubes, view, planes=True)
    shown = (clip[..., :2] != 2.0).any(axis=(1, 2))
    points = controls(tubes)
    unit = plane / np.linalg.norm(plane[:3])
    balls = sample_spheres(points, 65)
    tube_reaches = (balls[..., :3] @ unit[:3] + unit[3] + balls[..., 3]).max(axis=(1, 2)) > 0
    corners = points[:, [0, 0, 1, 1], [0, 1, 1, 2]]
    hull_reaches = (corners[..., :3] @ unit[:3] + unit[3] + corners[..., 3]).max(axis=1) > 0
    assert shown[tube_reaches].all()
    assert not shown[~hull_reaches].any()
    assert 0.2 < shown.mean() < 0.9
