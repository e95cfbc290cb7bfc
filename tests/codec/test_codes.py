"""Compiled kernels against the literal reference, bit for bit; promises and figures on real and made-up lines."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pvfiblets as pf
from pvfiblets.codec.encoding.compress import split_chunks
from pvfiblets.codec.layout import DIRECTION, MAX_POINTS, SPLINE, WIDE, coded_kind, unpack
from pvfiblets.report.studies.decode.reference import decode_direction, decode_lattice, decode_spline
from pvfiblets.streamlines import Streamlines
from pvfiblets.synthetic.trackers import tracked_streamlines

from . import reference
from .samples import extremes, noisy, smooth, wandering
from .turn_reference import cut as reference_cut
from .turn_reference import may_turn


def pixel_of(fiblets):
    bounds = np.array(fiblets.bounds)
    return float(np.linalg.norm(bounds[1::2] - bounds[::2])) / 2000.0


def reference_slot(line, first, count, fiblets):
    """What the encoder must write for one cut of at most 60 points of a streamline, by the reference alone."""
    p = fiblets.parameters
    turns = may_turn(line, pixel_of(fiblets), 10.0)[first : first + count]
    points = line[first : first + count + 1] - fiblets.origin
    scale = fiblets.anchor_scale
    top = 2.0**p.anchor_bits - 1
    grid = np.divide(points, scale, out=np.zeros_like(points), where=scale > 0)
    anchors = scale * np.clip(np.rint(grid), 0, top)
    points = points[:count]
    following = anchors[count] if len(anchors) > count else None
    if len(points) > 1:
        best = None
        step, length = reference.choose_step(points, p.step_lo, p.step_hi)
        smallest = reference.choose_cap(points)
        for cap in range(smallest, min(smallest + 3, 16)):
            piece = reference.encode_direction(points, anchors[0], step, length, cap)
            if piece.error <= p.budget and (best is None or piece.error < best.error):
                best = piece
            if best is not None and best.error <= 0.5 * p.budget:
                break
        if best is not None and turns.excess(best.points, following) <= 1.0:
            return [best]
    pieces, a = [], 0
    for count in reference.plan_lattice(points, anchors, p.lattice, turns):
        b = a + count
        after = anchors[b] if b < len(anchors) else None
        pieces.append(reference.encode_lattice(points[a:b], anchors[a], p.lattice, turns[a:b], after))
        a = b
    return pieces


def assert_matches_reference(streamlines, fiblets, most=60):
    starts, counts = fiblets.fiblet_points(), fiblets.fiblet_counts()
    code_at = unpack("code", fiblets.decoding) + fiblets._base(1)
    where = {int(s): f for f, s in enumerate(starts)}
    cuts = []
    for s, e in zip(streamlines.offsets[:-1].tolist(), streamlines.offsets[1:].tolist(), strict=True):
        if e > s:
            begins = [0]
            if e - s > MAX_POINTS:
                line = streamlines.points[s:e].astype(np.float64)
                begins = reference_cut(may_turn(line, pixel_of(fiblets), 10.0), 10.0)
            cuts += [(s, e, a, b - a) for a, b in pairwise([*begins, e - s])]
    chosen = np.random.default_rng(0).permutation(len(cuts))[:most]
    for s, e, first, count in (cuts[c] for c in chosen):
        line, a = streamlines.points[s:e].astype(np.float64), s + first
        for piece in reference_slot(line, first, count, fiblets):
            f = where[a]
            assert counts[f] == len(piece.points)
            words = {name: int(unpack(name, fiblets.decoding)[f]) for name in ("shape", "step", "cap", "kind")}
            kind = getattr(piece, "kind", DIRECTION)
            assert words == {"shape": piece.shape, "step": piece.step, "cap": piece.cap, "kind": kind}
            codes = fiblets.codes[code_at[f] : code_at[f] + len(piece.codes)]
            np.testing.assert_array_equal(codes, piece.codes)
            a += len(piece.points)


SAMPLES = {"smooth": smooth, "noisy": noisy, "wandering": wandering}


@pytest.mark.few(2)
@pytest.mark.parametrize("name", SAMPLES)
def test_kernels_write_the_references_codes(name):
    streamlines = SAMPLES[name]()
    assert_matches_reference(streamlines, pf.compress(streamlines))


@pytest.mark.few(2)
@pytest.mark.parametrize(
    "name",
    [
        "dipy_tracks300.trk",
        "nv_stroke.trk.gz",
        "trxpy_small.trx",
        "gen_fibercup_det_0.25mm.tck",
        "trxrs_tinytrack_small.tt.gz",
    ],
)
def test_kernels_write_the_references_codes_on_real_files(shared_data, name):
    streamlines = pf.read(shared_data / name)
    streamlines = streamlines[:: 1 + streamlines.n_points // 20_000]  # the reference is slow
    assert_matches_reference(streamlines, pf.compress(streamlines))


def decode_by_reference(fiblets):
    """All points, decoded by the reference from the records."""
    out = np.empty((fiblets.n_points, 3))
    p = fiblets.parameters
    for f in range(fiblets.n_fiblets):
        a, d = fiblets.anchors[f], fiblets.decoding[f]
        grid = np.array([unpack(f"anchor_{axis}", a) for axis in "xyz"], float)
        if fiblets.anchors_low is not None:
            grid = grid * 65536 + fiblets.anchors_low[f]
        n = int(unpack("last", d)) + 1
        at = int(unpack("code", d) + fiblets._base(1)[f])
        anchor, shape, step = fiblets.anchor_scale * grid, int(d[0]), int(unpack("step", d))
        cap, kind = int(unpack("cap", d)), int(unpack("kind", d))
        first = int(fiblets.fiblet_points()[f])
        codes = np.array(fiblets.codes[at:])
        if kind == DIRECTION:
            length = p.step_lo + step * (p.step_hi - p.step_lo) / 1023 if p.step_hi > p.step_lo else p.step_lo
            out[first : first + n] = decode_direction(anchor, shape, length, cap, codes, n)
        elif kind == WIDE and step & 7 == SPLINE:
            out[first : first + n] = decode_spline(anchor, shape, step >> 3, p.lattice * 0.5**cap, codes, n)
        else:
            out[first : first + n] = decode_lattice(anchor, kind, shape, step, p.lattice * 0.5**cap, codes, n)
    return out + fiblets.origin


@pytest.mark.parametrize("name", SAMPLES)
def test_kernels_decode_what_the_reference_decodes(name):
    fiblets = pf.compress(SAMPLES[name](10, 100))
    expected = decode_by_reference(fiblets)
    np.testing.assert_array_equal(fiblets.decompress(dtype=np.float64).points, expected)
    np.testing.assert_array_equal(fiblets.decompress(dtype=np.float32).points, expected.astype(np.float32))


@pytest.mark.parametrize("name", ["iFOD1", "iFOD2", "SD_STREAM", "EuDX"])
def test_splines_take_fewer_bytes_at_the_same_bounds(name):
    lines = tracked_streamlines(name, 30, 0.1)
    fast, small = (pf.compress(lines, exact=False, effort=e) for e in ("fast", "small"))
    small.verify()
    assert small.promise == fast.promise
    assert small.nbytes < 0.8 * fast.nbytes
    assert (coded_kind(small.decoding) == SPLINE).mean() > 0.9
    error = pf.measure_error(lines, small)
    assert error.max_mm <= small.promise
    np.testing.assert_allclose(small.decompress().lengths(), lines.lengths(), rtol=0.01)
    np.testing.assert_allclose(small.decompress(dtype=np.float64).points, decode_by_reference(small), atol=1e-9)


@pytest.mark.parametrize("name", extremes())
def test_splines_never_take_more_bytes(name):
    fast, small = (pf.compress(extremes()[name], exact=False, effort=e) for e in ("fast", "small"))
    assert small.nbytes <= fast.nbytes


def test_a_circle_takes_few_pieces():
    """A radian of 600 points: a cubic over 30 of them errs by far less than a tenth of a step."""
    angle = np.arange(600) / 600
    circle = 60.0 * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    fiblets = pf.compress(Streamlines.from_list([circle]), exact=False, effort="small")
    nodes = unpack("step", fiblets.decoding) >> 3
    assert (coded_kind(fiblets.decoding) == SPLINE).all()
    assert nodes.max() <= 3
    distance = np.linalg.norm(fiblets.decompress().points, axis=1) - 60.0
    assert abs(distance).max() <= fiblets.promise


@pytest.mark.few(7)
@pytest.mark.parametrize("effort", ["fast", "high", "small"])
@pytest.mark.parametrize("name", extremes())
def test_extreme_lines_keep_the_promise(name, effort):
    streamlines = extremes()[name]
    fiblets = pf.compress(streamlines, effort=effort)
    fiblets.verify()
    decoded = fiblets.decompress()
    np.testing.assert_array_equal(decoded.offsets, streamlines.offsets)
    assert np.isfinite(decoded.points).all()
    if streamlines.n_points:
        distance = np.linalg.norm(decoded.points.astype(float) - streamlines.points.astype(float), axis=1)
        assert distance.max() <= fiblets.promise
    error = pf.measure_error(streamlines, fiblets)
    assert error.max_mm <= fiblets.promise


@pytest.mark.more
@settings(max_examples=60)
@given(st.data())
def test_any_lines_keep_any_promise(data):
    seed = data.draw(st.integers(0, 2**32 - 1))
    rng = np.random.default_rng(seed)
    counts = data.draw(st.lists(st.integers(0, 150), min_size=1, max_size=5))
    scale = 10.0 ** data.draw(st.floats(-6, 6))
    spread = data.draw(st.floats(0, 2))
    steps = np.exp(spread * rng.normal(size=(sum(counts), 1)))
    points = scale * np.cumsum(steps * rng.normal(size=(sum(counts), 3)), axis=0)
    points += scale * data.draw(st.sampled_from([0.0, 1e3, -1e5]))
    streamlines = Streamlines(points, np.concatenate([[0], np.cumsum(counts)]))
    promise = data.draw(st.one_of(st.none(), st.floats(1e-3, 10).map(lambda v: v * scale)))
    effort = data.draw(st.sampled_from(["fast", "small"]))
    fiblets = pf.compress(streamlines, max_error=promise, effort=effort)
    if promise is not None:
        assert fiblets.promise == promise
    fiblets.verify()
    decoded = fiblets.decompress(dtype=np.float64)
    np.testing.assert_array_equal(decoded.offsets, streamlines.offsets)
    if len(points):
        assert np.linalg.norm(decoded.points - points, axis=1).max() <= fiblets.promise


@pytest.mark.more
def test_figures_on_smooth_and_noisy_constant_steps():
    """The issue's figures in steps (the paper: max 0.17, mean 0.05), at the bytes of a full fiblet.

    Each streamline adds the four bytes of its end vector, here to 240 points.
    """
    for lines, effort, largest, mean in (
        (smooth(200, 240), "fast", 0.07, 0.012),
        (noisy(200, 240), "fast", 0.07, 0.02),
        (smooth(60, 240), "high", 0.07, 0.009),
        (noisy(60, 240), "high", 0.07, 0.015),
    ):
        fiblets = pf.compress(lines, effort=effort)
        error = pf.measure_error(lines, fiblets)
        assert (unpack("kind", fiblets.decoding) == DIRECTION).all()
        assert error.max_steps <= largest
        assert error.mean_steps <= mean
        assert (fiblets.nbytes - fiblets.pages.nbytes - fiblets.ends.nbytes) / fiblets.n_points <= 1.34
        assert fiblets.ends.nbytes == 4 * len(lines)


def test_figures_on_real_tracking(shared_data):
    lines = pf.read(shared_data / "wholebrain_eudx_0.5mm_fifth.tck")
    fiblets = pf.compress(lines)
    error = pf.measure_error(lines, fiblets)
    assert error.max_steps <= 0.07
    assert error.mean_steps <= 0.012


def test_high_effort_is_better_than_fast():
    lines = noisy(40, 240)
    fast, high = (pf.measure_error(lines, pf.compress(lines, effort=e)) for e in ("fast", "high"))
    assert high.mean_mm < 0.9 * fast.mean_mm


def test_variable_steps_stay_below_their_bytes():
    lines = wandering(100, 60)
    # A tenth of the step; a 4000th of the diagonal, a third of that, without and with directions.
    for promise, angle, most in ((0.16, None, 2.7), (None, None, 3.8), (None, 10.0, 4.3)):
        fiblets = pf.compress(lines, max_error=promise, max_angle=angle)
        assert (fiblets.nbytes - fiblets.pages.nbytes) / fiblets.n_points <= most


@pytest.mark.parametrize("make", [smooth, wandering])
def test_six_point_streamlines_stay_below_half_of_float32(make):
    lines = make(200, 6)
    fiblets = pf.compress(lines, max_error=0.1 * lines.lengths().mean() / 5, max_angle=None)
    assert fiblets.nbytes - fiblets.pages.nbytes < 0.5 * lines.n_points * 12


def test_many_pages(monkeypatch):
    """More than one page of fiblets, in several chunks that begin inside pages."""
    n = 40_000
    rng = np.random.default_rng(5)
    points = np.cumsum(rng.normal(size=(n, 2, 3)), axis=1) + rng.uniform(-50, 50, (n, 1, 3))
    lines = Streamlines(points.reshape(-1, 3), np.arange(0, 2 * n + 1, 2))
    whole = pf.compress(lines)
    monkeypatch.setattr(split_chunks, "__defaults__", (12_345,))
    pieces = pf.compress(lines)
    assert whole.pages.shape == (4, 3)
    for name in ("anchors", "decoding", "reach", "codes", "ends", "pages"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(pieces, name))
    whole.verify()
    some = rng.permutation(n)[:100]
    chosen = whole.decompress(some)
    assert np.linalg.norm(chosen.points - lines[some].points, axis=1).max() <= whole.promise


def test_steps_of_one_fiblet_are_its_own():
    """A file whose streamlines differ in step by a few percent still takes one byte a point."""
    lines = Streamlines.concatenate([smooth(20, 120, step) for step in (0.49, 0.5, 0.515)])
    fiblets = pf.compress(lines)
    assert (unpack("kind", fiblets.decoding) == DIRECTION).all()
    assert pf.measure_error(lines, fiblets).max_mm <= fiblets.promise
