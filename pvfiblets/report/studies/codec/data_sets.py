"""Data sets of the studies of coordinates: synthetic ones of constant step, and real files cut to a bounded size."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pvfiblets import formats
from pvfiblets.formats.registry import suffixes
from pvfiblets.streamlines import Streamlines

from ...study import Options

STEPS = (0.05, 0.1, 0.2, 0.5, 1.0)  # mm
QUICK_STEPS = (0.1, 0.5)
# Degrees per axis and step of a probabilistic tracker's turns. About 4 at 0.2 mm resemble iFOD1; as an angle a step
# made freely grows with the square root of the step, so does the noise of others.
NOISE = 4.0
NOISE_STEP = 0.2
SMALL = 1000  # points; smaller sets are measured, but not drawn: their times are the cost of a call


@dataclass(frozen=True)
class DataSet:
    """Streamlines with a name; ``group`` as in :class:`.Record`."""

    name: str
    group: str
    streamlines: Streamlines


def data_sets(options: Options) -> Iterator[DataSet]:
    """Make or read one set after the other, so that one at a time is in memory."""
    for noisy in (False, True):
        for step in QUICK_STEPS if options.quick else STEPS:
            kind = "noisy" if noisy else "smooth"
            yield DataSet(f"{kind}, {step:g} mm", kind, synthetic_tracking(step, noisy, options.points, options.seed))
    yield from file_sets(options, options.points)


def file_sets(options: Options, points: int) -> Iterator[DataSet]:
    """Read one file after the other, the largest first, each cut to so many points."""
    paths, reason = files_of(options.files)
    if reason:
        options.leave_out("real files", reason)
    for path in paths:
        try:
            streamlines, note = thinned(formats.iter_chunks(path), points)
        except (ValueError, OSError) as error:
            options.leave_out(path.name, " ".join(str(error).replace(str(path), path.name).split()))
            continue
        if not streamlines.n_points:
            options.leave_out(path.name, "it has no points")
        elif not np.isfinite(streamlines.points).all():
            options.leave_out(path.name, "it has points that are not finite")
        else:
            name = f"{path.name}, {note}" if note else path.name
            yield DataSet(name, "files" if streamlines.n_points >= SMALL else "", streamlines)


def synthetic_tracking(step: float, noisy: bool, points: int, seed: int) -> Streamlines:
    """Make about so many points, of constant step."""
    from pvfiblets.synthetic import brain_streamlines, streamline_count

    noise = NOISE * (step / NOISE_STEP) ** 0.5 if noisy else 0.0
    streamlines = brain_streamlines(streamline_count(points, step), step, seed, noise=noise)
    return thinned([streamlines], points)[0]


def files_of(given: Sequence[Path]) -> tuple[list[Path], str]:
    """Return the files to take, the largest first, and why there are none."""
    if not given:
        folder = os.environ.get("PVFIBLETS_DATA")
        if not folder:
            return [], "no file was given with --data, and PVFIBLETS_DATA names no folder"
        if not Path(folder).is_dir():
            return [], "PVFIBLETS_DATA names a folder that is not there"
        given = [Path(folder)]
    known = tuple(suffix for suffix in suffixes() if suffix != ".fiblets")
    paths = []
    for path in given:
        if path.is_dir():
            paths += [file for file in sorted(path.iterdir()) if file.name.lower().endswith(known)]
        elif path.is_file():
            paths.append(path)
        else:
            raise FileNotFoundError(f"{path}: there is no such file or folder to measure with")
    paths.sort(key=lambda path: (-path.stat().st_size, path.name))  # if time runs out, the small ones are left out
    return paths, "" if paths else "there is no tractogram in the folders given"


def thinned(chunks: Iterable[Streamlines], limit: int) -> tuple[Streamlines, str]:
    """Keep an even share of streamlines, of no more than ``limit`` points, in bounded memory."""
    kept: list[Streamlines] = []
    stride, seen, total = 1, 0, 0
    for chunk in chunks:
        first = -seen % stride
        seen += len(chunk)
        kept.append(Streamlines(chunk.points, chunk.offsets)[np.arange(first, len(chunk), stride)])
        total += kept[-1].n_points
        while total > 2 * limit and sum(map(len, kept)) > 1:
            stride *= 2
            kept = [Streamlines.concatenate(kept)[::2]]
            total = kept[0].n_points
    whole = Streamlines.concatenate(kept) if kept else Streamlines(np.zeros((0, 3), np.float32), [0])
    if whole.n_points > limit:
        share = max(int(len(whole) * limit / whole.n_points), 1)
        whole = whole[np.linspace(0, len(whole) - 1, share).astype(np.int64)]
    if whole.n_points > limit:  # long streamlines happened to be taken
        most = max(int(np.searchsorted(whole.offsets, limit, side="right")) - 1, 1)
        whole = whole[:most]
    whole = Streamlines(np.array(whole.points[: max(limit, 0)]), np.minimum(whole.offsets, limit))
    if len(whole) < seen:
        return whole, f"{len(whole):,} of {seen:,} streamlines"
    return whole, "" if total == whole.n_points else f"its first {limit:,} points"
