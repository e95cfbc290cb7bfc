"""Arrays of a file in fewer bytes, without loss: Huffman codes of their bytes, given the byte before.

An array of numbers of two, four or eight bytes is cut into columns of two bytes, and each column into its lower and its
upper bytes; where that takes less, of the differences of consecutive rows. Each of these streams, and an array of
single bytes as a whole, is coded by :mod:`..kernels.entropy_kernels`. A packed array has for each stream

1. the lengths of its codes, a context after the other, two to a byte (the first in the lower half), as a zlib stream;
2. a row of `<u4` for each block: its bytes, and their CRC-32;
3. the blocks.
"""

from __future__ import annotations

import json
import math
import os
import zlib
from collections.abc import Iterator
from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

from ...errors import FormatError
from ...support.memory import check_room
from .archive import Member, array_member

LEAST = 1 << 10  # bytes of an array; smaller ones stay as they are
SHIFTS = (0, 2, 4, 6, 8)  # bits of the byte before that contexts leave out
GROUP = 256  # blocks that are coded at a time

Array = npt.NDArray[Any]
Bytes = npt.NDArray[np.uint8]
Stream = tuple[int, int, int]
"""Whether it is of differences, its shift, and the bytes of the lengths of its codes."""


def pack_members(members: dict[str, Member]) -> tuple[dict[str, Any], dict[str, Member]]:
    """Return facts of packed members for the header, and all members; in memory."""
    facts, found = {}, dict(members)
    for name, member in members.items():
        size = math.prod(member.shape) * member.dtype.itemsize
        if size < LEAST or member.dtype.hasobject or member.dtype.names:  # JSON has no tuples for fields
            continue
        check_room(2 * size)
        array = np.frombuffer(b"".join(member.pieces()), member.dtype).reshape(member.shape)
        if (made := pack(array)) is not None:
            facts[name], found[name] = made[0], array_member(made[1])
    return facts, found


def pack(array: Array) -> tuple[dict[str, Any], Bytes] | None:
    """Return facts for the header, and the bytes of a file; None where these would be no fewer."""
    coded = [_coded(*stream) for stream in _streams(np.ascontiguousarray(array))]
    packed = np.frombuffer(b"".join(piece for _, pieces in coded for piece in pieces), np.uint8)
    facts = {
        "dtype": np.lib.format.dtype_to_descr(array.dtype),
        "shape": list(array.shape),
        "streams": [stream for stream, _ in coded],
    }
    return (facts, packed) if len(packed) + len(json.dumps(facts)) < array.nbytes else None


def unpack(path: str | PathLike[str], name: str, facts: dict[str, Any], packed: Bytes) -> Array:
    """Undo :func:`pack` of a member of a file."""
    from ..kernels.entropy_kernels import BLOCK

    dtype, shape = np.dtype(facts["dtype"]), tuple(int(side) for side in facts["shape"])
    streams: list[Stream] = [(int(a), int(b), int(c)) for a, b, c in facts["streams"]]
    size = math.prod(shape) * dtype.itemsize
    columns, rows = (1, size) if dtype.itemsize % 2 else (size // max(shape[0], 1) // 2, shape[0])
    if dtype.hasobject or min(shape, default=0) < 1 or size * 8 > BLOCK * len(packed):
        found = f"{name} as {dtype}{shape} in {len(packed)} bytes"
        raise FormatError(path, _at(packed, 0), found, "an array that fits")
    if len(streams) != (1 if dtype.itemsize % 2 else 2 * columns):
        raise FormatError(path, _at(packed, 0), f"{name} of {len(streams)} streams", f"those of {dtype}{shape}")
    check_room(2 * size)
    if dtype.itemsize % 2:
        made: Array
        made, end = _decoded(path, name, streams[0], packed, 0, rows)
    else:
        words, end = np.empty((rows, columns), "<u2"), 0
        for column in range(columns):
            low, end = _decoded(path, name, streams[2 * column], packed, end, rows)
            high, end = _decoded(path, name, streams[2 * column + 1], packed, end, rows)
            both = low | high.astype(np.uint16) << 8
            words[:, column] = np.cumsum(both, dtype=np.uint16) if streams[2 * column][0] else both
        made = words
    if end != len(packed):
        raise FormatError(path, _at(packed, end), f"{len(packed) - end} more bytes of {name}", "its end")
    return made.reshape(-1).view(dtype).reshape(shape)


def _at(packed: Bytes, place: int) -> int:
    """Return the byte of the file at a place of an array that is mapped from it."""
    return int(getattr(packed, "offset", 0)) + place


def _streams(array: Array) -> Iterator[tuple[int, Bytes, int, Bytes]]:
    """Yield whether a stream is of differences, its bytes, its shift, and the lengths of its codes."""
    if array.dtype.itemsize % 2:
        values = array.reshape(-1).view(np.uint8)
        yield 0, values, *_lengths(values)[1:]
        return
    for column in array.reshape(len(array), -1).view("<u2").T:
        rows = column, np.diff(column, prepend=np.uint16(0))
        forms = [[(values, *_lengths(values)) for values in _bytes_of(form)] for form in rows]
        plain, changed = (sum(size for _, size, *_ in form) for form in forms)
        differences = int(changed < plain)
        for values, _, shift, lengths in forms[differences]:
            yield differences, values, shift, lengths


def _bytes_of(column: npt.NDArray[np.uint16]) -> tuple[Bytes, Bytes]:
    return (column & 0xFF).astype(np.uint8), (column >> 8).astype(np.uint8)


def _lengths(stream: Bytes) -> tuple[int, int, Bytes]:
    """Return how many bytes a stream takes at least, by which shift, and the lengths of its codes."""
    from ..kernels.entropy_kernels import ALONE, code_lengths, count_pairs

    counts = np.zeros((min(os.cpu_count() or 1, 8), 256, 256), np.int64)
    count_pairs(stream, counts)
    found = []
    for shift in SHIFTS:
        pairs = counts.sum(axis=0).reshape(256 >> shift, -1, 256).sum(axis=1)
        lengths = np.zeros(pairs.shape, np.uint8)
        code_lengths(pairs, lengths)
        found.append((int((pairs * (lengths % ALONE)).sum()) // 8 + len(_model(lengths)), shift, lengths))
    return min(found, key=lambda one: one[0])


def _model(lengths: Bytes) -> bytes:
    return zlib.compress((lengths[:, 0::2] | lengths[:, 1::2] << 4).tobytes(), 9)


def _coded(differences: int, values: Bytes, shift: int, lengths: Bytes) -> tuple[Stream, list[bytes]]:
    from ..kernels.entropy_kernels import BLOCK, LONGEST, canonical_codes, encode_blocks

    codes = np.zeros(lengths.shape, np.uint16)
    canonical_codes(lengths, codes)
    blocks = []
    for first in range(0, len(values), GROUP * BLOCK):
        part = values[first : first + GROUP * BLOCK]
        sizes = np.zeros(-(-len(part) // BLOCK), np.int64)
        room = np.empty((len(sizes), BLOCK * LONGEST // 8 + 1), np.uint8)
        encode_blocks(part, shift, lengths, codes, room, sizes)
        blocks += [row[:size].tobytes() for row, size in zip(room, sizes, strict=True)]
    model, table = _model(lengths), np.array([[len(block), zlib.crc32(block)] for block in blocks], "<u4")
    return (differences, shift, len(model)), [model, table.tobytes(), *blocks]


def _decoded(
    path: str | PathLike[str], name: str, stream: Stream, packed: Bytes, begin: int, size: int
) -> tuple[Bytes, int]:
    """Return the bytes of a stream that begins at `begin`, and where it ends."""
    from ..kernels.entropy_kernels import BLOCK, canonical_codes, decode_blocks

    _, shift, n_model = stream
    blocks = -(-size // BLOCK)
    first = begin + n_model + 8 * blocks
    if shift not in SHIFTS or n_model < 0 or first > len(packed):
        raise FormatError(path, _at(packed, begin), f"a stream of {name} as {stream}", "one that fits")
    lengths = _opened_model(path, name, packed, begin, n_model, 256 >> shift)
    table = packed[begin + n_model : first].tobytes()
    sizes = np.frombuffer(table, "<u4").reshape(-1, 2)
    starts = first + np.concatenate([[0], np.cumsum(sizes[:, 0], dtype=np.int64)])
    if starts[-1] > len(packed):
        raise FormatError(path, _at(packed, begin + n_model), f"blocks of {name} beyond its end", "sizes that fit")
    for block, (_, checksum) in enumerate(sizes):
        if zlib.crc32(packed[starts[block] : starts[block + 1]].data) != checksum:
            raise FormatError(path, _at(packed, int(starts[block])), f"a damaged block of {name}", "an undamaged file")
    values, good, codes = np.empty(size, np.uint8), np.zeros(blocks, np.uint8), np.zeros(lengths.shape, np.uint16)
    if not canonical_codes(lengths, codes):
        raise FormatError(path, _at(packed, begin), f"lengths of no code in {name}", "those of a Huffman code")
    decode_blocks(np.asarray(packed), starts, shift, lengths, codes, values, good)
    if not good.all():
        at = int(starts[int(np.argmin(good))])
        raise FormatError(path, _at(packed, at), f"a block of {name} that is not what its codes say", "one that is")
    return values, int(starts[-1])


def _opened_model(
    path: str | PathLike[str], name: str, packed: Bytes, begin: int, n_model: int, contexts: int
) -> Bytes:
    machine = zlib.decompressobj()
    try:
        raw = machine.decompress(packed[begin : begin + n_model].tobytes(), 128 * contexts + 1)
    except zlib.error as error:
        found = f"damaged lengths of codes of {name} ({error})"
        raise FormatError(path, _at(packed, begin), found, "a zlib stream") from error
    if len(raw) != 128 * contexts or not machine.eof:
        raise FormatError(path, _at(packed, begin), f"{len(raw)} lengths of codes of {name}", f"{128 * contexts}")
    halves = np.frombuffer(raw, np.uint8).reshape(contexts, 128)
    return np.stack([halves & 15, halves >> 4], axis=2).reshape(contexts, 256)
