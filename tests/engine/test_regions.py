"""Classification of balls and capsules in GLSL against `contains` on the positions in them."""

import moderngl
import numpy as np
import pytest

from pvfiblets import regions
from pvfiblets.engine.errors import GPUMemoryError
from pvfiblets.engine.fiblets.data.chunks import storage_buffer
from pvfiblets.engine.fiblets.pipelines import CONSTANTS
from pvfiblets.engine.gl.bindings import BLOCKS
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.passes import nowhere
from pvfiblets.engine.gl.shaders import assemble
from pvfiblets.engine.regions.uniform_block import REGIONS_BLOCK, FieldTextures, RegionBlock, region_block

from .region_shapes import NAMES, made, torus

COMPUTE = """
#version 430
layout(local_size_x = 64) in;
#include "regions/classify.glsl"
layout(std430, binding = 0) readonly buffer In { vec4 capsules[]; };
layout(std430, binding = 1) writeonly buffer Out { int sides[]; };
uniform uint count;
void main() {
    uint k = gl_GlobalInvocationID.x;
    if (k < count) sides[k] = region_of_capsule(capsules[2u * k].xyz, capsules[2u * k + 1u].xyz, capsules[2u * k].w);
}
"""
VERTEX = """
#version 430
#include "regions/classify.glsl"
in vec4 a;
in vec4 b;
flat out int side;
void main() { side = region_of_capsule(a.xyz, b.xyz, a.w); }
"""


def classified(gl, region, a, b, radii, *, origin=(0.0, 0.0, 0.0), version=430):
    """What a shader says of capsules given in data mm, where local 0 is at ``origin``."""
    block = RegionBlock(gl, GLExtras(gl))
    to_data = np.eye(4)
    to_data[:3, 3] = origin
    block.write(region, to_data)
    rows = np.zeros((len(a), 2, 4), "<f4")
    rows[:, 0, :3], rows[:, 1, :3], rows[:, 0, 3] = a - np.asarray(origin), b - np.asarray(origin), radii
    data, out = storage_buffer(gl, rows, "capsules"), gl.buffer(reserve=4 * len(a))
    if version >= 430:
        program = gl.compute_shader(assemble("test", block.features, CONSTANTS, source=COMPUTE))
        block.bind(program)
        program["count"] = len(a)
        data.bind_to_storage_buffer(0)
        out.bind_to_storage_buffer(1)
        program.run(-(-len(a) // 64))
        gl.memory_barrier(moderngl.ALL_BARRIER_BITS)
        array = None
    else:
        source = assemble("test", block.features, CONSTANTS, source=VERTEX, version=version)
        program = gl.program(vertex_shader=source, varyings=["side"])
        program["Regions"].binding = BLOCKS["Regions"]
        block.bind(program)
        array = gl.vertex_array(program, [(data, "4f 4f", "a", "b")])
        with nowhere(gl, GLExtras(gl)):
            array.transform(out, moderngl.POINTS, vertices=len(a))
    found = np.frombuffer(out.read(), "<i4").copy()
    for thing in (array, program, data, out, block):
        if thing is not None:
            thing.release()
    return found


def capsules(n, *, seed=0, spread=1.0):
    """Capsules of all sizes; a third of them balls, a third of those points."""
    rng = np.random.default_rng(seed)
    a = rng.uniform(-spread, spread, (n, 3))
    b = a + rng.normal(0, 1, (n, 3)) * spread * 10.0 ** rng.uniform(-3, -0.3, (n, 1))
    b[::3] = a[::3]
    radii = spread * 10.0 ** rng.uniform(-4, -0.5, n)
    radii[::9] = 0.0
    return a, b, radii


def within(a, b, radii, count, rng):
    """Positions in each capsule, float64, on its surface for the most part; the ends and the middle among them."""
    t = rng.uniform(0, 1, (len(a), count, 1))
    t[:, :3, 0] = 0.0, 1.0, 0.5
    d = rng.normal(0, 1, (len(a), count, 3))
    d /= np.linalg.norm(d, axis=2, keepdims=True)
    return a[:, None] + t * (b - a)[:, None] + 0.999999 * radii[:, None, None] * d


@pytest.mark.few(12)
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("centre", "size"), [(0.0, 1.0), (1e6, 100.0), (-3e4, 1e-3)])
def test_never_against_what_is_in_it(gl, name, centre, size):
    at = np.array([centre, -centre, centre / 2])
    region = made(at, size)[name]
    a, b, radii = capsules(2000, spread=0.6 * size)
    found = classified(gl, region, a + at, b + at, radii, origin=at)
    rng = np.random.default_rng(1)
    for _ in range(2):
        inside = region.contains((within(a, b, radii, 12, rng) + at).reshape(-1, 3)).reshape(len(a), -1)
        assert not (found == 1)[~inside.all(axis=1)].any()
        assert not (found == -1)[inside.any(axis=1)].any()


@pytest.mark.parametrize("name", NAMES)
def test_decides_what_lies_clear(gl, name):
    region = made(size=100.0)[name]
    rng = np.random.default_rng(2)
    points = rng.uniform(-60, 60, (1500, 3))
    inside = region.contains(points)
    # Nothing changes within 8 mm in 80 directions: a capsule of a mm must be sure.
    directions = rng.normal(0, 1, (80, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    around = np.concatenate([directions * r for r in (2.0, 5.0, 8.0)])
    every = region.contains((points[:, None] + around).reshape(-1, 3)).reshape(len(points), -1)
    clear = (every == inside[:, None]).all(axis=1)
    assert clear.sum() > 50
    found = classified(gl, region, points[clear], points[clear] + 0.5, np.full(clear.sum(), 0.5))
    share = (found == np.where(inside[clear], 1, -1)).mean()
    assert share > (0.8 if "label" in name or "mesh" in name or "torus" in name else 0.98)


@pytest.mark.parametrize("name", NAMES)
def test_older_glsl_says_the_same(gl, name):
    region = made(size=10.0)[name]
    a, b, radii = capsules(2000, seed=3, spread=6.0)
    newer, older = (classified(gl, region, a, b, radii, version=version) for version in (430, 330))
    # Compilers may round differently; what is sure may then be undecided, never the opposite.
    assert (newer == older).mean() > 0.999
    assert (newer * older >= 0).all()


def test_where_it_is_decided_as_on_the_cpu(gl):
    from pvfiblets.query.regions.classify import classify

    for name, region in made(size=50.0).items():
        a, _, radii = capsules(3000, seed=4, spread=40.0)
        found, other = classified(gl, region, a, a, radii), classify(region, a, radii)
        assert (found * other >= 0).all(), name
        assert ((found == 0) <= (other == 0) + (radii < 1e-2)).mean() > 0.95, name


def test_deep_expressions(gl):
    parts = [regions.Sphere((x, y, 0.1 * x * y), 0.9) for y in range(-2, 2) for x in range(-2, 2)]
    for join in (lambda p, q: p - q, lambda p, q: p | q, lambda p, q: ~p & ~q, lambda p, q: ~(p & q)):
        parts = [join(p, q) for p, q in zip(parts[::2], parts[1::2], strict=True)]
    (region,) = parts
    a, b, radii = capsules(6000, seed=5, spread=3.0)
    found = classified(gl, region, a, b, radii)
    inside = region.contains(within(a, b, radii, 64, np.random.default_rng(6)).reshape(-1, 3)).reshape(len(a), -1)
    assert (found > 0).sum() > 20
    assert inside[found > 0].all()
    assert not inside[found < 0].any()


@pytest.mark.parametrize(
    "region",
    [regions.Sphere((0, 0, 0), 1e-37), regions.Box(center=(0, 0, 0), size=1e-35), regions.Sphere((1e35, 0, 0), 1e-2)],
    ids=["tiny sphere", "tiny box", "far sphere"],
)
def test_what_float32_cannot_hold_is_never_sure(gl, region):
    a = np.zeros((3, 3))
    assert (classified(gl, region, a, a, np.array([0.0, 1.0, 1e20])) == 0).all()


def test_what_is_not_a_number_is_undecided(gl):
    region = regions.Sphere((0, 0, 0), 1.0) & ~regions.Box(center=(5, 5, 5), size=1)
    a = np.array([[np.nan, 0, 0], [0, 0, 0], [0, 0, 0]])
    b = np.array([[0, 0, 0.0], [np.inf, 0, 0], [0, 0, 0]])
    assert (classified(gl, region, a, b, np.array([0.1, 0.1, np.nan])) == 0).all()


def test_block_is_what_the_shader_declares(gl):
    source = assemble("test", (), CONSTANTS, source=COMPUTE)
    program = gl.compute_shader(source)
    assert program["Regions"].size == REGIONS_BLOCK.nbytes
    assert len(region_block(regions.Sphere((0, 0, 0), 1), np.eye(4))) == REGIONS_BLOCK.nbytes
    program.release()


def test_fields_are_copied_once_and_go_with_the_region(gl):
    points, triangles = torus(3.0, 1.0)
    mesh = regions.Surface(points, triangles)
    block = RegionBlock(gl, GLExtras(gl))
    block.write(mesh | regions.Sphere((0, 0, 0), 1), np.eye(4))
    assert block.features == ("CLIP_REGION", "REGION_FIELDS")
    texture, nbytes = block._textures._texture, block.nbytes
    assert nbytes == REGIONS_BLOCK.nbytes + mesh.field.values.nbytes
    move = np.eye(4)
    move[0, 3] = 2.0
    block.write(mesh.moved(move) & mesh, np.eye(4))
    assert block._textures._texture is texture
    block.write(regions.Sphere((0, 0, 0), 1), np.eye(4))
    assert block.features == ("CLIP_REGION",)
    assert block.nbytes == REGIONS_BLOCK.nbytes
    block.release()
    block.release()
    assert block.nbytes == 0


@pytest.mark.more
def test_many_fields_share_a_texture(gl):
    points, triangles = torus(1.0, 0.4)
    rng = np.random.default_rng(7)
    meshes = [regions.Surface(points * (1 + 0.1 * k) + rng.uniform(-8, 8, 3), triangles) for k in range(32)]
    region = meshes[0]
    for mesh in meshes[1:]:
        region = region | mesh
    a, b, radii = capsules(3000, seed=8, spread=9.0)
    found = classified(gl, region, a, b, 0.1 * radii)
    inside = region.contains(within(a, b, 0.1 * radii, 16, rng).reshape(-1, 3)).reshape(len(a), -1)
    assert (found > 0).sum() > 10
    assert inside[found > 0].all()
    assert not inside[found < 0].any()


def test_fields_in_stacks_side_by_side(gl):
    fields = [regions.Surface(*torus(size, 0.4)).field for size in np.linspace(1.0, 2.0, 10)]
    textures = FieldTextures(gl, 150)
    textures.update(fields)
    size = textures._texture.size
    whole = np.frombuffer(textures._texture.read(), "<f4").reshape(size[::-1])
    assert len({corner[0] for corner in textures.corners}) > 1
    for field, (x, y, z) in zip(fields, textures.corners, strict=True):
        nz, ny, nx = field.values.shape
        assert (whole[z : z + nz, y : y + ny, x : x + nx] == field.values).all()
    textures.release()
    with pytest.raises(GPUMemoryError, match="fewer or smaller label volumes"):
        FieldTextures(gl, 100).update(fields)
