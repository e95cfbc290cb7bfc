"""The fiblet record: the one place that states how a fiblet is laid out in bits.

Everything that packs or unpacks a record (NumPy, compiled kernels, shaders, the file format) takes the bits
of fields from here; :func:`glsl_source` writes the same table as GLSL, so that a shader cannot disagree with Python.
How many words there are is also said where they are read: the modules ``decode_kernels``, ``copy_kernels`` and
``query.selection.passing``, the shaders ``fiblets/data`` and ``fiblets/decode/words.glsl``, and the page's
``fiblets.ts`` take two words of an anchor and three to decode by.

A fiblet is at most 60 consecutive points of one streamline (paper: Schertzer et al. 2022, section 3.2.2). What culling
reads is kept apart from what decoding reads, so that a cull pass never drags codes through memory:

=============  ==================  ============================================================================
array          shape, dtype        read by
=============  ==================  ============================================================================
``anchors``    (n, 2) uint32       culling: first point, streamline, begin and end flags
``reach``      (n,) uint16         culling: radius of the capsule about the chord (:mod:`.capsules`)
``ends``       (n_ranks,) uint32   culling: end vector of each streamline's last fiblet, where no next one has it
``decoding``   (n, 3) uint32       decoding: direction or lattice, step, where codes and points start, count, kind
``codes``      (n_bytes,) uint8    decoding: one byte a point (kind DIRECTION), 1-4 bytes (lattice kinds), or splines
=============  ==================  ============================================================================

Budget: 8 + 2 + 12 bytes of record and 58 codes for a full fiblet of 60 points (the anchor and the first direction stand
for two of them) are 80 bytes, 1.33 bytes per point; each streamline adds the 4 bytes of its end vector.

Indices in a record are relative to its *page* of ``PAGE`` consecutive fiblets. The largest stretch of codes that one
fiblet can have is ``WIDE_HEADER + 59 * 4 = 256`` bytes, so a page holds at most 2**22 bytes of codes and 60 * 2**14 <
2**20 points: the widths of ``code`` and ``point`` below follow from that.

Fiblets of splines (`effort='small'`) are of the kind WIDE with SPLINE for the bytes of a code: cubic pieces end to end,
NODE_BYTES each, decoded at the parameters of the points (:mod:`.kernels.spline_kernels`).

Sets that keep their points exactly (:mod:`.exact`) have fiblets of at most ``PLAIN_POINTS`` points, of the kind WIDE
with 0 for the bytes of a code: three int32 a point, ``PLAIN_BYTES``, and no box. They are drawn to a few billionths of
the extent.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

MAX_POINTS = 60
PAGE_BITS = 14
PAGE = 1 << PAGE_BITS
CAPS = 16
DIRECTION_SCALE = 32767.0
STEP_LEVELS = 1023
WIDE_HEADER = 20
PLAIN_BYTES = 12
PLAIN_POINTS = 22
SPLINE = 5
NODE_BYTES = 6
NODE_BITS = 7
SLOPE_BITS = 10
SLOPE_SHIFT = 3
END_BITS = 10
END_LEVELS = (1 << (END_BITS - 1)) - 1

DIRECTION = 0
LATTICE8 = 1
LATTICE16 = 2
WIDE = 3


class Kind:
    """Coding of a fiblet's points (two bits of the record). Compiled code takes the module's constants."""

    DIRECTION = DIRECTION  # constant step, one direction byte a point in a propagated frame (paper, sections 3.2, 3.3)
    LATTICE8 = LATTICE8  # one byte: step between points of an integer lattice, mixed radix
    LATTICE16 = LATTICE16  # the same in two bytes
    WIDE = WIDE  # the same in 1-4 bytes, with a 20-byte box in the code stream; or plain, without: 12 bytes; or splines


@dataclass(frozen=True)
class Field:
    """One bit field of the record: ``width`` bits at ``shift`` in column ``word`` of ``array``."""

    name: str
    array: str
    word: int
    shift: int
    width: int

    @property
    def mask(self) -> int:
        """Largest value that the field holds."""
        return (1 << self.width) - 1


FIELDS: dict[str, Field] = {
    f.name: f
    for f in (
        Field("anchor_x", "anchors", 0, 0, 16),
        Field("anchor_y", "anchors", 0, 16, 16),
        Field("anchor_z", "anchors", 1, 0, 16),
        Field("rank", "anchors", 1, 16, 14),
        Field("begin", "anchors", 1, 30, 1),
        Field("end", "anchors", 1, 31, 1),
        Field("shape", "decoding", 0, 0, 32),
        Field("code", "decoding", 1, 0, 22),
        Field("step", "decoding", 1, 22, 10),
        Field("point", "decoding", 2, 0, 20),
        Field("last", "decoding", 2, 20, 6),
        Field("cap", "decoding", 2, 26, 4),
        Field("kind", "decoding", 2, 30, 2),
    )
}
"""Fields by name. ``last`` is the index of the last point (count - 1); ``rank``, ``code`` and ``point`` are relative to
the page; ``shape`` is the first direction (two snorm16), the lattice box, or a spline's first slope; ``step`` is an
index between the file's least and greatest step, or lattice box and byte width, or SPLINE + 8 * number of nodes;
``cap`` is a cap angle's index, or the lattice's halvings."""

WORDS = {name: 1 + max(f.word for f in FIELDS.values() if f.array == name) for name in ("anchors", "decoding")}
"""Words (uint32) of a fiblet in ``anchors`` and in ``decoding``: columns of these arrays."""


def coded_kind(decoding: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return the kinds of records, with SPLINE for fiblets of splines."""
    kind = unpack("kind", decoding)
    return np.where((kind == WIDE) & (unpack("step", decoding) & 7 == SPLINE), np.uint32(SPLINE), kind)


def code_bytes(decoding: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return the bytes of codes of each fiblet, ``(n,)`` int64, from its ``decoding`` words ``(n, 3)``."""
    kind, step, last = (unpack(name, decoding).astype(np.int64) for name in ("kind", "step", "last"))
    width = np.where(kind == WIDE, step & 7, kind)
    return np.select(
        [kind == DIRECTION, (kind == WIDE) & (width == 0), width == SPLINE, kind == WIDE],
        [np.maximum(last - 1, 0), last * PLAIN_BYTES, (step >> 3) * NODE_BYTES, WIDE_HEADER + last * width],
        last * width,
    )


def unpack(name: str, words: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Take one field out of its array."""
    field = FIELDS[name]
    return (words[..., field.word] >> np.uint32(field.shift)) & np.uint32(field.mask)


def pack(array: str, **values: Any) -> np.ndarray[Any, Any]:
    """Build ``anchors`` or ``decoding`` words from field values."""
    fields = [f for f in FIELDS.values() if f.array == array]
    if set(values) != {f.name for f in fields}:
        raise ValueError(f"pack({array!r}) needs exactly the fields {[f.name for f in fields]}, got {sorted(values)}")
    columns = {name: np.atleast_1d(np.asarray(value, np.int64)) for name, value in values.items()}
    n = max(len(c) for c in columns.values())
    words = np.zeros((n, WORDS[array]), np.uint32)
    for f in fields:
        column = columns[f.name]
        if column.size and (column.min() < 0 or column.max() > f.mask):
            raise ValueError(f"{f.name} holds 0..{f.mask}, got {column.min()}..{column.max()}")
        words[:, f.word] |= (column.astype(np.uint64) << np.uint64(f.shift)).astype(np.uint32)
    return words


def pack_ends(vectors: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Build the words of ``ends``."""
    levels = np.asarray(vectors, np.int64).reshape(-1, 3)
    if levels.size and np.abs(levels).max() > END_LEVELS:
        raise ValueError(f"an end vector holds -{END_LEVELS}..{END_LEVELS}, got {levels.min()}..{levels.max()}")
    bits = (levels & ((1 << END_BITS) - 1)) << (END_BITS * np.arange(3))
    return bits.sum(axis=1).astype(np.uint32)


def unpack_ends(words: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Undo :func:`pack_ends`."""
    levels = (np.asarray(words, np.int64)[:, None] >> (END_BITS * np.arange(3))) & ((1 << END_BITS) - 1)
    return np.where(levels > END_LEVELS, levels - (1 << END_BITS), levels)


def glsl_source() -> str:
    """Write the record as GLSL: constants, and one function a field."""
    lines = [
        f"const uint FIBLET_MAX_POINTS = {MAX_POINTS}u;",
        f"const uint FIBLET_PAGE_BITS = {PAGE_BITS}u;",
        f"const uint FIBLET_CAPS = {CAPS}u;",
        f"const float FIBLET_DIRECTION_SCALE = {DIRECTION_SCALE};",
        f"const float FIBLET_STEP_LEVELS = {float(STEP_LEVELS)};",
        f"const uint FIBLET_WIDE_HEADER = {WIDE_HEADER}u;",
        f"const uint FIBLET_PLAIN_BYTES = {PLAIN_BYTES}u;",
        f"const uint FIBLET_NODE_BYTES = {NODE_BYTES}u;",
        f"const int FIBLET_NODE_BITS = {NODE_BITS};",
        f"const int FIBLET_SLOPE_BITS = {SLOPE_BITS};",
        f"const int FIBLET_SLOPE_SHIFT = {SLOPE_SHIFT};",
        f"const uint KIND_SPLINE = {SPLINE}u;",
    ]
    lines += [f"const uint FIBLET_{name.upper()}_WORDS = {words}u;" for name, words in WORDS.items()]
    lines += [f"const uint KIND_{name} = {value}u;" for name, value in vars(Kind).items() if name.isupper()]
    for f in FIELDS.values():
        lines.append(
            f"uint fiblet_{f.name}(uvec{WORDS[f.array]} words) "
            f"{{ return bitfieldExtract(words.{'xyz'[f.word]}, {f.shift}, {f.width}); }}"
        )
    parts = ", ".join(f"bitfieldExtract(int(word), {END_BITS * axis}, {END_BITS})" for axis in range(3))
    lines.append(f"ivec3 fiblet_end_vector(uint word) {{ return ivec3({parts}); }}")
    return "\n".join(lines) + "\n"
