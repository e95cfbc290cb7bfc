"""`hidden()` of ``shaders/culling/hidden.glsl``, asked directly: never true of a capsule in which a line would show.

A compute program evaluates it for random capsules before a random depth image. Against it stand random chords of these
very capsules, projected in float32 as shaders do it, and drawn by the rule of thin lines or as round brushes: no pixel
of theirs may be as near as the image's.
"""

from types import SimpleNamespace

import moderngl
import numpy as np
import pytest

from pvfiblets.engine import FibletStyle, View
from pvfiblets.engine.culling import DepthPyramid
from pvfiblets.engine.fiblets.pipelines import CONSTANTS
from pvfiblets.engine.frame import FRAME_BLOCK, frame_block
from pvfiblets.engine.gl import shaders
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.shaders import Programs, assemble

from .cells import line_cells
from .pictures import EMPTY

PROGRAM = """
#version 430
layout(local_size_x = 64) in;
#include "culling/hidden.glsl"
layout(std430, binding = 5) buffer Cases { vec4 cases[]; };  // a and r, b and the answer
void main() {
    uint i = gl_GlobalInvocationID.x;
    vec4 a = cases[2u * i], b = cases[2u * i + 1u];
    cases[2u * i + 1u].w = float(hidden(Capsule(a.xyz, b.xyz, a.w, 0.0)));
}
"""
ORIGIN, SCALE, TOP = np.full(3, -100.0), np.full(3, 200.0 / 65535), 65535
VIEWS = {
    "perspective": {},
    "parallel": {"height": 150.0},
    "from inside": {"eye": (3, -2, 1), "target": (30, 10, 0), "near": 0.05, "far": 200.0, "angle": 80.0},
    "slab": {"eye": (170, -190, 120), "near": 280.0, "far": 280.3},
    "parallel slab": {"eye": (170, -190, 120), "near": 280.0, "far": 280.3, "height": 150.0},
}
MUTATIONS = {
    "the nearest depth instead of the farthest": ("key = max(key, texelFetch", "key = min(key - 1u, texelFetch"),
    "four loads that do not suffice": ("wanted > level ?", "false ?"),
    "half the radius": ("float away = r *", "float away = 0.5 * r *"),
    "no room for rounding": ("> away + slack", "> away - 10.0 * slack"),
    "no room around lines": ("+ half_line_width + MARGIN", ""),
    "no room for what leads a pixel back": ("m += overshoot;", ""),
}


class Projection:
    """A view as a shader has it: the uniform block, and float32 arithmetic in its order."""

    def __init__(self, view, style):
        self.block, _ = frame_block(view, style, ORIGIN, SCALE, TOP)
        frame = np.frombuffer(self.block, FRAME_BLOCK.dtype)[0]
        self.reference = ORIGIN + SCALE * frame["reference"]
        self.matrix = frame["window_from_local"]  # columns first

    def local(self, points):
        """(n, 3) float32 of data mm."""
        return (points - self.reference).astype(np.float32)

    def window(self, points):
        """(n, 4) float32 window coordinates of local ones."""
        x, y, z = np.asarray(points, np.float32).T[..., None]
        c = self.matrix[0] * x + self.matrix[1] * y + self.matrix[2] * z + self.matrix[3]
        return np.c_[c[:, :3] * (np.float32(1.0) / c[:, 3:]), c[:, 3:]]


def answers(gl, size, projection, depth, capsules):
    """(n,) bool: hidden, for capsules (n, 7) a, b, r in local mm, float32."""
    programs = Programs(gl, CONSTANTS)
    cases = np.zeros((-(-len(capsules) // 64) * 64, 8), np.float32)
    cases[: len(capsules), [0, 1, 2, 4, 5, 6, 3]] = capsules
    frame, buffer = gl.buffer(projection.block), gl.buffer(cases.tobytes())
    texture = gl.texture(size, 1, depth.astype("<u4").tobytes(), dtype="u4")
    texture.filter = moderngl.NEAREST, moderngl.NEAREST
    program = gl.compute_shader(assemble("test", (), CONSTANTS, source=PROGRAM))
    pyramid = DepthPyramid(gl, GLExtras(gl), programs)
    pyramid.build(SimpleNamespace(size=size, depth=texture))
    pyramid.bind(program)
    frame.bind_to_uniform_block(0)
    buffer.bind_to_storage_buffer(5)
    program.run(len(cases) // 64)
    gl.memory_barrier(moderngl.ALL_BARRIER_BITS)
    found = np.frombuffer(buffer.read(), np.float32).reshape(-1, 8)[: len(capsules), 7] > 0.5
    for thing in (frame, buffer, texture, program, pyramid, programs):
        thing.release()
    return found


def depth_image(rng, size):
    """(h, w) keys: panes at a few depths, rough, with holes; and the depths of the panes (h, w)."""
    w, h = size
    level = np.full((h, w), rng.uniform(0.3, 0.6))
    for _ in range(12):
        x, y = rng.integers(0, w), rng.integers(0, h)
        level[y : y + rng.integers(20, h), x : x + rng.integers(20, w)] = rng.uniform(0.2, 0.7)
    rough = level - rng.uniform(0.0, 10.0 ** rng.uniform(-7, -2, (h, w)))
    keys = (np.clip(rough, 0.0, 1.0) * 2**31).astype(np.uint32) << 1
    keys[rng.uniform(size=(h, w)) < 3e-4] = EMPTY
    return keys, level


def random_capsules(rng, n, matrix, size, level):
    """(n, 7) capsules of all sizes, most of them close behind a pane; in the picture or at its edges."""
    inverse = np.linalg.inv(matrix)
    at = rng.uniform(-0.02, 1.02, (n, 2)) * size
    cell = at.astype(int).clip(0, np.array(size) - 1)
    z = level[cell[:, 1], cell[:, 0]] + 10.0 ** rng.uniform(-7, -0.7, n) * rng.choice([1.0, 1.0, 1.0, -0.1], n)

    def point(at, z):
        p = np.c_[at / size * 2 - 1, 2 * z - 1, np.ones(n)] @ inverse.T
        return p[:, :3] / p[:, 3:]

    a = point(at, z)
    # the other end by pixels and depth: short or long, across or along the view
    b = point(
        at + rng.normal(0, 1, (n, 2)) * 10.0 ** rng.uniform(-1, 2.2, (n, 1)),
        z + 10.0 ** rng.uniform(-8, -0.7, n) * rng.choice([1.0, 1.0, -1.0], n),
    )
    r = np.linalg.norm(point(at + [1, 0], z) - a, axis=1) * 10.0 ** rng.uniform(-6, 0.7, n)
    b = np.where(rng.uniform(size=(n, 1)) < 0.1, a, b)
    return np.c_[a, b, r]


def chords(rng, capsule, matrix):
    """(m, 2, 3) ends of segments in a capsule: its own, and random ones, most as near to the viewer as may be."""
    a, b, r = capsule[:3], capsule[3:6], capsule[6]
    t = np.r_[0.0, 1.0, rng.uniform(0, 1, 22)]
    centre = a + t[:, None] * (b - a)
    w, z = (centre @ matrix[:3, row] + matrix[3, row] for row in (3, 2))
    nearer = -(matrix[:3, 2] * w[:, None] - matrix[:3, 3] * z[:, None])  # where depth falls fastest
    nearer /= np.linalg.norm(nearer, axis=1)[:, None]
    turn = rng.normal(0, 1, centre.shape)
    turn /= np.linalg.norm(turn, axis=1)[:, None]
    points = centre + r * np.where(rng.uniform(size=(len(t), 1)) < 0.7, nearer, turn)
    first, last = rng.integers(0, len(t), (2, 14))
    own = np.array([[a, b], [b, a], [points[0], points[1]], [points[1], points[0]]])
    return np.concatenate([own, np.stack([points[first], points[last]], axis=1)])


def shows(segments, projection, size, keys, half):
    """Whether any pixel of any segment is as near as the image, or nearer."""
    flat = projection.window(segments.reshape(-1, 3)).astype(float).reshape(-1, 2, 4)
    for a, b in flat:
        if half:
            x, y = np.floor(np.linspace(a[:2], b[:2], 24)).astype(int).T
            reach = int(half) + 1
            away = np.arange(-reach, reach + 1)
            x, y = x[:, None, None] + away, y[:, None, None] + away[:, None]
            x, y = np.broadcast_arrays(x, y)
            x, y = x.ravel(), y.ravel()
            run = (b - a)[:2]
            foot = ((np.c_[x, y] + 0.5 - a[:2]) @ run / max(run @ run, 1e-12)).clip(0.0, 1.0)
            close = np.linalg.norm(np.c_[x, y] + 0.5 - a[:2] - foot[:, None] * run, axis=1) <= half
            x, y, t = x[close], y[close], foot[close]
        else:
            p, q = np.floor([a[:2], b[:2]]).astype(int)
            if max(abs(p - q)) > 4 * max(size):
                continue
            at, t = line_cells(p, q)
            at, t = np.r_[at, [q]], np.r_[t, 1.0]
            x, y = at.T
        inside = (x >= 0) & (y >= 0) & (x < size[0]) & (y < size[1])
        z = a[2] + (b[2] - a[2]) * t[inside]
        kept = (z >= 0.0) & (z <= 1.0)
        if (np.floor(z[kept] * 2**31) * 2 <= keys[y[inside][kept], x[inside][kept]]).any():
            return True
    return False


def found_and_seen(gl, camera, size, name, width, rng, count=2000):
    """What hidden() says, and what chords of the capsules show: of all that it calls hidden, and of some others."""
    matrix = camera(size, **VIEWS[name])
    projection = Projection(View(size, matrix), FibletStyle(width))
    keys, level = depth_image(rng, size)
    capsules = random_capsules(rng, count, matrix, size, level)
    local = np.c_[projection.local(capsules[:, :3]), projection.local(capsules[:, 3:6]), capsules[:, 6]]
    local = local.astype(np.float32)
    found = answers(gl, size, projection, keys, local)
    half, exact = width / 2 * (width > 1), projection.matrix.astype(float)
    asked = found | (np.arange(count) < 300)
    seen = [shows(chords(rng, c, exact), projection, size, keys, half) for c in local[asked].astype(float)]
    return found[asked], np.array(seen)


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("width", [1.0, 5.0])
@pytest.mark.parametrize("name", VIEWS)
def test_nothing_that_would_show_is_hidden(gl, camera, name, width):
    rng = np.random.default_rng(sum(map(ord, name)) + int(width))
    for size in ((200, 150), (131, 257)):
        found, seen = found_and_seen(gl, camera, size, name, width, rng)
        assert not (found & seen).any()
        assert found.sum() > 100


@pytest.mark.exhaustive
@pytest.mark.parametrize("mutation", MUTATIONS)
def test_a_wrong_test_would_be_noticed(gl, camera, monkeypatch, mutation):
    honest, (right, wrong) = shaders.read_shader, MUTATIONS[mutation]
    assert right in honest("culling/hidden.glsl") + honest("culling/pyramid_lookup.glsl")
    monkeypatch.setattr(shaders, "read_shader", lambda name: honest(name).replace(right, wrong))
    noticed = 0
    for name in ("perspective", "parallel slab"):
        for width in (1.0, 5.0):
            found, seen = found_and_seen(gl, camera, (200, 150), name, width, np.random.default_rng(3), 1500)
            noticed += (found & seen).sum()
    assert noticed > 0
