"""Boundaries of regions along rays, against the exact regions: random depths of every pixel, in float64."""

from __future__ import annotations

import itertools

import moderngl
import numpy as np
import pytest
import pyvista as pv

from pvfiblets import regions
from pvfiblets.engine.cutting import Cutter
from pvfiblets.engine.errors import EngineError
from pvfiblets.engine.opengl import OpenGL
from pvfiblets.engine.pipelines import CONSTANTS
from pvfiblets.engine.shaders import Programs, assemble
from pvfiblets.engine.view import View

SIZE = (120, 90)
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
    functions, programs = OpenGL(gl), Programs(gl, CONSTANTS)
    made = Cutter(gl, functions, programs)
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
        with OpenGL(gl).framebuffers_kept():
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
    mesh = mesh.compute_normals(cell_normals=True, point_normals=False, auto_orient_normals=True, consistent_normals=True)
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
    "deep": ((BALL - TURNED) | (BOX & TURNED)) & ~regions.Sphere((0, -20, 0), 18) | regions.Plane((0, 0, -1), (0, 0, -55)),
}


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
            check(gl, cutter, region, view, rounds=2)


def test_compute_shaders_say_the_same(gl, cutter, camera, torus):
    view = View(SIZE, camera(SIZE))
    check(gl, cutter, torus - BOX, view, compute=True)
