"""A volume that gives every decoded point its value: sampled on the GPU, so that no point stores a byte.

A value at a point is that of the volume there: trilinear between the centres of eight voxels, or that of the nearest
voxel where numbers are names (labels). A voxel reaches half a voxel around its centre; in the outer half of the
outermost voxels their own values go on. Outside the volume, and where a voxel that has a part in it is NaN, the value
is NaN. Infinite voxels stay infinite. Between two points of a streamline the value is interpolated as of every
per-point array; of labels, and next to NaN, the nearer point's counts.

What the GPU holds, and what that costs in precision:

=============================  ============================  =====================================================
array                          texture                       error of a voxel's value
=============================  ============================  =====================================================
bool, integers spanning < 256  r8, normalised                none
integers spanning < 65,536     r16, normalised               none
other integers up to 2^24      r32f                          none
float16                        r16f                          none
other floats                   r32f                          2^-24 of the value
=============================  ============================  =====================================================

The matrix from local millimetres to voxels is composed in float64 for each picture; sampling then works in float32 with
weights of full precision, where a texture unit's own filter has weights of eight bits.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from pvfiblets.images.sampling import sample

from ....support.value_reference import relative, value_reference
from ...errors import EngineError, GPUMemoryError
from ...gl.bindings import BLOCKS, SAMPLED
from ...gl.uniform_struct import Field, UniformStruct

SAMPLING_BLOCK = UniformStruct(
    "Sampling",
    Field("voxel_from_local", "mat4", "voxel indices of (local mm, 1)"),
    Field("volume_shape", "vec3", "voxels along each axis"),
    Field("volume_nearest", "int", "1: the nearest voxel's value; 0: between eight voxels"),
    Field("volume_least", "float", "value of texel 0"),
    Field("volume_per_unit", "float", "value per texel unit"),
    Field("volume_whole", "int", "1: values are whole numbers of units"),
)
LARGEST_WHOLE = 2**24  # up to here float32 holds every whole number

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class VolumeSource:
    """Numbers on a regular grid, as a per-point value (`FibletStyle.values`).

    Two sources are the same only if they are one object: make another one to have a changed array looked at again.
    """

    # `(i, j, k)` of bool, integers or floats, none of the sides 0. Not copied, and not to be changed.
    values: npt.NDArray[Any]
    # `(4, 4)` float64: voxel indices (voxel centres lie at whole numbers) to the fiblets' coordinates in mm
    affine: Array
    # whether a point takes the nearest voxel's value, as labels need it. By default integers and bool do, and floats
    # are interpolated.
    nearest: bool | None = None
    name: str = "volume"  # for people
    voxels: Array = field(init=False, repr=False)  # (4, 4) mm to voxel indices

    def __post_init__(self) -> None:
        values, affine = np.asarray(self.values), np.array(self.affine, np.float64)
        if values.ndim != 3 or values.size == 0:
            raise ValueError(f"the volume has shape {values.shape}; give one array of three axes (i, j, k)")
        if values.dtype.kind not in "buif":
            raise ValueError(f"the volume is of type {values.dtype}; give bool, integers or floats")
        if affine.shape != (4, 4) or not np.isfinite(affine).all() or not np.array_equal(affine[3], (0, 0, 0, 1)):
            raise ValueError(
                f"the volume's affine is {affine.tolist()}; give a finite (4, 4) matrix from voxels to mm that ends in "
                "the row (0, 0, 0, 1)"
            )
        try:
            voxels = np.linalg.inv(affine)
        except np.linalg.LinAlgError:
            voxels = np.full((4, 4), np.nan)
        if not np.isfinite(voxels).all():
            raise ValueError(f"the volume's affine {affine.tolist()} flattens space; give an invertible one")
        if values.dtype.kind in "ui":
            low, high = int(values.min()), int(values.max())
            middle = round(value_reference(values))
            if high - low > 65535 and max(middle - low, high - middle) > LARGEST_WHOLE:
                raise ValueError(
                    f"the volume's integers run from {low} to {high}; beyond {LARGEST_WHOLE} float32 cannot tell them "
                    "apart: number the labels anew, or give floats"
                )
        affine.flags.writeable = False
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "affine", affine)
        object.__setattr__(self, "voxels", voxels)
        if self.nearest is None:
            object.__setattr__(self, "nearest", values.dtype.kind in "bui")

    def at(self, points: npt.ArrayLike) -> Array:
        """Return the values at points ``(n, 3)`` in mm, ``(n,)`` float64, by the rules of the picture."""
        return sample(self.values, self.voxels, points, nearest=bool(self.nearest))

    @cached_property
    def range(self) -> tuple[float, float]:
        """Least and greatest finite value; (0, 0) where there is none."""
        low, high = np.inf, -np.inf
        for slab in self.values:  # a copy of the whole would double the memory
            finite = slab[np.isfinite(slab)]
            if finite.size:
                low, high = min(low, float(finite.min())), max(high, float(finite.max()))
        return (low, high) if low <= high else (0.0, 0.0)

    @cached_property
    def reference(self) -> float:
        """Offset that graphics cards subtract from the values first (`pvfiblets.support.value_reference`)."""
        return value_reference(self.values)

    @cached_property
    def least_positive(self) -> float:
        """Least finite value above zero, where a logarithmic scale may begin; 1e-6 where there is none."""
        least = np.inf
        for slab in self.values:
            kept = slab[np.isfinite(slab) & (slab > 0)]
            if kept.size:
                least = min(least, float(kept.min()))
        return least if np.isfinite(least) else 1e-6

    @cached_property
    def distinct(self) -> int:
        """Number of different values, NaN not counted."""
        found: npt.NDArray[Any] = np.unique(np.concatenate([np.unique(slab) for slab in self.values]))
        return int((found == found).sum())  # NaN differs from itself


def _texels(source: VolumeSource) -> tuple[npt.NDArray[Any], str, float, float]:
    """Return what the texture holds, its dtype for moderngl, and the value less reference of texel 0 and per unit."""
    values = source.values
    if values.dtype.kind == "f":
        if values.dtype == np.float16:
            return values, "f2", 0.0, 1.0
        with np.errstate(over="ignore"):  # beyond float32's range lies infinity
            return _less(values, source.reference), "f4", 0.0, 1.0
    if values.dtype.kind == "b":
        return values.view(np.uint8), "nu1", 0.0, 255.0
    low, high = int(values.min()), int(values.max())
    if high - low > 65535:
        return _less(values, source.reference), "f4", 0.0, 1.0
    small, dtype, scale = (np.uint8, "nu1", 255.0) if high - low < 256 else (np.uint16, "nu2", 65535.0)
    # Differences wrap around in the array's own type and come out right in the smaller one.
    return (values - values.dtype.type(low)).astype(small), dtype, low - source.reference, scale


def _less(values: npt.NDArray[Any], reference: float) -> npt.NDArray[np.float32]:
    """Return values less a reference as float32; most need none, and no copy as float64."""
    return (relative(values, reference) if reference else values).astype("<f4")


class VolumeTexture:
    """One volume on the GPU, and where it lies in the picture's local coordinates."""

    def __init__(self, ctx: moderngl.Context, source: VolumeSource) -> None:
        self.source = source
        shape = source.values.shape
        limit = int(ctx.info["GL_MAX_3D_TEXTURE_SIZE"])
        if max(shape) > limit:
            raise EngineError(
                f"the volume has {' x '.join(map(str, shape))} voxels; this OpenGL's 3-D textures have sides of at "
                f"most {limit}: crop or resample it"
            )
        texels, dtype, self._low, self._scale = _texels(source)
        self._whole = dtype.startswith("nu")
        self.nbytes = texels.nbytes + SAMPLING_BLOCK.nbytes
        data = np.ascontiguousarray(texels.T)  # i runs fastest
        try:
            self._texture = ctx.texture3d((shape[0], shape[1], shape[2]), 1, data, alignment=1, dtype=dtype)
        except (moderngl.Error, MemoryError) as error:
            raise GPUMemoryError(f"no GPU memory for {texels.nbytes} bytes of a volume: {error}") from error
        if (problem := ctx.error) != "GL_NO_ERROR":
            self._texture.release()
            raise GPUMemoryError(f"no GPU memory for {texels.nbytes} bytes of a volume: {problem}")
        self._texture.filter = moderngl.NEAREST, moderngl.NEAREST
        self._block = ctx.buffer(reserve=SAMPLING_BLOCK.nbytes)

    def bind(self, to_data: Array) -> None:
        """Set the map from the picture's local coordinates to the volume, and bind both."""
        self._block.write(
            SAMPLING_BLOCK.pack(
                voxel_from_local=self.source.voxels @ to_data,
                volume_shape=self.source.values.shape,
                volume_nearest=bool(self.source.nearest),
                volume_least=self._low,
                volume_per_unit=self._scale,
                volume_whole=self._whole,
            )
        )
        self._block.bind_to_uniform_block(BLOCKS["Sampling"])
        self._texture.use(SAMPLED["sampled_volume"])

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._texture.release()
        self._block.release()
