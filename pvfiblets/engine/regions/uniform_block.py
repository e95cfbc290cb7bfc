"""Regions on the GPU: the uniform block ``Regions``, and the distance fields that it refers to.

A leaf's map from data mm is composed with the reference anchor of the local coordinates in float64, so that float32
rounds relative to positions near that reference (:mod:`pvfiblets.engine.frame`). Every classification in the shaders is
conservative: anything within rounding counts as undecided. ``shaders/regions/block.glsl`` explains the symbols.

Budget: the block takes 5.3 KiB of the 16 that OpenGL promises. A surface's field takes about 64^3 texels of 4 bytes,
1 MB; a label volume's one for each voxel.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...query.regions.region import MAX_LEAVES, MAX_OPS
from ...query.regions.shapes import LABELS, SURFACE
from ..errors import GPUMemoryError
from ..gl.bindings import BLOCKS, REGIONS
from ..gl.uniform_struct import Field, UniformStruct

if TYPE_CHECKING:
    from ...query.regions.fields import Field as DistanceField
    from ...query.regions.region import Region
    from ...query.regions.shapes import Shape
    from ..gl.moderngl_extras import GLExtras

UNDECIDED = -1  # kind of a leaf whose numbers float32 cannot hold: nothing is ever sure about it

REGIONS_BLOCK = UniformStruct(
    "Regions",
    Field("region_words", "int", "of the program"),
    Field("region_program", f"ivec4[{MAX_OPS // 4}]", "postfix, by fours: a leaf, or one of the words below"),
    Field("region_kinds", f"int[{MAX_LEAVES}]", "of leaves"),
    Field("region_rows", f"vec4[{3 * MAX_LEAVES}]", "three rows a leaf: u = xyz . p + w"),
    Field("region_slopes", f"vec3[{MAX_LEAVES}]", "change of u per mm: lengths of the rows"),
    Field("region_whole_slopes", f"float[{MAX_LEAVES}]", "change of u as a whole, at most, in the field's units"),
    Field("region_slacks", f"vec3[{MAX_LEAVES}]", "slack that does not depend on p"),
    Field("region_field_corners", f"ivec3[{MAX_LEAVES}]", "first texel of a leaf's field"),
    Field("region_field_shapes", f"ivec3[{MAX_LEAVES}]", "texels along each axis"),
    Field("region_field_steps", f"vec3[{MAX_LEAVES}]", "units of the field from texel to texel"),
)

_LARGEST = 1e30  # float32 squares are taken of positions, not of these
_LEAST = float(np.finfo(np.float32).tiny)  # smaller numbers may be flushed to 0
_UP = 1.0 + 4.0 * float(np.finfo(np.float32).eps)

Array = npt.NDArray[np.float64]
Corner = tuple[int, int, int]


def region_features(region: Region) -> tuple[str, ...]:
    """Features of programs that look at a region."""
    return ("CLIP_REGION", "REGION_FIELDS") if _fields_of(region) else ("CLIP_REGION",)


def region_block(region: Region, to_data: Array, corners: Sequence[Corner] = ()) -> bytes:
    """Pack the ``Regions`` uniform block (std140)."""
    block: npt.NDArray[Any] = np.zeros((), REGIONS_BLOCK.dtype)
    block["region_words"] = len(region.program)
    block["region_program"].reshape(-1)[: len(region.program)] = region.program
    fields = dict(zip((id(field) for field in _fields_of(region)), corners, strict=True))
    for k, leaf in enumerate(region.leaves):
        _pack_leaf(block, k, leaf, to_data[:3, 3], fields)
    return block.tobytes()


def _pack_leaf(block: npt.NDArray[Any], k: int, leaf: Shape, offset: Array, corners: dict[int, Corner]) -> None:
    """Fill the rows of one leaf; ``offset`` are the data mm of local 0."""
    linear, shift = leaf.linear, offset - leaf.centre
    # What float64 may have lost: in positions of the data, in the centre, in the map's own numbers.
    lost = 16.0 * np.finfo(np.float64).eps * np.abs(linear) @ (np.abs(offset) + np.abs(leaf.centre))
    moved = linear @ shift
    kind, steps = leaf.kind, np.ones(3)
    if (field := leaf.field) is not None:
        # Unit coordinates count in voxels, or mm, from somewhere; texels from the field's first.
        steps = np.asarray(field.steps, np.float64)
        lost = lost + 2.0 * np.finfo(np.float64).eps * np.abs(field.origin)
        linear, moved = linear / field.spacing[:, None], (moved - field.origin) / field.spacing
        lost = lost / field.spacing
        kind = LABELS if field.whole else SURFACE  # of blocks of voxels no sign alone is sure
        block["region_field_corners"][k, :3] = corners[id(field)]
        block["region_field_shapes"][k, :3] = field.values.shape[::-1]
        block["region_field_steps"][k, :3] = steps
    values = np.concatenate([linear, moved[:, None]], axis=1)
    slopes, whole = np.linalg.norm(linear, axis=1), float(np.linalg.norm(linear * steps[:, None], 2))
    largest = max(np.abs(values).max(), slopes.max(), whole, lost.max())
    good = bool(np.isfinite(values).all() and largest < _LARGEST)
    block["region_kinds"][k, 0] = kind if good else UNDECIDED
    if good:
        block["region_rows"][3 * k : 3 * k + 3] = values
        block["region_slopes"][k, :3] = slopes * _UP + _LEAST
        block["region_whole_slopes"][k, 0] = whole * _UP + _LEAST
        block["region_slacks"][k, :3] = lost * _UP + 4.0 * _LEAST


def _fields_of(region: Region) -> list[DistanceField]:
    """Fields of a region's leaves, each once."""
    fields = {id(leaf.field): leaf.field for leaf in region.leaves if leaf.field is not None}
    return list(fields.values())


class FieldTextures:
    """Distance fields in one texture (r32f, three dimensions), kept while they stay the same.

    They are laid above one another along z, as far as the texture may reach, and then in another such stack along x.
    """

    def __init__(self, ctx: moderngl.Context, largest: int) -> None:
        self._ctx = ctx
        self._largest = largest  # texels along one axis
        self._fields: list[DistanceField] = []
        self._texture: moderngl.Texture3D | None = None
        self.corners: list[Corner] = []

    @property
    def nbytes(self) -> int:
        """Bytes on the GPU."""
        return 0 if self._texture is None else 4 * int(np.prod(self._texture.size))

    def update(self, fields: Sequence[DistanceField]) -> None:
        """Make the texture of some fields, unless it is there."""
        if len(fields) == len(self._fields) and all(a is b for a, b in zip(fields, self._fields, strict=True)):
            return
        self.release()
        if not fields:
            return
        shapes = [field.values.shape[::-1] for field in fields]
        corners, size = _stacked(shapes, self._largest)
        try:
            texture = self._ctx.texture3d(size, 1, dtype="f4", alignment=4)
        except moderngl.Error as error:
            raise GPUMemoryError(f"no GPU memory for {size} texels of distance fields: {error}") from error
        if (problem := self._ctx.error) != "GL_NO_ERROR":
            texture.release()
            raise GPUMemoryError(f"no GPU memory for {size} texels of distance fields: {problem}")
        texture.filter = moderngl.NEAREST, moderngl.NEAREST
        texture.repeat_x = texture.repeat_y = texture.repeat_z = False
        for field, corner, shape in zip(fields, corners, shapes, strict=True):
            texture.write(np.ascontiguousarray(field.values, "<f4"), viewport=(*corner, *shape))
        self._texture, self.corners, self._fields = texture, corners, list(fields)

    def bind(self) -> None:
        """Bind the texture to its unit."""
        if self._texture is not None:
            self._texture.use(REGIONS["region_fields"])

    def release(self) -> None:
        """Give the texture back; twice is harmless."""
        if self._texture is not None:
            self._texture.release()
        self._texture, self.corners, self._fields = None, [], []


def _stacked(shapes: Sequence[tuple[int, ...]], largest: int) -> tuple[list[Corner], Corner]:
    """First texel of each block of some sizes, and the size of all."""
    corners: list[Corner] = []
    x = z = across = height = depth = 0
    for nx, ny, nz in shapes:
        if z + nz > largest:
            x, z, across = x + across, 0, 0
        corners.append((x, 0, z))
        z, across = z + nz, max(across, nx)
        height, depth = max(height, ny), max(depth, z)
    size = x + across, height, depth
    if max(size) > largest:
        raise GPUMemoryError(
            f"the region's distance fields of {' + '.join(map(str, shapes))} texels need a texture of {size}; this "
            f"OpenGL has at most {largest} along each axis: use fewer or smaller label volumes"
        )
    return corners, size


class RegionBlock:
    """A region on one context: its uniform block and its fields, brought up to date when either changed."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras) -> None:
        self._ctx = ctx
        self._gl = gl
        self._buffer: moderngl.Buffer | None = None
        self._packed = b""
        self._textures = FieldTextures(ctx, int(ctx.info["GL_MAX_3D_TEXTURE_SIZE"]))
        self.features: tuple[str, ...] = ()  # of programs that look at the region; none while there is none

    @property
    def nbytes(self) -> int:
        """Bytes on the GPU."""
        return self._textures.nbytes + (0 if self._buffer is None else REGIONS_BLOCK.nbytes)

    def write(self, region: Region, to_data: Array) -> None:
        """Bring block and fields up to date, and bind the block."""
        self._textures.update(_fields_of(region))
        packed = region_block(region, to_data, self._textures.corners)
        if self._buffer is None:
            self._buffer = self._ctx.buffer(reserve=REGIONS_BLOCK.nbytes)
        if packed != self._packed:
            self._buffer.write(packed)
            self._packed = packed
        self.features = region_features(region)
        self._buffer.bind_to_uniform_block(BLOCKS["Regions"])

    def bind(self, program: Any = None) -> None:
        """Bind block and fields, and tell a program, if one is given, where the fields are."""
        if self._buffer is not None:
            self._buffer.bind_to_uniform_block(BLOCKS["Regions"])
        self._textures.bind()
        if program is not None and "REGION_FIELDS" in self.features:
            self._gl.set_sampler(program, "region_fields", REGIONS["region_fields"])

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        self._textures.release()
        if self._buffer is not None:
            self._buffer.release()
        self._buffer, self._packed, self.features = None, b"", ()
