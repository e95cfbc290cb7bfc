"""Small sets are coded by NumPy alone, to the same bits as by compiled kernels, and without numba."""

import dataclasses
import logging
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pvfiblets as pf
from pvfiblets.codec import small_sets
from pvfiblets.streamlines import Streamlines

from .coders import coded_by
from .samples import extremes, noisy, smooth, wandering

ARRAYS = ("anchors", "decoding", "reach", "codes", "ends", "anchors_low", "pages", "rank_to_id")
SAMPLES = {"smooth": smooth(8, 130), "noisy": noisy(8, 130), "wandering": wandering(12), **extremes()}


def assert_same(lines, **options):
    """Compress and decompress in both ways."""
    found = {}
    for way in ("kernels", "NumPy"):
        with coded_by(way):
            fiblets = pf.compress(lines, **options)
            found[way] = fiblets, [fiblets.decompress(dtype=kind).points for kind in (np.float32, np.float64)]
    (ours, our_points), (wanted, wanted_points) = found["NumPy"], found["kernels"]
    assert ours.parameters == wanted.parameters
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(ours, name), getattr(wanted, name), name)
    for mine, theirs in zip(our_points, wanted_points, strict=True):
        np.testing.assert_array_equal(mine, theirs)


@pytest.mark.few(3)
@pytest.mark.parametrize("name", SAMPLES)
def test_numpy_writes_the_kernels_codes(name):
    assert_same(SAMPLES[name])
    assert_same(SAMPLES[name], max_angle=0.5)
    assert_same(SAMPLES[name], max_angle=None)


@pytest.mark.parametrize(
    "name", ["dipy_EuDX_small_25.trk", "trxpy_small.trx", "trxrs_tinytrack_small.tt.gz", "vtk_track1.binary.vtk"]
)
def test_numpy_writes_the_kernels_codes_on_real_files(shared_data, name):
    lines = pf.read(shared_data / name)
    assert_same(lines[:200])
    assert_same(lines[:100], max_error=0.02, max_angle=2.0)


@pytest.mark.more
@settings(max_examples=25)
@given(st.data())
def test_numpy_writes_the_kernels_codes_for_any_lines(data):
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    counts = data.draw(st.lists(st.integers(0, 130), min_size=1, max_size=6))
    spread, uneven = data.draw(st.floats(0.0, 2.0)), data.draw(st.sampled_from([0.0, 1e-5, 0.03, 0.5]))
    lines = []
    for n in counts:
        steps = np.array([1.0, 0.0, 0.0]) + spread * rng.normal(size=(n, 3))
        steps *= (1.0 + uneven * rng.normal(size=(n, 1))) / np.maximum(np.linalg.norm(steps, axis=1), 1e-9)[:, None]
        lines.append(np.cumsum(steps, axis=0) + rng.uniform(-50, 50, 3))
    kind = data.draw(st.sampled_from([np.float32, np.float64]))
    made = Streamlines.from_list(lines)
    assert_same(
        Streamlines(made.points.astype(kind), made.offsets), max_error=data.draw(st.sampled_from([None, 0.01, 0.3]))
    )


@pytest.mark.parametrize("name", SAMPLES)
def test_numpy_decodes_exact_sets_as_kernels_do(name):
    fiblets = pf.compress(SAMPLES[name], exact=True)
    drawn = [decoded(fiblets, way) for way in ("kernels", "NumPy")]
    np.testing.assert_array_equal(drawn[0][0], drawn[1][0])
    assert drawn[0][1] == drawn[1][1] == ""


@pytest.mark.parametrize("exact", [False, True])
def test_damaged_records_are_left_out_alike(exact):
    fiblets = pf.compress(Streamlines.concatenate([smooth(3, 130), wandering(3)]), exact=exact)
    rng = np.random.default_rng(0)
    for _ in range(30):
        decoding, codes = fiblets.decoding.copy(), fiblets.codes.copy()
        some = rng.integers(len(decoding), size=3)
        decoding[some] = rng.integers(0, 2**32, (3, 3), np.uint64)
        codes[rng.integers(len(codes), size=20)] = rng.integers(256, size=20)
        damaged = dataclasses.replace(fiblets, decoding=decoding, codes=codes)
        said = {way: decoded(damaged, way) for way in ("kernels", "NumPy")}
        np.testing.assert_array_equal(said["NumPy"][0], said["kernels"][0])
        assert said["NumPy"][1] == said["kernels"][1]


def decoded(fiblets, way):
    """Points, zeros where there are none, and what the error says."""
    from pvfiblets.codec.decompress import decode_fiblets

    points = np.zeros((60 * fiblets.n_fiblets + 60, 3))
    starts = np.arange(fiblets.n_fiblets) * 60
    try:
        with coded_by(way):
            decode_fiblets(fiblets, np.arange(fiblets.n_fiblets)[::-1].copy(), starts, points)
    except pf.FormatError as error:
        return np.zeros(0), str(error)  # what else was written depends on the order
    return points, ""


@pytest.mark.more
def test_small_sets_are_shown_and_decoded_without_a_compiler(tmp_path):
    script = tmp_path / "small.py"
    script.write_text(
        "import sys\nimport numpy as np\nimport pyvista as pv\n"
        "lines = [np.cumsum(np.full((40, 3), 0.1 * i), axis=0) for i in range(1, 15)]\n"
        "plotter = pv.Plotter(off_screen=True, window_size=(40, 30))\n"
        "actor = plotter.add_fiblets(lines)\n"
        "actor.fiblets.decompress()\n"
        "assert 'numba' not in sys.modules, 'numba'\n"
        "assert 'scipy' not in sys.modules, 'scipy'\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(Path(pf.__file__).parents[1])}
    done = subprocess.run([sys.executable, str(script)], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("points", "spent", "loaded", "filled", "small"),
    [
        (100_000, 0.0, False, True, True),  # sooner than kernels load
        (400_000, 0.0, False, True, False),
        (400_000, 0.0, False, False, True),  # sooner than they are compiled
        (4_000_000, 0.0, False, False, False),
        (1000, 1.0, False, True, False),  # what has been spent would have loaded them
        (1000, 0.0, True, True, False),
    ],
)
def test_kernels_are_loaded_for_what_takes_longer(monkeypatch, points, spent, loaded, filled, small):
    state = small_sets.State(spent, loaded)
    monkeypatch.setitem(small_sets.STATES, "coding", state)
    monkeypatch.setattr(small_sets, "is_filled", lambda _: filled)
    marked = []
    monkeypatch.setattr(small_sets, "mark_filled", marked.append)
    begin = time.thread_time()
    with small_sets.without_kernels("coding", points) as said:
        assert said == small
        while time.thread_time() < begin + 0.01:
            pass
    assert (state.spent >= spent + 0.009) == small
    assert state.loaded == (loaded or not small)
    assert marked == (["coding"] if not small and not loaded else [])


def test_compilation_is_reported_and_waiting_is_not(caplog, monkeypatch):
    from pvfiblets.codec import jit

    monkeypatch.setattr(jit, "NOTICED", 0.02)
    monkeypatch.setattr(jit, "NOTICE", jit._Notice())
    with caplog.at_level(logging.WARNING):
        assert jit.NOTICE._timer is None  # nothing runs that would tell
        # As if nothing had ever been compiled, twice.
        monkeypatch.setattr(jit.FunctionCache, "load_overload", lambda *_: None)
        monkeypatch.setattr(jit.FunctionCache, "save_overload", lambda *_: None)
        assert jit.kernel(_slow(1))(2) == 3
        assert jit.kernel(_slow(2))(2) == 4
    assert [record.getMessage() for record in caplog.records] == [
        "compiling kernels with numba: once per machine, up to a minute"
    ]


def _slow(more):
    return lambda x: x + more
