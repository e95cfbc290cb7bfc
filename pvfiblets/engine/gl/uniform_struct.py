"""Uniform blocks, each declared once: its layout in NumPy and its text in GLSL come from the same fields.

>>> LAMP = UniformStruct("Lamp", Field("lamp_place", "vec3", "mm"), Field("lamp_power", "float", "W"))  # doctest: +SKIP
>>> buffer.write(LAMP.pack(lamp_place=(0.0, 0.0, 1.0), lamp_power=5.0))                               # doctest: +SKIP

Shaders write ``#include "uniforms/Lamp.glsl"`` and use the names. Layout is std140 (OpenGL 4.6 core, section 7.6.2.2),
which all drivers share: a vec3 takes the place of a vec4, but for a scalar that may follow in its last word; each
element of an array, and each column of a matrix, takes 16 bytes. Where that wastes too much, numbers are packed by
fours into an array of vec4.

A block belongs to the module that packs it. :data:`MODULES` names these, so that a shader finds a block before anybody
has packed it, and nothing is imported for a program that has no such block.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from importlib import import_module
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..errors import EngineError
from .bindings import BLOCKS

if TYPE_CHECKING:
    import moderngl

MODULES = {
    "Chunk": "fiblets.data.chunks",
    "ClipPlanes": "clipping",
    "Coding": "fiblets.data.uniform_blocks",
    "Frame": "frame",
    "Halos": "halos.uniform_blocks",
    "Raycast": "volumes.uniform_blocks",
    "Rays": "regions.convex_rays",
    "Regions": "regions.uniform_block",
    "Rotations": "fiblets.data.uniform_blocks",
    "Sampling": "fiblets.data.sampled_volume",
    "Splines": "tubes.uniform_blocks",
    "Tubes": "fiblets.line_tubes",
}
"""Modules of the engine, by the names of the blocks that they pack."""

LARGEST = 16384  # bytes that OpenGL promises to a uniform block

_TYPE = re.compile(
    r"(?:(?P<scalar>float|int|uint)|(?P<of>[iu]?)vec(?P<lanes>[234])|mat(?P<columns>[34]))(?:\[(?P<count>[1-9]\d*)\])?"
)
_SCALARS = {"float": "<f4", "int": "<i4", "uint": "<u4", "": "<f4", "i": "<i4", "u": "<u4"}


class UniformStructError(ValueError):
    """A field's type is none of GLSL's, or a value does not fit its field."""


@dataclass(frozen=True)
class Field:
    """One quantity of a block."""

    name: str  # in GLSL, where it is global to a program: begin it with what the block is about
    # `float`, `int`, `uint`, `vec2` to `vec4` and their kin of integers (`ivec3`, `uvec4`), `mat3` or `mat4`, and
    # arrays of these, `vec4[6]`
    type: str
    doc: str  # its meaning and unit: a line, which GLSL gets as a comment

    def __post_init__(self) -> None:
        if not re.fullmatch(r"[a-z]\w*", self.name, re.ASCII):
            raise UniformStructError(f"{self.name!r} is no name of a field; give letters, digits and underscores")
        if not _TYPE.fullmatch(self.type):
            raise UniformStructError(
                f"{self.name}: {self.type!r} is no type of a field; give float, int, uint, vec2 to vec4, ivec2 to "
                "uvec4, mat3 or mat4, or an array such as vec4[6]"
            )
        if not self.doc or "\n" in self.doc:
            raise UniformStructError(f"{self.name}: describe it in one line; its doc is {self.doc!r}")


class _Layout:
    """Where std140 has a field's numbers, counted from the field's start."""

    def __init__(self, kind: str) -> None:
        match = _TYPE.fullmatch(kind)
        assert match is not None
        self.matrix, self.count = match["columns"] is not None, int(match["count"] or 0)
        self.scalar = np.dtype("<f4" if self.matrix else _SCALARS[match["scalar"] or match["of"]])  # of one number
        self.lanes = lanes = int(match["columns"] or match["lanes"] or 1)
        numbers = (lanes, lanes) if self.matrix else (lanes,) if lanes > 1 else ()
        array = (self.count,) if self.count else ()
        padded = self.matrix or bool(self.count)
        # of a value: elements of an array, then rows and columns of a matrix or numbers of a vector
        self.shape = (*array, *numbers)
        # the same in memory, matrices by columns, with the words that std140 leaves empty
        self.stored = (*array, *numbers[:-1], 4) if padded else numbers
        self.alignment = 16 if padded or lanes > 2 else 4 * lanes  # bytes

    @property
    def nbytes(self) -> int:
        return 4 * prod(self.stored)

    def fill(self, stored: npt.NDArray[Any], value: npt.ArrayLike) -> None:
        """Write a value into the words of the field."""
        if type(value) is float and not self.shape and self.scalar.kind == "f":
            stored[...] = value
            return
        given = np.asarray(value)
        if given.dtype.kind not in ("buif" if self.scalar.kind == "f" else "bui"):
            raise UniformStructError(f"cannot hold numbers of type {given.dtype}")
        if given.shape != self.shape:
            fits = self.count and given.shape[1:] == self.shape[1:] and given.ndim == len(self.shape)
            if not fits or len(given) > self.count:
                raise UniformStructError(f"cannot hold an array of shape {given.shape}")
        if self.matrix:
            given = given.swapaxes(-1, -2)
        if self.count:
            stored = stored[: len(given)]
        if len(self.stored) > len(self.shape):  # scalars in an array
            stored = stored[..., 0]
        elif self.stored != self.shape:
            stored = stored[..., : self.lanes]
        stored[...] = given
        if self.scalar.kind != "f" and (stored != given).any():
            raise UniformStructError(f"cannot hold {given.tolist()}")


class UniformStruct:
    """A uniform block."""

    def __init__(self, name: str, *fields: Field) -> None:
        if name not in BLOCKS:
            raise UniformStructError(
                f"the uniform block {name!r} has no binding point; give it a number in BLOCKS of "
                f"pvfiblets/engine/gl/bindings.py, which has {sorted(BLOCKS)}"
            )
        self.name = name  # in GLSL; `.bindings.BLOCKS` has its binding point
        self.fields = {field.name: field for field in fields}  # in the order of memory
        if not fields or len(self.fields) < len(fields):
            raise UniformStructError(f"{name}: give fields of different names, not {[field.name for field in fields]}")
        self._layouts = {field.name: _Layout(field.type) for field in fields}
        offsets, end = [], 0
        for layout in self._layouts.values():
            offsets.append(end + -end % layout.alignment)
            end = offsets[-1] + layout.nbytes
        # with the offsets of std140. Elements of arrays, and columns of matrices, are of four numbers here, the last of
        # which may mean nothing; of arrays of scalars the first counts.
        self.dtype = np.dtype(
            {
                "names": list(self._layouts),
                "formats": [(layout.scalar, layout.stored) for layout in self._layouts.values()],
                "offsets": offsets,
                "itemsize": end + -end % 16,
            }
        )
        if self.nbytes > LARGEST:
            raise UniformStructError(f"{name}: {self.nbytes} bytes; OpenGL promises {LARGEST} to a uniform block")

    @property
    def nbytes(self) -> int:
        """Bytes of the block."""
        return self.dtype.itemsize

    def pack(self, **values: npt.ArrayLike) -> bytes:
        """Lay all fields out."""
        block: npt.NDArray[Any] = np.zeros((), self.dtype)
        if missing := [name for name in self.fields if name not in values]:
            raise UniformStructError(f"{self.name}: no value for {', '.join(missing)}")
        for name, value in values.items():
            self._fill(block, name, value)
        return block.tobytes()

    def write(self, buffer: moderngl.Buffer, **values: npt.ArrayLike) -> None:
        """Write some fields of a block that lies in a buffer; the others stay."""
        block: npt.NDArray[Any] = np.zeros((), self.dtype)
        for name, value in values.items():
            self._fill(block, name, value)
            buffer.write(block[name].tobytes(), offset=self.offset(name))

    def offset(self, name: str) -> int:
        """Return where a field begins, in bytes."""
        self._check(name)
        fields = self.dtype.fields
        assert fields is not None
        return int(fields[name][1])

    def _check(self, name: str) -> None:
        if name not in self.fields:
            raise UniformStructError(f"{self.name} has no field {name!r}; it has {', '.join(self.fields)}")

    def _fill(self, block: npt.NDArray[Any], name: str, value: npt.ArrayLike) -> None:
        self._check(name)
        try:
            self._layouts[name].fill(block[name], value)
        except UniformStructError as error:
            raise UniformStructError(f"{self.name}: {name} is of type {self.fields[name].type}; it {error}") from None

    @property
    def glsl(self) -> str:
        """The block in GLSL of 4.20 or later; for older ones :func:`.shaders.assemble` drops the binding point."""
        lines = [self._declared(field) for field in self.fields.values()]
        width = max(map(len, lines))
        body = "".join(
            f"    {line:{width}}  // {field.doc}\n" for line, field in zip(lines, self.fields.values(), strict=True)
        )
        return f"layout(std140, binding = {BLOCKS[self.name]}) uniform {self.name} {{\n{body}}};\n"

    @staticmethod
    def _declared(field: Field) -> str:
        base, bracket, count = field.type.partition("[")
        return f"{base} {field.name}{bracket}{count};"


def find_struct(name: str) -> UniformStruct:
    """Return a block by its name, from the module that packs it."""
    if name not in MODULES:
        raise EngineError(
            f"no uniform block {name!r} is known; "
            f"MODULES of pvfiblets/engine/gl/uniform_struct.py has {sorted(MODULES)}"
        )
    module = import_module(f"pvfiblets.engine.{MODULES[name]}")
    for thing in vars(module).values():
        if isinstance(thing, UniformStruct) and thing.name == name:
            return thing
    raise EngineError(f"{module.__name__} declares no UniformStruct {name!r}, though MODULES names it")
