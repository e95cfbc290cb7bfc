"""Extreme streamlines through every file format, and files that are none: the same points, or one clear error."""

from __future__ import annotations

import struct
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from pvfiblets import formats
from pvfiblets.codec.fibletset import FibletSet
from pvfiblets.errors import FibletsError
from pvfiblets.report.studies.codec.coded import compress
from pvfiblets.streamlines import Streamlines

from .case import Cases, Outcome, Setting, refused, worst
from .synthetic_lines import differences, lines_of, tracking

CASES = Cases("formats")
WRITTEN = (".tck", ".trk", ".trx", ".vtk", ".vtp")
HELD = "the same counts, every coordinate as float32 holds it; in .trk, whose 0 is a voxel's corner, as it holds 1 mm"
ROUNDING = "of float32's rounding"


def _through_files(streamlines: Streamlines, slack: float = 0.0) -> Outcome:
    """Write and read by every format; errors are over float32's rounding of the largest coordinate, and `slack` mm."""
    found = []
    largest = float(np.abs(streamlines.points).max(initial=0.0))
    # Formats of voxel space round there, and coming back.
    rounding = 4.0 * float(np.spacing(np.float32(largest))) + slack
    corner = 4.0 * float(np.spacing(np.float32(1.0)))
    for suffix, read in _written(streamlines):
        if not np.array_equal(read.offsets, streamlines.offsets):
            return Outcome(np.inf, 1.0, ROUNDING, f"{suffix}: counts changed, dropped {read.dropped}")
        off = float(differences(read.points, streamlines.points).max(initial=0.0))
        allowed = rounding + corner * (suffix == ".trk")
        found.append(Outcome(off / allowed, 1.0, ROUNDING, suffix))
    return worst(found)


def _written(streamlines: Streamlines) -> Iterator[tuple[str, Streamlines]]:
    with tempfile.TemporaryDirectory() as folder:
        for suffix in WRITTEN:
            path = Path(folder) / f"some{suffix}"
            formats.write(path, streamlines, double=suffix in formats.DOUBLES)  # floats would be a warning
            yield suffix, formats.read(path)


@CASES.add("coordinates of ±1e7 mm and of 1e30 mm", "tracking moved, and random points", HELD)
def _far(_: Setting) -> Outcome:
    base = tracking(3)
    huge = lines_of((np.random.default_rng(5).normal(size=(70, 3)) * 1e30).astype(np.float32))
    away = [(base.points + by).astype(np.float32) for by in (1e7, -1e7)]  # in float64, writers report rounding
    sets = [*(Streamlines(points, base.offsets) for points in away), huge]
    return worst([_through_files(some) for some in sets])


@CASES.add("coordinates of 1e-6 mm, denormal and 0", "tracking scaled, points of 1e-40 mm, points at 0", HELD)
def _small(_: Setting) -> Outcome:
    base, some = tracking(3), np.random.default_rng(5).normal(size=(70, 3))
    sets = [Streamlines(base.points * 1e-6, base.offsets), lines_of(some * 1e-40), lines_of(np.zeros((9, 3)))]
    return worst([_through_files(lines, slack=1e-44) for lines in sets])


@CASES.add("100,000 streamlines of 2 points", "random short segments", HELD)
def _many(_: Setting) -> Outcome:
    points = np.random.default_rng(6).uniform(-100.0, 100.0, (200_000, 3)).astype(np.float32)
    return _through_files(Streamlines(points, 2 * np.arange(100_001)))


@CASES.add("no streamlines, and streamlines of one point", "nothing, and 50 single points", HELD)
def _nothing(_: Setting) -> Outcome:
    points = np.random.default_rng(6).uniform(-100.0, 100.0, (50, 3))
    empty, single = Streamlines(np.empty((0, 3)), [0]), Streamlines(points, np.arange(51))
    return worst([_through_files(empty), _through_files(single)])


@CASES.add(
    ".fiblets of extreme sets",
    "nothing, one point, 1e7 mm away, sizes of 1e-6 and 1e6",
    "decodes to the very same points",
)
def _fiblets(_: Setting) -> Outcome:
    base, different = tracking(3), 0
    sets = [Streamlines(np.empty((0, 3)), [0]), Streamlines(np.empty((0, 3)), [0, 0]), lines_of([[1.0, 2.0, 3.0]])]
    sets += [Streamlines(base.points * size + shift, base.offsets) for size, shift in ((1, 1e7), (1e-6, 0), (1e6, 0))]
    with tempfile.TemporaryDirectory() as folder:
        for number, lines in enumerate(sets):
            fiblets, path = compress(lines), Path(folder) / f"{number}.fiblets"
            fiblets.save(path)
            opened = FibletSet.open(path)
            opened.verify()
            a, b = (found.decompress(dtype=np.float64) for found in (fiblets, opened))
            different += not (np.array_equal(a.points, b.points) and np.array_equal(a.offsets, b.offsets))
            del opened
    return Outcome(float(different), 0.0, "different sets")


@CASES.add(
    "files that end too soon",
    "no bytes, one, and the first half of good files, in every format",
    "an error, or counted losses",
)
def _cut(_: Setting) -> Outcome:
    wrong, said = 0, ""
    with tempfile.TemporaryDirectory() as folder:
        for suffix in (*WRITTEN, ".fiblets"):
            good = Path(folder) / f"good{suffix}"
            if suffix == ".fiblets":
                compress(tracking(5)).save(good)
            else:
                formats.write(good, tracking(5))
            data = good.read_bytes()
            for name, part in (("empty", b""), ("one", data[:1]), ("half", data[: len(data) // 2])):
                path = Path(folder) / f"{name}{suffix}"
                path.write_bytes(part)
                try:
                    read = FibletSet.open(path) if suffix == ".fiblets" else formats.read(path)
                except FibletsError:
                    continue
                if not read.dropped:
                    wrong, said = wrong + 1, f"{name}{suffix}"
    return Outcome(float(wrong), 0.0, "silent losses", said)


@CASES.add(
    "counts that no file could have",
    "a .trk streamline of 2e9 points, 2e9 streamlines; a .tck offset of 1e18",
    "an error that names the file",
)
def _counts(_: Setting) -> Outcome:
    with tempfile.TemporaryDirectory() as folder:
        trk, tck = Path(folder) / "a.trk", Path(folder) / "b.tck"
        formats.write(trk, tracking(2))
        formats.write(tck, tracking(2))
        data = bytearray(trk.read_bytes())
        data[1000:1004] = struct.pack("<i", 2_000_000_000)
        trk.write_bytes(data)
        text = tck.read_bytes()
        first = text.index(b"file:")
        line = text[first : text.index(b"\n", first)]
        tck.write_bytes(text.replace(line, b"file: . 999999999999999999"))
        found = refused(FibletsError, r"a\.trk|b\.tck", lambda: formats.read(trk), lambda: formats.read(tck))
        return replace(found, note=found.note.replace(str(Path(folder)), ""))
