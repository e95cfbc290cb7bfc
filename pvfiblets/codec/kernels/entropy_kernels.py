"""Compiled kernels: Huffman codes of bytes, given the byte before (Goel and others 2024, doi 10.1145/3675373).

A stream of bytes has a code for each *context*: the upper bits of the byte before, ``before >> shift``. Blocks of
`BLOCK` bytes begin with 0 before them, so that each is decoded by itself. Codes are canonical: by length, then by byte.
A byte that alone follows a context takes no bits: its length is `ALONE`. The first bit of a code comes first, into the
lowest free bit of a byte.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from ..jit import kernel, parallel_kernel

BLOCK = 1 << 17  # bytes of a stream
LONGEST = 11  # bits of a code
ALONE = 15
_SLOTS = 1 << LONGEST
_NONE = 0xFF00  # of bits that begin no code


@parallel_kernel
def count_pairs(stream: Any, counts: Any) -> None:
    """How often each byte follows each, within blocks: into ``counts`` ``(parts, 256, 256) int64``."""
    blocks = (len(stream) + BLOCK - 1) // BLOCK
    parts = len(counts)
    for part in numba.prange(parts):
        for block in range(part, blocks, parts):
            before = 0
            for i in range(block * BLOCK, min((block + 1) * BLOCK, len(stream))):
                counts[part, before, stream[i]] += 1
                before = int(stream[i])


@kernel
def code_lengths(counts: Any, lengths: Any) -> None:
    """Lengths of Huffman codes of each row of counts, 0 for bytes that it lacks; they are at most `LONGEST`."""
    # Counts are halved until the tree is low enough.
    weights = np.empty(511, np.int64)
    parents = np.empty(511, np.int64)
    for row in range(len(counts)):
        lengths[row] = 0
        halved = counts[row].copy()
        while True:
            order = np.argsort(halved)
            first = 0
            while first < 256 and halved[order[first]] == 0:
                first += 1
            n = 256 - first
            if n == 0:
                break
            if n == 1:
                lengths[row, order[first]] = ALONE
                break
            for i in range(n):
                weights[i] = halved[order[first + i]]
            # The least of two sorted queues: of bytes, and of the nodes made so far, whose weights rise.
            leaf, node = 0, n
            for made in range(n, 2 * n - 1):
                weights[made] = 0
                for _ in range(2):
                    if leaf < n and (node == made or weights[leaf] <= weights[node]):
                        least = leaf
                        leaf += 1
                    else:
                        least = node
                        node += 1
                    weights[made] += weights[least]
                    parents[least] = made
            depth = weights  # of nodes: no longer needed as weights
            depth[2 * n - 2] = 0
            for i in range(2 * n - 3, -1, -1):
                depth[i] = depth[parents[i]] + 1
            if depth[0] <= LONGEST:
                for i in range(n):
                    lengths[row, order[first + i]] = depth[i]
                break
            for i in range(256):
                if halved[i] > 0:
                    halved[i] = (halved[i] + 1) >> 1


@kernel
def canonical_codes(lengths: Any, codes: Any) -> bool:
    """Canonical codes of each row, bits reversed; False where lengths are those of no code."""
    for row in range(len(lengths)):
        code, known = 0, 0
        for length in range(1, LONGEST + 1):
            for byte in range(256):
                if lengths[row, byte] == length:
                    reverse = 0
                    for bit in range(length):
                        reverse |= (code >> bit & 1) << (length - 1 - bit)
                    codes[row, byte] = reverse
                    code += 1
                    known += 1
            if code > 1 << length:
                return False
            code <<= 1
        for byte in range(256):
            if lengths[row, byte] > LONGEST and (lengths[row, byte] != ALONE or known > 0):
                return False
            known += lengths[row, byte] == ALONE
    return True


@parallel_kernel
def encode_blocks(stream: Any, shift: int, lengths: Any, codes: Any, packed: Any, sizes: Any) -> None:
    """Code each block into a row of `packed`, with room for `LONGEST` bits a byte; `sizes` are the bytes of each."""
    for block in numba.prange(len(sizes)):
        bits, held, at, before = np.uint64(0), 0, 0, 0
        for i in range(block * BLOCK, min((block + 1) * BLOCK, len(stream))):
            byte = int(stream[i])
            context = before >> shift
            bits |= np.uint64(codes[context, byte]) << np.uint64(held)
            held += int(lengths[context, byte]) % ALONE
            before = byte
            while held >= 8:
                packed[block, at] = np.uint8(bits & np.uint64(255))
                at += 1
                bits >>= np.uint64(8)
                held -= 8
        if held > 0:
            packed[block, at] = np.uint8(bits & np.uint64(255))
            at += 1
        sizes[block] = at


@parallel_kernel
def decode_blocks(packed: Any, starts: Any, shift: int, lengths: Any, codes: Any, stream: Any, good: Any) -> None:
    """Undo `encode_blocks`: block b is ``packed[starts[b]:starts[b + 1]]``; `good` is 0 of those that are damaged."""
    contexts = len(lengths)
    table = np.full((contexts, _SLOTS), _NONE, np.uint16)  # the byte, and its length above
    for row in numba.prange(contexts):
        for byte in range(256):
            length = int(lengths[row, byte])
            if length > 0:
                length %= ALONE
                for slot in range(int(codes[row, byte]), _SLOTS, 1 << length):
                    table[row, slot] = length << 8 | byte
    for block in numba.prange(len(starts) - 1):
        at, end = starts[block], starts[block + 1]
        bits, held, before = np.uint64(0), 0, 0
        fine = True
        for i in range(block * BLOCK, min((block + 1) * BLOCK, len(stream))):
            if held < LONGEST:
                while held <= 48 and at < end:
                    bits |= np.uint64(packed[at]) << np.uint64(held)
                    at += 1
                    held += 8
            entry = int(table[before >> shift, bits & np.uint64(_SLOTS - 1)])
            length = entry >> 8
            if length > held:
                fine = False
                break
            bits >>= np.uint64(length)
            held -= length
            before = entry & 255
            stream[i] = before
        good[block] = fine and at == end and held < 8 and bits == np.uint64(0)
