"""Thousands of damaged files: an error of ours or a result, in bounded time and memory.

``PVFIBLETS_FUZZ=N`` makes N damaged files per format instead of a few hundred.
"""

from __future__ import annotations

import gzip
import os
import re
import tracemalloc
import warnings

import numpy as np
import pytest

from pvfiblets import formats
from pvfiblets.errors import FormatError

from .samples import corpus

N = int(os.environ.get("PVFIBLETS_FUZZ", "250"))

VARIANTS = [
    ".tck", ".trk", ".trx", ".vtk", ".vtp", ".trk.gz", ".tt.gz",
    "text.vtk", "inline.vtp", "text.vtp", "deflated.trx",
]  # fmt: skip


@pytest.fixture(scope="module")
def healthy(tmp_path_factory):
    return corpus(tmp_path_factory.mktemp("corpus"))


def damage(data: bytes, rng: np.random.Generator) -> bytes:
    """One to three wounds: flipped bits, absurd numbers, lost, doubled or zeroed stretches."""
    raw = bytearray(data)
    for _ in range(rng.integers(1, 4)):
        n = len(raw)
        if n == 0:
            break
        # Headers matter most: half of the wounds fall on the first tenth.
        at = int(rng.integers(0, n if rng.random() < 0.5 else max(1, n // 10)))
        span = int(rng.integers(1, 40))
        match rng.integers(0, 8):
            case 0:
                raw[at] ^= 1 << int(rng.integers(0, 8))
            case 1:
                value = int(rng.choice([0, 1, -1, 2**31 - 1, -(2**31), 2**24, 10**6]))
                raw[at : at + 4] = value.to_bytes(4, "little", signed=True)
            case 2:
                raw[at : at + 8] = int(rng.integers(-(2**62), 2**62)).to_bytes(8, "little", signed=True)
            case 3:
                del raw[at:]
            case 4:
                del raw[at : at + span]
            case 5:
                raw[at:at] = raw[at : at + span]
            case 6:
                raw[at : at + span] = bytes(span)
            case 7:
                raw[at : at + 1] = rng.choice([b"9", b"99999999", b"-", b" ", b"\n", b"\xff", b"e"])
    return bytes(raw)


@pytest.mark.parametrize("variant", VARIANTS)
def test_damaged_files_give_errors_or_results(variant, healthy, tmp_path):
    data = healthy[variant].read_bytes()
    target = tmp_path / f"damaged{''.join(healthy[variant].suffixes)}"
    inner = gzip.decompress(data) if variant.endswith(".gz") else None
    formats.read(healthy[variant])  # imports happen before memory is measured
    rng = np.random.default_rng(len(variant) * 7 + 1)
    outcomes = {"read": 0, "refused": 0, "untold": 0}
    tracemalloc.start()
    try:
        for i in range(N):
            if inner is not None and i % 2:
                bad = gzip.compress(damage(inner, rng), 1, mtime=0)
            else:
                bad = damage(data, rng)
            target.write_bytes(bad)
            tracemalloc.reset_peak()
            before = tracemalloc.get_traced_memory()[0]
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("error")
                    s = formats.read(target)
            except FormatError as error:
                told = (error.found, error.expected, str(error).startswith(str(target)))
                outcomes["refused" if all(told) else "untold"] += 1
            else:
                outcomes["read"] += 1
                assert np.isfinite(s.points).all()
                # Streaming the same file tells the same.
                chunks = list(formats.iter_chunks(target, 4))
                assert sum(len(c) for c in chunks) == len(s)
                assert sum(c.n_points for c in chunks) == s.n_points
            spent = tracemalloc.get_traced_memory()[1] - before
            size = max(len(bad), len(inner or b""))
            # Ten times the file, above what readers need for any file: buffers and parsers.
            assert spent < 10 * size + 1_500_000, f"{spent} bytes for a file of {size}"
    finally:
        tracemalloc.stop()
    assert outcomes["refused"] > N // 20
    assert outcomes["untold"] == 0


@pytest.mark.parametrize("variant", VARIANTS)
def test_every_truncation_is_noticed(variant, healthy, tmp_path):
    whole = healthy[variant].read_bytes()
    target = tmp_path / f"short{''.join(healthy[variant].suffixes)}"
    full = formats.read(healthy[variant])
    for size in sorted({*range(0, len(whole), max(1, len(whole) // 60)), len(whole) - 1}):
        target.write_bytes(whole[:size])
        try:
            s = formats.read(target)
        except FormatError:
            continue
        assert len(s) == len(full)
        assert np.array_equal(s.points, full.points)
        # A last newline carries nothing; a legacy vtk file is whole after any of its sections.
        rest = whole[size:].strip()
        section = variant.endswith(".vtk") and re.match(rb"[A-Z_]+ ", rest)
        assert not rest or section or rest == b"</VTKFile>" or s.dropped
