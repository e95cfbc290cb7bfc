"""A volume's voxels on the GPU: as one 3-D texture, or where that is not to be had in bricks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...volumes.volume import RaycastVolume
from ..errors import EngineError
from ..gl.bindings import VOLUMES
from ..gl.passes import is_software
from .bricks import MOST_PAGES, BrickLayout, Range, lay_out, pieces, voxels_of_page

_FORMATS: dict[Any, tuple[str, float, float]] = {
    np.uint8: ("f1", 255.0, 0.0),
    np.uint16: ("nu2", 65535.0, 0.0),
    np.int16: ("nu2", 65535.0, -32768.0),
    np.float32: ("f4", 1.0, 0.0),
}
"""moderngl's type, and what takes what a shader reads to values: times the first, plus the second."""

UNLIMITED = 2.0**62  # voxels of a texture where nothing is known of a limit

_BYTES = {"f1": 1, "nu2": 2, "f4": 4}


@dataclass(frozen=True)
class Limits:
    """What an OpenGL's textures take at the most."""

    cube: int  # texels along each axis of 3-D ones
    side: int  # texels along each axis of layers, and their number
    layers: int
    voxels: float = UNLIMITED  # of one texture

    @classmethod
    def from_context(cls, ctx: moderngl.Context) -> Limits:
        """Ask a context."""
        return cls(
            int(ctx.info["GL_MAX_3D_TEXTURE_SIZE"]),
            int(ctx.info["GL_MAX_TEXTURE_SIZE"]),
            int(ctx.info["GL_MAX_ARRAY_TEXTURE_LAYERS"]),
        )


class VolumeTexture:
    """The voxels.

    They are handed over piece by piece: of arrays that lie in memory as textures do, and of memory maps, the host holds
    nothing else beside the volume.
    """

    def __init__(self, ctx: moderngl.Context, volume: RaycastVolume, limits: Limits | None = None) -> None:
        self._ctx = ctx
        limits = Limits.from_context(ctx) if limits is None else limits
        voxels = volume.values
        # Mesa interpolates bytes to bytes: surfaces would lie on stairs.
        kept = np.uint16 if voxels.dtype == np.uint8 and is_software(ctx) else voxels.dtype.type
        # A value is what a shader reads times the scale, plus the shift
        self.kind, self.scale, self.shift = _FORMATS[kept]  # moderngl's type of the texels
        self._pages: list[Any] = []
        self.layout: BrickLayout | None = None  # how bricks lie; None of one 3-D texture
        whole = volume.n_points
        self._make(volume.shape, limits)
        self.nbytes = _BYTES[self.kind] * (
            whole if self.layout is None else len(self._pages) * int(np.prod(self.layout.page_shape, dtype=np.int64))
        )
        for page in self._pages:
            page.repeat_x = page.repeat_y = False
            if self.layout is None:
                page.repeat_z = False
        try:
            self._fill(voxels)
        except BaseException:
            self.release()
            raise

    @property
    def features(self) -> list[str]:
        """Of programs that read it."""
        if self.layout is None:
            return []
        return ["VOLUME_BRICKS", *(["VOLUME_PAGES"] if len(self._pages) > 1 else [])]

    def _make(self, shape: tuple[int, int, int], limits: Limits) -> None:
        """Allocate one texture, or as few as this OpenGL gives."""
        whole = int(np.prod(shape, dtype=np.int64))
        if max(shape) <= limits.cube and whole <= limits.voxels and self._allocated(shape, 1, layers=False):
            return
        fits = False
        for pages in range(1, MOST_PAGES + 1):
            most = min(limits.voxels, voxels_of_page(shape, limits.side, limits.layers, pages))
            self.layout = lay_out(shape, limits.side, limits.layers, most)
            if self.layout is None:
                continue
            fits = True
            if self._allocated(self.layout.page_shape, self.layout.pages, layers=True):
                return
        size = " x ".join(map(str, shape))
        if fits:
            raise EngineError(
                f"no memory for a volume of {size} voxels ({whole * _BYTES[self.kind]} bytes) in one texture or "
                f"{MOST_PAGES}; take every second voxel, or a part of it"
            )
        raise EngineError(
            f"a volume of {size} voxels is more than {MOST_PAGES} of this OpenGL's textures take, each of "
            f"{limits.layers} layers of {limits.side} x {limits.side}; take every second voxel, or a part of it"
        )

    def _allocated(self, shape: tuple[int, int, int], count: int, *, layers: bool) -> bool:
        """Make so many textures, or none."""
        make = self._ctx.texture_array if layers else self._ctx.texture3d
        for _ in range(count):
            try:
                self._pages.append(make(shape, 1, None, alignment=1, dtype=self.kind))
            except moderngl.Error:
                break
            if self._ctx.error != "GL_NO_ERROR":  # moderngl says nothing of it
                break
        else:
            return True
        self.release()
        return False

    def _fill(self, voxels: npt.NDArray[Any]) -> None:
        axis = int(np.argmax(np.abs(voxels.strides)))  # along which slices lie together in memory
        if self.layout is None:
            nx, ny, nz = voxels.shape
            bricks = iter([(0, (0, 0), (slice(0, nx), slice(0, ny), slice(0, nz)))])
        else:
            bricks = self.layout.bricks()
        for page, corner, box in bricks:
            for piece in pieces(box, axis):
                self._write(self._pages[page], corner, box, piece, voxels[piece])

    def _write(self, page: Any, corner: tuple[int, int], box: Range, piece: Range, voxels: npt.NDArray[Any]) -> None:
        if voxels.dtype == np.int16:
            voxels = (voxels.astype(np.int32) + 32768).astype(np.uint16)
        elif voxels.dtype == np.uint8 and self.kind == "nu2":
            voxels = voxels.astype(np.uint16)
        x, y, z = (part.start - whole.start for part, whole in zip(piece, box, strict=True))
        data = np.ascontiguousarray(voxels.transpose(2, 1, 0))
        page.write(data, viewport=(corner[0] + x, corner[1] + y, z, *voxels.shape), alignment=1)

    def bind(self, program: moderngl.Program) -> None:
        """Bind it, and tell a program where it is."""
        for k, page in enumerate(self._pages):
            page.use(VOLUMES[_name(k)])
        for k in range(MOST_PAGES):
            if _name(k) in program:
                program[_name(k)] = VOLUMES[_name(k if k < len(self._pages) else 0)]
        if self.layout is not None:
            for name, value in (
                ("brick_step", self.layout.steps),
                ("brick_count", self.layout.counts),
                ("brick_size", self.layout.size[:2]),
                ("bricks_in_page", self.layout.in_page),
            ):
                if name in program:
                    program[name] = value

    def filter(self, linear: bool) -> None:
        """Choose how it is sampled."""
        kind = moderngl.LINEAR if linear else moderngl.NEAREST
        for page in self._pages:
            page.filter = kind, kind

    def release(self) -> None:
        """Give it back; twice is harmless."""
        for page in self._pages:
            page.release()
        self._pages.clear()


class ColourTexture:
    """The voxels' own colours."""

    def __init__(self, ctx: moderngl.Context, colours: npt.NDArray[np.uint8]) -> None:
        nx, ny, nz = colours.shape[:3]
        limit = Limits.from_context(ctx).cube
        size = f"{nx} x {ny} x {nz} voxels"
        if max(nx, ny, nz) > limit:
            raise EngineError(
                f"a volume of {size} with colours has more than {limit} along an axis, the most of this OpenGL's "
                "textures; take every second voxel, a part of it, or one number for each voxel"
            )
        try:
            self._texture = ctx.texture3d((nx, ny, nz), 3, None, alignment=1, dtype="f1")
        except moderngl.Error as error:
            raise EngineError(f"no memory for the colours of {size}: {error}") from error
        if ctx.error != "GL_NO_ERROR":
            self.release()
            raise EngineError(f"no memory for the colours of {size}")
        self._texture.repeat_x = self._texture.repeat_y = self._texture.repeat_z = False
        axis = int(np.argmax(np.abs(colours.strides[:3])))
        for piece in pieces((slice(0, nx), slice(0, ny), slice(0, nz)), axis):
            part = colours[piece]
            start = tuple(cut.start for cut in piece)
            data = np.ascontiguousarray(part.transpose(2, 1, 0, 3))
            self._texture.write(data, viewport=(*start, *part.shape[:3]), alignment=1)
        self.nbytes = 3 * nx * ny * nz

    def bind(self, program: moderngl.Program) -> None:
        """Bind it, if a program looks at it, and tell where it is."""
        if "voxel_colours" in program:
            self._texture.use(VOLUMES["voxel_colours"])
            program["voxel_colours"] = VOLUMES["voxel_colours"]

    def filter(self, linear: bool) -> None:
        """Choose how it is sampled."""
        kind = moderngl.LINEAR if linear else moderngl.NEAREST
        self._texture.filter = kind, kind

    def release(self) -> None:
        """Give it back; twice is harmless."""
        self._texture.release()


def _name(page: int) -> str:
    return "voxels" if page == 0 else f"voxels_{page}"
