"""Boundaries of regions along rays, against the exact regions: random depths of every pixel, in float64."""

import itertools
from dataclasses import replace

import moderngl
import numpy as np
import pytest

from pvfiblets import regions
from pvfiblets.engine.errors import EngineError
from pvfiblets.engine.fiblets.pipelines import CONSTANTS
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.shaders import Programs, assemble
from pvfiblets.engine.regions.layer_stack import Squares
from pvfiblets.engine.regions.ray_intervals import RegionIntervals
from pvfiblets.engine.view import View

from .elsewhere import run_elsewhere

pv = pytest.importorskip("pyvista")  # which makes surfaces

SIZE = (96, 72)
ORIGIN, SCALE, TOP = np.full(3, -100.0), np.full(3, 200.0 / 65535.0), 65535

FRAGMENT = """
#version 430
#include "regions/boundaries.glsl"
uniform sampler2D depths;
out float kept;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    kept = region_keeps(pixel, texelFetch(depths, pixel, 0).x) ? 1.0 : 0.0;
}
"""

COMPUTE = """
#version 430
layout(local_size_x = 8, local_size_y = 8) in;
#include "regions/boundaries.glsl"
uniform sampler2D depths;
layout(r32f, binding = 0) writeonly uniform image2D kept;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, textureSize(depths, 0)))) return;
    imageStore(kept, pixel, vec4(region_keeps(pixel, texelFetch(depths, pixel, 0).x) ? 1.0 : 0.0));
}
"""


@pytest.fixture
def cutter(gl):
    functions, programs = GLExtras(gl), Programs(gl, CONSTANTS)
    made = RegionIntervals(gl, functions, programs)
    yield made
    made.release()
    made.release()
    programs.release()


def asked(gl, cutter, depths, *, compute=False):
    """What `region_keeps` says of a depth for each pixel."""
    height, width = depths.shape
    asking = gl.texture((width, height), 1, np.ascontiguousarray(depths, "<f4").tobytes(), dtype="f4")
    answer = gl.texture((width, height), 1, dtype="f4")
    target = gl.framebuffer([answer])
    if compute:
        program = gl.compute_shader(assemble("test", source=COMPUTE))
    else:
        stages = {
            "vertex_shader": assemble("screen/triangle.vert", version=330),
            "fragment_shader": assemble("test", source=FRAGMENT, version=330),
        }
        program = gl.program(**stages)
    cutter.bind(program)
    asking.use(0)
    program["depths"] = 0
    if compute:
        answer.bind_to_image(0, read=False, write=True)
        program.run(-(-width // 8), -(-height // 8))
        gl.memory_barrier()
    else:
        array = gl.vertex_array(program, [])
        with GLExtras(gl).framebuffers_kept():
            target.use()
            gl.enable_only(moderngl.NOTHING)
            array.render(moderngl.TRIANGLES, vertices=3)
        array.release()
    found = np.frombuffer(answer.read(), "<f4").reshape(height, width) > 0.5
    for thing in (target, asking, answer, program):
        thing.release()
    return found


def places(view, x, y, z):
    """Data mm of window coordinates, in float64."""
    width, height = view.size
    clip = np.stack([2 * x / width - 1, 2 * y / height - 1, 2 * z - 1, np.ones_like(z)], axis=-1).reshape(-1, 4)
    found = clip @ np.linalg.inv(view.model_view_projection).T
    return found[:, :3] / found[:, 3:]


def random_depths(view, rng, shape):
    """Window depths whose places are spread evenly along each ray."""
    near, far = (np.linalg.solve(view.model_view_projection, [0, 0, z, 1.0]) for z in (-1.0, 1.0))
    share = rng.uniform(0, 1, shape)
    a, b = near[3], far[3]  # reciprocal clip w at both ends
    w = (1 - share) / a + share / b
    z = share if a == b else (1 / w - a) / (b - a)
    return np.clip(z, 0, 0.9999999).astype(np.float32)


def check(gl, cutter, region, view, *, seed=0, least=0.9, rounds=2, box=(ORIGIN, SCALE, TOP), slack=4e-7, **options):
    """Hold every pixel against the region, but where a small step changes the answer."""
    rng = np.random.default_rng(seed)
    assert cutter.prepare(View(view.size, view.model_view_projection, region=region), *box)
    width, height = view.size
    y, x = np.mgrid[0:height, 0:width] + 0.5
    for _ in range(rounds):
        z = random_depths(view, rng, x.shape)
        found = asked(gl, cutter, z, **options)
        want = region.contains(places(view, x, y, z.astype(float))).reshape(z.shape)
        sure = np.ones(z.shape, bool)
        for dx, dy, dz in itertools.product((-0.02, 0.02), (-0.02, 0.02), (-slack, slack)):
            near = region.contains(places(view, x + dx, y + dy, z + dz)).reshape(z.shape)
            sure &= near == want
        assert sure.mean() > least
        wrong = (found != want) & sure
        assert not wrong.any(), f"{wrong.sum()} of {sure.sum()}: {np.argwhere(wrong)[:5].tolist()}, z {z[wrong][:5]}"
        if want.any() and not want.all():
            assert found.any()


def surface(mesh):
    mesh = mesh.triangulate().clean()
    mesh = mesh.compute_normals(point_normals=False, auto_orient_normals=True, consistent_normals=True)
    return regions.Surface(np.asarray(mesh.points, float), mesh.regular_faces)


@pytest.fixture(scope="session")
def torus():
    return surface(pv.ParametricTorus(ringradius=40, crosssectionradius=15, u_res=51, v_res=51, w_res=51))


@pytest.fixture(scope="session")
def bumpy():
    sphere = pv.Icosphere(radius=1.0, nsub=4)
    p = np.asarray(sphere.points, float)
    radii = 45 + 8 * np.sin(7 * p[:, 0]) * np.cos(6 * p[:, 1]) + 6 * np.sin(9 * p[:, 2])
    return regions.Surface(p * radii[:, None], sphere.regular_faces)


@pytest.fixture(scope="session")
def shells():
    """A ball with a hollow, in which a smaller ball lies."""
    ball = pv.Icosphere(radius=1.0, nsub=3)
    p, f = np.asarray(ball.points, float), ball.regular_faces
    n = len(p)
    return regions.Surface(np.concatenate([60 * p, 40 * p, 20 * p]), np.concatenate([f, f[:, ::-1] + n, f + 2 * n]))


def cameras(camera):
    """From all around, perspective and parallel, and one from within."""
    yield View(SIZE, camera(SIZE))
    yield View(SIZE, camera(SIZE, eye=(150, 90, -120), up=(0, 1, 0), near=40, far=400))
    yield View(SIZE, camera(SIZE, eye=(-200, 40, 100), height=140.0))
    yield View(SIZE, camera(SIZE, eye=(3, -35, 4), target=(20, 40, 0), near=1.0, far=300, angle=60))
    yield View(SIZE, camera(SIZE, eye=(0, -100, 10), near=70.0, far=110.0))  # both planes cut the shapes


BOX = regions.Box([-20, 30, -40, 10, -50, 20])
BALL = regions.Sphere((5, 5, 5), 40)
TURNED = regions.Box(
    center=(10, -5, 8), size=(60, 20, 45), rotation=np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
)

SHAPES = {
    "plane": regions.Plane((1, 2, 0.5), (4, 5, 6)),
    "slab": regions.Slab((0.2, 1, -0.4), (0, 3, 0), 25.0),
    "box": BOX,
    "turned box": TURNED,
    "sphere": BALL,
    "ellipsoid": BALL.moved(np.diag([1.5, 0.4, 1.0, 1.0]) + 0.2 * np.eye(4, k=1)),
    "not a box": ~BOX,
    "difference": BOX - BALL,
    "either": BOX | BALL | regions.Slab((0, 0, 1), (0, 0, -40), 6.0),
    "deep": ((BALL - TURNED) | (BOX & TURNED)) & ~regions.Sphere((0, -20, 0), 18)
    | regions.Plane((0, 0, -1), (0, 0, -55)),
}


@pytest.mark.few(5)
@pytest.mark.parametrize("name", SHAPES)
def test_shapes_and_expressions(gl, cutter, camera, name):
    for view in cameras(camera):
        check(gl, cutter, SHAPES[name], view)


@pytest.mark.parametrize("name", ["torus", "bumpy", "shells"])
def test_surfaces(gl, cutter, camera, request, name):
    region = request.getfixturevalue(name)
    for view in cameras(camera):
        check(gl, cutter, region, view)


def test_surfaces_in_expressions(gl, cutter, camera, torus, bumpy):
    moved = torus.moved([[0, 0, 1, 5], [1, 0, 0, -8], [0, 1, 0, 3], [0, 0, 0, 1]])
    for region in (bumpy - torus, (torus | moved) - BOX, ~(bumpy & moved) & BALL):
        for view in cameras(camera):
            check(gl, cutter, region, view, rounds=1)


def test_compute_shaders_say_the_same(gl, cutter, camera, torus):
    view = View(SIZE, camera(SIZE))
    check(gl, cutter, torus - BOX, view, compute=True)


def block(low, high):
    """Points and triangles of a box."""
    mesh = pv.Box(np.ravel(np.stack([low, high], axis=1))).triangulate()
    return np.asarray(mesh.points, float), mesh.regular_faces


def joined(*meshes):
    points = np.concatenate([p for p, _ in meshes])
    firsts = np.cumsum([0, *[len(p) for p, _ in meshes]])
    return regions.Surface(points, np.concatenate([f + n for (_, f), n in zip(meshes, firsts, strict=False)]))


def test_coinciding_faces_are_counted(gl, cutter, camera):
    corner = (-20, -20, -20)
    a, b, c = block(corner, (0, 20, 20)), block(corner, (30, 20, 20)), block((0, -20, -20), (30, 9, 20))
    for region in (joined(a, b), joined(a, c), joined(a, a), joined(b, a, a, c)):
        for view in cameras(camera):
            check(gl, cutter, region, view, rounds=1)
    assert cutter._surfaces._tallies is not None
    check(gl, cutter, joined(b), View(SIZE, camera(SIZE)), rounds=1)
    assert cutter._surfaces._tallies is None


def test_a_surface_that_runs_through_itself(gl, cutter, camera):
    ball = pv.Icosphere(radius=40.0, nsub=3)
    points, triangles = np.asarray(ball.points, float), ball.regular_faces
    several = [(points + shift, triangles) for shift in ([0, 0, 0], [25, 3, 1], [10, -30, 5])]
    for view in cameras(camera):
        check(gl, cutter, joined(*several), view, rounds=1)


def test_many_shells_take_many_layers(gl, cutter, camera):
    ball = pv.Icosphere(radius=1.0, nsub=2)
    points, triangles = np.asarray(ball.points, float), ball.regular_faces
    shells = [
        (radius * points, triangles if k % 2 == 0 else triangles[:, ::-1])
        for k, radius in enumerate(np.linspace(60, 10, 11))
    ]
    region, layers = joined(*shells), []
    for view in cameras(camera):
        check(gl, cutter, region, view, rounds=1, least=0.8)
        layers.append(cutter.layers)
    assert layers[0] >= 6


def test_more_boundaries_than_expected(gl, cutter, camera):
    row = regions.Sphere((0, -80, 0), 3)
    for y in np.linspace(-72, 80, 20):
        row = row | regions.Sphere((0, y, 0), 3)
    view = View(SIZE, camera(SIZE, eye=(0, -200, 1), angle=15))
    check(gl, cutter, row, view)
    assert cutter.layers > 8
    check(gl, cutter, ~row, view)
    check(gl, cutter, BALL, view)
    assert cutter.layers == 1


def test_mirrors(gl, cutter, camera, torus):
    mirror = np.diag([-1.0, 1, 1, 1])
    for view in [*cameras(camera)][::2]:
        check(gl, cutter, torus.moved(mirror), view, rounds=1)
        mirrored = View(view.size, view.model_view_projection @ mirror)
        check(gl, cutter, torus.moved(np.eye(4) + 20 * np.eye(4, k=3)), mirrored, rounds=1)
        check(gl, cutter, TURNED - BALL, mirrored, rounds=1)


@pytest.mark.parametrize(("size", "where"), [(1.0, 1e6), (1e-6, 0.0), (1e-6, 1e-3), (1e5, 0.0), (1e4, 1e6)])
def test_far_away_tiny_and_huge(gl, cutter, camera, torus, size, where):
    placed = np.diag([size, size, size, 1.0])
    placed[:3, 3] = where
    box = (size * ORIGIN + where, size * SCALE, TOP)
    for region in (torus, TURNED, BALL, regions.Plane((1, 2, 0.5), (4, 5, 6))):
        for view in [*cameras(camera)][::2]:
            there = View(view.size, view.model_view_projection @ np.linalg.inv(placed))
            check(gl, cutter, region.moved(placed), there, rounds=1, box=box, slack=6e-7)


def test_sizes_far_from_that_of_the_data(gl, cutter, camera):
    view = View(SIZE, camera(SIZE))
    for radius in (1e-3, 0.5, 1e4, 1e7):
        centre = (5 + radius, 3, 1)
        for region in (regions.Sphere(centre, radius), regions.Box(center=centre, size=2 * radius)):
            check(gl, cutter, region, view, rounds=1)


def test_what_lies_beside_or_behind_is_nowhere(gl, cutter, camera, torus):
    view = View(SIZE, camera(SIZE))
    for shift in ([0, -400, 60], [500, 0, 0], [0, 900, 0]):
        away = np.eye(4)
        away[:3, 3] = shift
        for region in (torus.moved(away), ~torus.moved(away), BALL - torus.moved(away), BALL.moved(away)):
            check(gl, cutter, region, view, rounds=1)
    shapes = [regions.Sphere((500, 0, 3 * k), 2) for k in range(5)]
    region = shapes[0] | shapes[1] | shapes[2] | shapes[3] | shapes[4]
    for one in (region, ~region):
        check(gl, cutter, one, View(SIZE, camera(SIZE)), rounds=1)
        assert gl.error == "GL_NO_ERROR"
        cutter.release()


def test_a_flattening_matrix_keeps_everything(gl, cutter, camera, torus):
    flat = camera(SIZE)
    flat[2] = 0.0
    for region in (BOX, torus):
        check(gl, cutter, region, View(SIZE, camera(SIZE)), rounds=1)
        assert cutter.prepare(View(SIZE, flat, region=region), ORIGIN, SCALE, TOP)
        assert asked(gl, cutter, np.full(SIZE[::-1], 0.7)).all()


def test_labels_cannot_cut(gl, cutter, camera):
    labels = regions.Labels(np.ones((2, 2, 2), np.uint8), np.eye(4))
    with pytest.raises(ValueError, match="label volume cannot cut"):
        cutter.prepare(View(SIZE, camera(SIZE), region=BOX - labels), ORIGIN, SCALE, TOP)


def test_nothing_is_done_twice_and_nothing_is_left(gl, cutter, camera, torus, monkeypatch):
    drawn = []
    combine = RegionIntervals._combine
    monkeypatch.setattr(RegionIntervals, "_combine", lambda self, *a: (drawn.append(1), combine(self, *a)))
    view = View(SIZE, camera(SIZE), region=torus - BOX)
    for _ in range(3):
        assert cutter.prepare(view, ORIGIN, SCALE, TOP)
        assert cutter.prepare(View(SIZE, camera(SIZE), region=torus - BOX), ORIGIN, SCALE, TOP)
    assert len(drawn) == 1
    before = cutter.nbytes
    assert before >= SIZE[0] * SIZE[1] * (16 + 40)
    cutter.prepare(View(SIZE, camera(SIZE), region=BOX), ORIGIN, SCALE, TOP)
    assert len(drawn) == 2
    assert cutter.nbytes == SIZE[0] * SIZE[1] * 16 + cutter._block.size
    assert not cutter.prepare(View(SIZE, camera(SIZE)), ORIGIN, SCALE, TOP)
    assert cutter.nbytes == 0


def test_a_cut_that_failed_does_not_spoil_the_next(gl, cutter, camera, torus, monkeypatch):
    """Memory runs out once, halfway through making room for layers."""
    from pvfiblets.engine.regions import surface_crossings

    made = []

    class Short(surface_crossings.LayerStack):
        def __init__(self, *arguments):
            made.append(1)
            if len(made) == 2:
                raise EngineError("no memory for layers")
            super().__init__(*arguments)

    monkeypatch.setattr(surface_crossings, "LayerStack", Short)
    view = View((60, 50), camera((60, 50)), (), torus)
    with pytest.raises(EngineError, match="no memory for layers"):
        cutter.prepare(view, ORIGIN, SCALE, TOP)
    assert len(made) == 2
    check(gl, cutter, torus, View((60, 50), camera((60, 50))), least=0.5)


def test_sizes_change(gl, cutter, camera, torus):
    for size in ((90, 120), (33, 17), (1, 1), (150, 40)):
        check(gl, cutter, torus - BOX, View(size, camera(size)), rounds=1, least=0.5)


def test_state_is_left_as_it_is(gl, cutter, camera, torus):
    texture = gl.texture((8, 8), 4)
    target = gl.framebuffer([texture])
    target.use()
    functions = GLExtras(gl)
    cutter.prepare(View(SIZE, camera(SIZE), region=torus - BOX), ORIGIN, SCALE, TOP)
    assert functions.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") == target.glo
    # Blending, clipping, scissor and clamps would show in this picture.
    program = gl.program(
        vertex_shader=assemble("screen/triangle.vert", version=330),
        fragment_shader="#version 330\nout vec4 c; void main() { c = vec4(0.25); }",
    )
    array = gl.vertex_array(program, [])
    gl.clear(1.0, 1.0, 1.0, 1.0)
    target.use()
    array.render(moderngl.TRIANGLES, vertices=3)
    assert set(texture.read()) == {64}
    for thing in (array, program):
        thing.release()
    gl.detect_framebuffer(0).use()
    target.release()
    texture.release()


def draw_all(ctx, camera):
    """Check some regions without fixtures."""
    programs = Programs(ctx, CONSTANTS)
    cutter = RegionIntervals(ctx, GLExtras(ctx), programs)
    ring = surface(pv.ParametricTorus(ringradius=40, crosssectionradius=15, u_res=31, v_res=31, w_res=31))
    a, b = block((-20, -20, -20), (0, 20, 20)), block((-20, -20, -20), (30, 20, 20))
    for region in (BOX - BALL, ring - BOX, joined(a, b) | BALL):
        for view in cameras(camera):
            check(ctx, cutter, region, view, rounds=1)
    cutter.release()
    programs.release()


@pytest.mark.more
def test_opengl_3_3_suffices(older_opengl):
    code = "from tests.engine import test_ray_intervals\ntest_ray_intervals.draw_all(ctx, camera)"
    run_elsewhere(older_opengl, "3.3", code)


def test_pictures_that_do_not_wait_are_right_some_later(gl, cutter, camera, shells):
    """Shells are one deep from the side that cuts them, and many from the other; so are spheres in a row."""
    row = regions.Sphere((0, -80, 0), 3)
    for y in np.linspace(-72, 80, 20):
        row = row | regions.Sphere((0, y, 0), 3)
    within = View(SIZE, camera(SIZE, eye=(0, -1, 0), target=(0, 100, 0), near=1.0, far=300.0, angle=60))
    along = View(SIZE, camera(SIZE, eye=(0, -200, 1), angle=15))
    for region in (shells, row):
        cutter.release()
        first, second = (replace(view, region=region) for view in (within, along))
        cutter.prepare(first, ORIGIN, SCALE, TOP)
        layers = cutter.layers
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(Squares, "ask", None)  # would wait
            for _ in range(6):  # each asks for no more than twice as many
                cutter.prepare(replace(first, waits=False), ORIGIN, SCALE, TOP)
                cutter.prepare(replace(second, waits=False), ORIGIN, SCALE, TOP)
                gl.finish()
        assert cutter.layers > layers
        patch = cutter.prepare
        cutter.prepare = lambda view, *box: patch(replace(view, waits=False), *box)  # noqa: B023
        try:
            check(gl, cutter, region, along, rounds=1)
        finally:
            del cutter.prepare
        check(gl, cutter, region, along, rounds=1)
