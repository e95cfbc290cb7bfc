"""Both ways to decode in GLSL against the codec's float64 reference."""

from types import SimpleNamespace

import moderngl
import numpy as np
import pytest

from pvfiblets.codec import layout
from pvfiblets.codec.encoding.compress import compress
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data.chunks import storage_buffer
from pvfiblets.engine.frame import FRAME_BLOCK
from pvfiblets.engine.gl.shaders import assemble
from pvfiblets.report.studies.decode import reference
from pvfiblets.synthetic.trackers import tracked_streamlines

SEQUENTIAL = """
#version 430
layout(local_size_x = 64) in;
#include "frame/groups.glsl"
#include "fiblets/decode/sequential.glsl"
layout(std430, binding = 5) writeonly buffer Out { float points[]; };
void put(uint f, uint i) { for (int a = 0; a < 3; ++a) points[(f * 64u + i) * 3u + a] = walk_point[a]; }
void main() {
    uint f = group_index() * 64u + gl_LocalInvocationIndex;
    if (f >= chunk_fiblets) return;
    walk_begin(f);
    put(f, 0u);
    for (uint i = 1u; i <= walk.last; ++i) { walk_next(i); put(f, i); }
}
"""
PARALLEL = """
#version 430
layout(local_size_x = 32) in;
#include "frame/groups.glsl"
#include "fiblets/decode/parallel.glsl"
layout(std430, binding = 5) writeonly buffer Out { float points[]; };
void main() {
    uint f = group_index();
    if (f >= chunk_fiblets) return;
    decode_together(f);
    for (uint i = gl_LocalInvocationIndex; i < 60u; i += 32u)
        for (int a = 0; a < 3; ++a) points[(f * 64u + i) * 3u + a] = prefix_point[i][a];
}
"""


def decoded_by_shader(gl, fiblets, source, threads):
    """(n_fiblets, 64, 3) positions relative to the anchor integers' origin, by one of the two programs."""
    renderer = FibletRenderer(gl, fiblets)
    # A view whose reference is anchor 0, or close: what comes back is then relative to `origin` exactly.
    renderer.render(View((8, 8), np.diag([1e-9, 1e-9, 1e-9, 1.0])), FibletStyle(tolerance=0.0))
    program = gl.compute_shader(assemble("test", renderer._decoding_features(), source=source))
    out = storage_buffer(gl, np.zeros((fiblets.n_fiblets, 64, 3), np.float32), "points")
    FRAME_BLOCK.write(renderer._shared.buffers["frame"], reference=(0, 0, 0))
    (chunk,) = renderer._chunks
    chunk.bind_storage()
    renderer._shared.bind()
    out.bind_to_storage_buffer(5)
    program.run(-(-fiblets.n_fiblets // threads))
    gl.memory_barrier(moderngl.ALL_BARRIER_BITS)
    points = np.frombuffer(out.read(fiblets.n_fiblets * 64 * 12), "<f4").reshape(-1, 64, 3)
    out.release()
    program.release()
    renderer.release()
    return points.astype(np.float64)


def decoded_by_reference(fiblets, f):
    """Points of one fiblet relative to the origin, and its step (mm)."""
    unpack = {name: int(layout.unpack(name, getattr(fiblets, field.array)[f])) for name, field in layout.FIELDS.items()}
    base = fiblets.pages[f >> layout.PAGE_BITS]
    anchor = np.array([unpack["anchor_x"], unpack["anchor_y"], unpack["anchor_z"]], float)
    if fiblets.anchors_low is not None:
        anchor = anchor * 65536 + fiblets.anchors_low[f]
    anchor *= fiblets.anchor_scale
    count, kind = unpack["last"] + 1, unpack["kind"]
    codes = np.asarray(fiblets.codes[base[1] + unpack["code"] :][:256])
    if kind == layout.Kind.DIRECTION:
        step = fiblets.step_lo + unpack["step"] * (fiblets.step_hi - fiblets.step_lo) / layout.STEP_LEVELS
        return reference.decode_direction(anchor, unpack["shape"], step, unpack["cap"], codes, count), step
    edge = fiblets.lattice * 0.5 ** unpack["cap"]
    if kind == layout.WIDE and unpack["step"] & 7 == layout.SPLINE:
        points = reference.decode_spline(anchor, unpack["shape"], unpack["step"] >> 3, edge, codes, count)
        return points, np.linalg.norm(np.diff(points, axis=0), axis=1).mean()
    points = reference.decode_lattice(anchor, kind, unpack["shape"], unpack["step"], edge, codes, count)
    return points, np.linalg.norm(np.diff(points, axis=0), axis=1).mean() if count > 1 else 1.0


def random_directions(n, rng):
    """Fiblets of random first directions and codes at every cap angle: nothing a tractogram would hold is gentler."""
    last = rng.integers(0, 60, n)
    last[: n // 2] = 59
    lengths = np.maximum(last - 1, 0)
    starts = np.cumsum(lengths) - lengths
    shape = rng.integers(0, 2**32, n)
    shape[:4] = 0, 32767, 32767 << 16, 0x8001  # the four corners and the centre of the fold
    anchors = layout.pack(
        "anchors", **{f"anchor_{a}": rng.integers(0, 65536, n) for a in "xyz"}, rank=np.arange(n), begin=1, end=1
    )
    decoding = layout.pack(
        "decoding", shape=shape, code=starts, step=rng.integers(0, 1024, n), point=np.cumsum(last + 1) - last - 1,
        last=last, cap=np.arange(n) % 16, kind=0,
    )  # fmt: skip
    return SimpleNamespace(
        anchors=anchors,
        decoding=decoding,
        reach=np.full(n, 65535, np.uint16),
        ends=np.zeros(n, np.uint32),
        parameters=SimpleNamespace(end_scale=1.0, largest_radius=65535.0),
        codes=rng.integers(0, 256, int(lengths.sum()), np.uint8),
        pages=np.array([[0, 0, 0], [n, lengths.sum(), (last + 1).sum()]]),
        anchors_low=None,
        rank_to_id=None,
        origin=np.array([-70.0, -100.0, -60.0]),
        anchor_scale=np.array([140.0, 180.0, 120.0]) / 65535,
        step=1.0,
        step_lo=0.1,
        step_hi=1.0,
        lattice=1.0,
        reach_scale=1.0,
        per_point={},
        n_fiblets=n,
    )


def assert_points_agree(fiblets, points):
    """Within 1e-3 step at every point of every fiblet."""
    worst = 0.0
    for f in range(fiblets.n_fiblets):
        expected, step = decoded_by_reference(fiblets, f)
        worst = max(worst, np.linalg.norm(points[f, : len(expected)] - expected, axis=1).max() / step)
    assert worst < 1e-3, f"{worst:.2e} steps"
    assert worst > 0.0  # float32 cannot be exact: zero would mean that nothing was compared


@pytest.mark.few(1)
@pytest.mark.parametrize(("source", "threads"), [(SEQUENTIAL, 64), (PARALLEL, 1)], ids=["sequential", "parallel"])
def test_direction_codes_decode_like_the_reference(gl, source, threads):
    fiblets = random_directions(800, np.random.default_rng(1))
    assert_points_agree(fiblets, decoded_by_shader(gl, fiblets, source, threads))


@pytest.mark.few(2)
@pytest.mark.parametrize("algorithm", ["iFOD1", "SD_STREAM"])
@pytest.mark.parametrize(("source", "threads"), [(SEQUENTIAL, 64), (PARALLEL, 1)], ids=["sequential", "parallel"])
def test_splines_decode_like_the_reference(gl, algorithm, source, threads):
    lines = tracked_streamlines(algorithm, 12, 0.1)
    fiblets = compress(lines, exact=False, effort="small")
    kinds = layout.coded_kind(fiblets.decoding)
    assert (kinds == layout.SPLINE).mean() > 0.7
    assert_points_agree(fiblets, decoded_by_shader(gl, fiblets, source, threads))


@pytest.mark.few(3)
@pytest.mark.parametrize("kind", [1, 2, 3, 4])
@pytest.mark.parametrize("low", [False, True], ids=["anchors16", "anchors32"])
@pytest.mark.parametrize(("source", "threads"), [(SEQUENTIAL, 64), (PARALLEL, 1)], ids=["sequential", "parallel"])
def test_lattice_codes_decode_like_the_reference(gl, random_lines, fabricate, kind, low, source, threads):
    fiblets = fabricate(random_lines(40, seed=kind), kind=kind, low=low, halvings=2)
    assert_points_agree(fiblets, decoded_by_shader(gl, fiblets, source, threads))
