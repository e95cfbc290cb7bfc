"""Damaged files read in a process of their own, which is held to time and memory: what ``test_fuzz`` starts.

    python fuzzing.py READER N SEED FILE SCRATCH

prints, as JSON, how many of N damaged copies of FILE were read, and how many were refused. A copy that ends in
anything else is left in SCRATCH, and told on the error stream.

- *No hang*: a timer raises after five seconds of the processor's time; where Python does not get to hear of it, or
  nothing happens at all, a second one ends the process with a traceback after a minute by the clock.
- *No memory*: Python's allocations are counted (`tracemalloc`), and the process's address space is limited, so that
  what C++ asks for fails too.
- *No crash*: this process would end, and its exit status tells.
"""

import faulthandler
import gzip
import importlib
import json
import resource
import signal
import sys
import tracemalloc
import warnings
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

SECONDS, BY_THE_CLOCK = 5, 60
TIMES = 10
"""Memory that reading may take, in file sizes..."""

BUFFERS = 1_500_000
"""...above what readers need for any file: buffers and parsers."""

ROOM = 96 << 20
"""Address space above what reading a healthy file took: allocators take it in large pieces."""


class HangError(BaseException):
    """Reading took too long; no reader's `except` catches it."""


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
        match rng.integers(0, 9):
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
            case 8:
                _number(raw, at, rng)
    return bytes(raw)


def _number(raw: bytearray, at: int, rng: np.random.Generator) -> None:
    """Put another number in the place of the next one that is written as text."""
    first = next((i for i in range(at, len(raw)) if 48 <= raw[i] < 58), None)
    if first is not None:
        last = next((i for i in range(first, len(raw)) if not 48 <= raw[i] < 58), len(raw))
        raw[first:last] = str(rng.choice([0, 1, -1, 7, 4096, 10**6, 2**31, 2**63, 10**30])).encode()


def _lines(path: Path) -> None:
    from pvfiblets import formats

    s = formats.read(path)
    assert np.isfinite(s.points).all()
    # Streaming the same file tells the same.
    chunks = list(formats.iter_chunks(path, 4))
    assert sum(len(c) for c in chunks) == len(s)
    assert sum(c.n_points for c in chunks) == s.n_points


def _fiblets(path: Path) -> None:
    from pvfiblets import FibletSet

    fiblets = FibletSet.open(path)
    points = fiblets.decompress().points
    assert sum(c.n_points for c in fiblets.iter_chunks(100)) == len(points)


def _values(path: Path) -> None:
    from pvfiblets import formats
    from pvfiblets.streamlines import Streamlines

    counts = np.array([5, 1, 12, 0, 2, 7])
    s = Streamlines(np.zeros((counts.sum(), 3), np.float32), np.concatenate([[0], np.cumsum(counts)]))
    where = formats.attach(s, path, "v")
    assert len(getattr(s, where)["v"]) == (s.n_points if where == "per_point" else len(s))


def _volume(path: Path) -> None:
    from pvfiblets.volumes import as_raycast_volume

    volume = as_raycast_volume(path)
    assert volume.values.ndim == 3
    assert np.isfinite(volume.affine).all()
    assert np.isfinite(volume.values).all()


def _image(path: Path) -> None:
    from pvfiblets.images.files import read_image

    image = read_image(path)
    assert image.values.shape == image.shape
    assert image.values.ndim >= 3
    assert np.isfinite(image.affine).all()


def _labels(path: Path) -> None:
    from pvfiblets.slices.labels import as_label_table

    table = as_label_table(path)
    assert table.names or table.colours
    assert all(0 <= part <= 255 for colour in table.colours.values() for part in colour)


def _surface(path: Path) -> None:
    from pvfiblets.plotting.gifti import placed_surface
    from pvfiblets.volumes.freesurfer_files import SURFACES, read_annotation, read_numbers

    if path.name.endswith(SURFACES):
        assert np.isfinite(placed_surface(path)[0].points).all()
    elif path.suffix == ".annot":
        labels, colours = read_annotation(path)
        assert len(labels) == len(colours)
    else:
        assert read_numbers(path).ndim == 1


READERS: dict[str, Callable[[Path], None]] = {
    "lines": _lines, "fiblets": _fiblets, "values": _values, "volume": _volume, "image": _image, "labels": _labels,
    "surface": _surface,
}  # fmt: skip


def repacked(path: Path) -> Callable[[bytes], bytes] | None:
    """Return how the content of a compressed file is packed again; None for others."""
    return (lambda inner: gzip.compress(inner, 1, mtime=0)) if path.name.endswith((".gz", ".mgz")) else None


def main(reader: str, count: str, seed: str, file: str, scratch: str) -> None:
    """Read the damaged copies."""
    path, read = Path(file), READERS[reader]
    data = path.read_bytes()
    pack = repacked(path)
    inner = gzip.decompress(data) if pack else None
    target = Path(scratch) / f"damaged{''.join(path.suffixes)}"
    read(path)  # imports happen before memory is measured
    _expected_of(reader)
    signal.signal(signal.SIGPROF, _hung)
    if sys.platform.startswith("linux"):
        used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + TIMES * len(inner or data) + ROOM, resource.RLIM_INFINITY))
    outcomes = {"read": 0, "refused": 0, "untold": 0, "most_bytes": 0}
    tracemalloc.start()
    for i in range(int(count)):
        rng = np.random.default_rng([int(seed), zlib.crc32(path.name.encode()), i])
        bad = pack(damage(inner, rng)) if pack and inner is not None and i % 2 else damage(data, rng)
        target.write_bytes(bad)
        try:
            spent = _one(read, reader, target, outcomes)
        except BaseException as error:
            print(f"copy {i} of seed {seed}: {type(error).__name__}: {error}; it is {target}", file=sys.stderr)
            raise
        allowed = TIMES * max(len(bad), len(inner or b"")) + BUFFERS
        if spent > allowed:  # once in thousands of files a table of the interpreter's own grows, of interned strings
            spent = _one(read, reader, target, dict.fromkeys(outcomes, 0))
        if spent > allowed:
            raise MemoryError(f"copy {i} of seed {seed}: {spent} bytes for a file of {len(bad)}; it is {target}")
        outcomes["most_bytes"] = max(outcomes["most_bytes"], spent)
    print(json.dumps(outcomes))


def _one(read: Callable[[Path], None], reader: str, target: Path, outcomes: dict[str, Any]) -> int:
    """Read one file, and return the bytes that Python allocated meanwhile."""
    tracemalloc.reset_peak()
    before = tracemalloc.get_traced_memory()[0]
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    faulthandler.dump_traceback_later(BY_THE_CLOCK, exit=True)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.filterwarnings(
                "ignore",
                message=r"(?s).*(which is used|is taken, by the voxel-to-RAS|left out line [\d, ]+|moved by c_ras)",
            )
            read(target)
    except _expected_of(reader) as error:
        outcomes["refused" if _is_told(error, target) else "untold"] += 1
        if not _is_told(error, target) and outcomes["untold"] == 1:
            print(f"untold: {type(error).__name__}: {error}", file=sys.stderr)
    else:
        outcomes["read"] += 1
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        faulthandler.cancel_dump_traceback_later()
    return tracemalloc.get_traced_memory()[1] - before


def _expected_of(reader: str) -> Any:
    """Errors that a damaged file may end in: of volumes those that say what cannot be drawn, too."""
    errors = importlib.import_module("pvfiblets.errors")
    if reader == "image":  # whose data may be in a file of their own
        return errors.FormatError, FileNotFoundError
    return (errors.FormatError, ValueError, FileNotFoundError) if reader == "volume" else errors.FormatError


def _is_told(error: Exception, path: Path) -> bool:
    """Whether an error says what was found, what was expected, and where."""
    from pvfiblets.errors import FormatError

    if isinstance(error, FormatError):
        places = (str(path), *map(str, path.parent.glob("*.raw")), "the set of fiblets", "fiblets in memory")
        return bool(error.found and error.expected) and str(error).startswith(places)
    return bool(str(error))


def _hung(*_: Any) -> None:
    raise HangError(f"more than {SECONDS} s")


if __name__ == "__main__":
    main(*sys.argv[1:])
