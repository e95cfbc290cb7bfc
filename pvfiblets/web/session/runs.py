"""Rising whole numbers as runs, and as text in session files and scripts: streamlines of a set, voxels of an image."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

from pvfiblets.web.values import shown

_STEPS = {"u1": 1, "u2": 2, "u4": 4, "u8": 8}  # types of steps, and their bytes; little-endian


def runs_of(numbers: np.ndarray) -> np.ndarray:
    """Return ``(n, 2)`` int64: the first of each run of rising numbers, and the number behind its last."""
    numbers = np.asarray(numbers, np.int64)
    breaks = np.flatnonzero(np.diff(numbers) != 1)
    begins, ends = np.append(0, breaks + 1)[: len(numbers)], np.append(breaks, len(numbers) - 1)[: len(numbers)]
    return np.stack([numbers[begins], numbers[ends] + 1], axis=1)


def numbers_in(runs: np.ndarray) -> np.ndarray:
    """Return the numbers of runs, int64."""
    lengths = runs[:, 1] - runs[:, 0]
    after = np.cumsum(lengths)
    return np.arange(int(lengths.sum())) + np.repeat(runs[:, 0] - after + lengths, lengths)


def pack(runs: np.ndarray) -> str:
    """Return runs as text, in the shorter of two forms."""
    # `bits:` and, in base64, a bit for each number up to the last one, the lowest bit of a byte first; or `u1:`, `u2:`,
    # `u4:` or `u8:` and integers of so many bytes: the numbers between runs and in runs, in turns.
    ends = np.asarray(runs, np.int64).reshape(-1)
    steps = np.diff(ends, prepend=0)
    kind = next(kind for kind, size in _STEPS.items() if int(steps.max(initial=0)) < 1 << 8 * size)
    if len(ends) and 8 * len(steps) * _STEPS[kind] > ends[-1]:
        bits = np.zeros(int(ends[-1]), bool)
        bits[numbers_in(ends.reshape(-1, 2))] = True
        kind, data = "bits", np.packbits(bits, bitorder="little").tobytes()
    else:
        data = steps.astype(f"<{kind}").tobytes()
    return f"{kind}:{base64.b64encode(data).decode()}"


def unpack(value: Any, name: str, count: int, of: str = "streamline") -> np.ndarray:
    """Return the runs that a session file holds for some of ``count`` things; of older files, a list of their ends."""
    ends = _ends(value, count)
    if ends is None:
        raise ValueError(f"{name}: {shown(value)} is damaged, or has runs of more than {count:,} {of}s; save it again")
    if len(ends) and (ends[0] < 0 or (np.diff(ends) <= 0).any()):
        raise ValueError(f"{name}: runs of {of}s are not rising; start each one after the end of the run before it")
    if len(ends) and ends[-1] > count:
        raise ValueError(f"{name}: {of} {ends[-1] - 1:,} does not exist; there are {count:,}, counted from 0")
    return ends.reshape(-1, 2)


def _ends(value: Any, count: int) -> np.ndarray | None:
    """Return first and behind the last of each run, which may not rise; None where there are none, or too many."""
    if isinstance(value, list):
        if len(value) % 2 or len(value) > count + 1 or not all(type(one) is int and 0 <= one < 2**62 for one in value):
            return None
        return np.array(value, np.int64)
    if not isinstance(value, str):
        return None
    kind, colon, text = value.partition(":")
    try:
        data = base64.b64decode(text.encode("ascii"), validate=True)
    except ValueError:
        return None
    if not colon:
        return None
    if kind == "bits" and 8 * len(data) <= count + 7:
        bits = np.unpackbits(np.frombuffer(data, np.uint8), bitorder="little")
        return np.flatnonzero(np.diff(bits, prepend=np.uint8(0), append=np.uint8(0)))
    size = _STEPS.get(kind)
    if size is None or len(data) % (2 * size) or len(data) > size * (count + 1):
        return None
    steps = np.frombuffer(data, f"<{kind}")
    return np.cumsum(steps, dtype=np.int64) if steps.sum(dtype=np.float64) < 2**62 else None
