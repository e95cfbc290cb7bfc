"""`VolumeRenderer`: one volume on one OpenGL context, ray cast into a G-buffer when something changed."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import moderngl

from ..errors import EngineError
from ..gbuffer import GBuffer
from ..opengl import OpenGL
from ..passes import Passes
from ..shaders import BLOCKS, Programs
from ..view import Style, View
from .nodes import NodeList, takes_means
from .ray_parts import RayCuts
from .tables import Tables
from .targets import Picture
from .textures import VolumeTexture
from .uniform_blocks import CONSTANTS, RayBlock

if TYPE_CHECKING:
    from ...volumes.options import RaycastOptions
    from ...volumes.volume import RaycastVolume

__all__ = ["VolumeRenderer", "VolumeStyle"]

VOXELS_UNIT, OUTSIDE_UNIT, COARSE_UNIT = 10, 14, 16

_OF_MODE = {
    "isosurface": ["VOLUME_SURFACE"],
    "composite": ["VOLUME_LIGHT"],
    "mip": [],
    "local-mip": ["VOLUME_LOCAL"],
}
FEATURES_OF_FILTER = {"nearest": ["VOLUME_NEAREST"], "trilinear": [], "tricubic": ["VOLUME_TRICUBIC"]}
_OF_REFINEMENT = {"none": ["VOLUME_UNREFINED"], "regula-falsi": [], "newton": ["VOLUME_NEWTON"]}
_OF_INTEGRATOR = {
    "adaptive": ["VOLUME_PREINTEGRATED"],  # where that does
    "preintegrated": ["VOLUME_PREINTEGRATED"],
    "exponential": [],
    "riemann": ["VOLUME_RIEMANN"],
    "simpson": ["VOLUME_SIMPSON"],
    "romberg": ["VOLUME_ROMBERG"],
    "rk4": ["VOLUME_RK4"],
}


@dataclass(frozen=True)
class VolumeStyle(Style):
    """How a volume becomes pixels.

    Parameters
    ----------
    values : str, optional
        Not looked at: the value of a voxel stands beside each pixel.
    casting : RaycastOptions
    """

    casting: RaycastOptions = field(kw_only=True)

    @property
    def relief(self) -> str | None:
        """Normals of surfaces."""
        return "normal" if self.casting.mode == "isosurface" else None


class VolumeRenderer:
    """Casts rays through one volume.

    The context must be current in every call. The renderer binds what it needs and leaves it bound; the caller keeps
    its own OpenGL state.

    Parameters
    ----------
    ctx : moderngl.Context
        OpenGL 3.3 or later.
    volume : RaycastVolume
        Copied to the GPU here.

    Attributes
    ----------
    pipeline : str
        ``'rays'``.
    share : float
        1.0: all is drawn.

    Raises
    ------
    EngineError
        If memory does not suffice or the volume is larger than this OpenGL's textures; nothing stays behind on the GPU.

    Notes
    -----
    Source: Lesar, "Real-time ray casting of volumetric data" (2015), section III.
    """

    pipeline = "rays"
    share = 1.0

    def __init__(self, ctx: moderngl.Context, volume: RaycastVolume) -> None:
        self._ctx, self._volume = ctx, volume
        self._gl = OpenGL(ctx)
        self._passes = Passes(ctx)
        self._programs = Programs(ctx, CONSTANTS)
        self._nodes = NodeList(ctx, self._gl, volume)
        self._tables = Tables(ctx, volume)
        self._cuts = RayCuts(ctx, self._gl, self._programs, volume)
        self._voxels: VolumeTexture | None = None
        self._block: RayBlock | None = None
        self._picture: Picture | None = None
        self._coarse: Picture | None = None
        self._features: list[str] = []
        self._made: tuple[View, Style] | None = None
        self._generation = 0
        try:
            self._voxels = VolumeTexture(ctx, volume)
            self._block = RayBlock(ctx, volume, (self._voxels.scale, self._voxels.shift))
        except BaseException:
            self.release()
            raise

    def render(self, view: View, style: Style, *, outside: moderngl.Texture | None = None) -> GBuffer:
        """Draw, unless the last picture was of the same view and style, without an outside.

        Parameters
        ----------
        view : View
            Its region cuts in all modes.
        style : VolumeStyle
        outside : moderngl.Texture, optional
            r32ui keys of what is opaque in the picture: rays end there.

        Returns
        -------
        GBuffer
            The renderer's own; the same object until the size or the mode changes. ``owner`` holds the nearest voxel
            of what shows, counted along the first axis first; ``position`` the place along the ray (mm) and the
            value; ``across`` normals of surfaces; ``colours`` those of ``'composite'``.

        Raises
        ------
        EngineError
            After :meth:`release`, or if the picture is too large.
        TypeError
            If the style does not say how to cast.
        ValueError
            If the view's region holds a label volume.
        """
        if not isinstance(style, VolumeStyle):
            raise TypeError(f"style is a {type(style).__name__}; volumes need a VolumeStyle")
        voxels, block = self._alive()
        if self._picture is not None and outside is None and self._made == (view, style):
            return self._picture.buffer
        self._made = None
        casting = style.casting
        self._nodes.make(casting)
        self._tables.make(casting, block.step_mm(casting))
        with self._gl.framebuffers_kept(), self._programs.noting() as noted:
            sparse = casting.sparse > 1
            self._picture = self._fitting(self._picture, view.size, casting, marked=sparse)
            features = [*self._features_of(casting, outside is not None), *self._cuts.update(view)]
            block.write(view, casting, self._nodes.levels)
            voxels.filter(casting.filter != "nearest")
            self._passes.begin()
            self._ctx.scissor = None
            if sparse:
                self._cast_sparsely(self._picture, features, casting, outside)
            else:
                with self._passes.timed("rays"):
                    self._cast(self._picture, features, 1, view.size, outside)
        self._features = sorted(noted)
        self._generation += 1
        self._picture.buffer.generation = self._generation
        if outside is None:
            self._made = (view, style)
        return self._picture.buffer

    def _cast_sparsely(
        self, picture: Picture, features: list[str], casting: RaycastOptions, outside: moderngl.Texture | None
    ) -> None:
        """Cast some rays, fill in between, and cast the rest where that does not do."""
        size, stride = picture.buffer.size, casting.sparse
        coarse_size = -(-size[0] // stride), -(-size[1] // stride)
        self._coarse = self._fitting(self._coarse, coarse_size, casting, marked=False)
        with self._passes.timed("sparse rays"):
            self._cast(self._coarse, features, stride, size, outside)
        with self._passes.timed("between"):
            program, array = self._programs.screen("volumes/fill.frag", [*_OF_MODE[casting.mode]])
            coarse = self._coarse.buffer
            textures = {
                "coarse_depth": coarse.depth,
                "coarse_owner": coarse.owner,
                "coarse_position": coarse.position,
                "coarse_normal": coarse.across,
                "coarse_colour": coarse.colours,
            }
            for unit, (name, texture) in enumerate(textures.items(), COARSE_UNIT):
                if name in program and texture is not None:
                    texture.use(unit)
                    program[name] = unit
            self._place(program, stride, size)
            program["threshold"] = casting.sparse_threshold
            picture.framebuffer.use()
            picture.framebuffer.depth_mask = True
            self._ctx.enable_only(moderngl.DEPTH_TEST)
            self._ctx.depth_func = "1"
            array.render(moderngl.TRIANGLES, vertices=3)
        with self._passes.timed("other rays"):
            # Whoever wants a ray has depth 1, and the others 0: the triangle lies between.
            picture.framebuffer.depth_mask = False
            self._ctx.depth_func = "<"
            self._cast(picture, features, 1, size, outside, tested=True)
            self._ctx.depth_func = "<="

    def _cast(
        self,
        picture: Picture,
        features: list[str],
        stride: int,
        size: tuple[int, int],
        outside: moderngl.Texture | None,
        *,
        tested: bool = False,
    ) -> None:
        """Cast a ray for every pixel of a picture, or those that pass the test of depth."""
        program, array = self._programs.screen("volumes/cast.frag", features)
        voxels, _ = self._alive()
        bound = (("voxels", voxels.texture, VOXELS_UNIT), ("outside", outside, OUTSIDE_UNIT))
        for name, texture, unit in bound:
            if name in program and texture is not None:
                texture.use(unit)
                program[name] = unit
        self._tables.bind(program)
        self._nodes.bind(program)
        self._cuts.bind(program)
        self._place(program, stride, size)
        picture.framebuffer.use()
        self._ctx.enable_only(moderngl.DEPTH_TEST if tested else moderngl.NOTHING)
        array.render(moderngl.TRIANGLES, vertices=3)

    @property
    def volume(self) -> RaycastVolume:
        """What is drawn."""
        return self._volume

    def bind_field(self, program: moderngl.Program) -> None:
        """Bind the volume, its octree if there is one, its cuts and the rays of the last picture for another pass."""
        self._cuts.bind(program)
        voxels, block = self._alive()
        block.buffer.bind_to_uniform_block(BLOCKS["Raycast"])
        voxels.texture.use(VOXELS_UNIT)
        program["voxels"] = VOXELS_UNIT
        self._nodes.bind(program)

    @staticmethod
    def _place(program: moderngl.Program, stride: int, size: tuple[int, int]) -> None:
        program["ray_stride"] = stride
        program["last_pixel"] = size[0] - 1, size[1] - 1

    def _features_of(self, casting: RaycastOptions, outside: bool) -> list[str]:
        features = [*_OF_MODE[casting.mode], *FEATURES_OF_FILTER[casting.filter]]
        if casting.mode == "isosurface":
            features += _OF_REFINEMENT[casting.refine]
        if casting.mode == "composite":
            features += ["VOLUME_ADAPTIVE"] if self._tables.steep else _OF_INTEGRATOR[casting.integrator]
            features += ["VOLUME_FINER"] if self._tables.finer else []
            features += ["VOLUME_HOMOGENEOUS"] if takes_means(casting) else []
        features += [] if casting.octree else ["VOLUME_WHOLE"]
        return [*features, *(["VOLUME_JITTER"] if casting.jitter else []), *(["SCENE_DEPTH"] if outside else [])]

    def _fitting(
        self, picture: Picture | None, size: tuple[int, int], casting: RaycastOptions, *, marked: bool
    ) -> Picture:
        """Return a picture of that size and what the mode needs: the one there is, if it fits."""
        relief = "normal" if casting.mode == "isosurface" else None
        coloured = casting.mode == "composite"
        if picture is not None:
            if picture.key == (size, relief, coloured, marked):
                return picture
            picture.release()
        return Picture(self._ctx, size, relief, coloured=coloured, marked=marked)

    def needs_outside(self, view: View, style: Style) -> bool:  # noqa: ARG002
        """Say whether rays shall end at opaque things: surfaces hide and are hidden by depth alone."""
        return isinstance(style, VolumeStyle) and style.casting.mode != "isosurface"

    def _alive(self) -> tuple[VolumeTexture, RayBlock]:
        if self._voxels is None or self._block is None:
            raise EngineError("this renderer has been released; make a new one")
        return self._voxels, self._block

    def explain(self, *, counts: bool = True) -> dict[str, Any]:  # noqa: ARG002
        """Say what the last redraw was made of, and wait for it to end.

        Returns
        -------
        dict
            ``passes`` (name, ms), ``features``, which are on in the programs that ran, ``buffers`` (name, bytes),
            ``voxels_total``, ``nodes`` of the octree, ``skipped``: share of its leaves in which there is nothing to
            see, ``octree``: what it costs, ``bytes``, their ``share`` of the volume's, and ``ms`` that building it
            took, all 0 while there is none.
        """
        sizes = {} if self._voxels is None else {"voxels": self._voxels.nbytes}
        if self._block is not None:
            sizes |= {name: buffer.size for name, buffer in self._block.buffers.items()}
        sizes |= {name: buffer.size for name, buffer in self._nodes.buffers.items()}
        sizes |= self._tables.sizes | self._cuts.sizes
        for name, picture in (("gbuffer", self._picture), ("sparse", self._coarse)):
            if picture is not None:
                sizes[name] = picture.nbytes
        return {
            "passes": self._passes.report(),
            "features": list(self._features),
            "buffers": [{"name": name, "bytes": size} for name, size in sizes.items()],
            "voxels_total": self._volume.n_points,
            "nodes": sum(int(x) * int(y) * int(z) for x, y, z, _ in self._nodes.levels),
            "skipped": self._nodes.skipped,
            "octree": dict(self._nodes.octree),
        }

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for holder in (self._voxels, self._block, self._picture, self._coarse, self._nodes, self._tables, self._cuts):
            if holder is not None:
                holder.release()
        self._voxels = self._block = None
        self._picture = self._coarse = None
        self._programs.release()
        self._passes.release()
        self._made = None
