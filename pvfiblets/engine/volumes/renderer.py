"""`VolumeRenderer`: one volume on one OpenGL context, ray cast into a G-buffer when something changed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np

from ...volumes.raycast_options import MAX_VALUES
from ..drawable import Drawable
from ..gbuffer import GBuffer
from ..gl.bindings import BLOCKS, VOLUME_COARSE, VOLUMES
from ..gl.work_limits import WorkLimits
from ..regions.region_cut import RegionCut
from ..view import Style, View
from .interpolation import interpolates_finely
from .nodes import NodeList
from .targets import RayTarget
from .textures import ColourTexture, VolumeTexture
from .transfer_textures import TransferTextures
from .uniform_blocks import CONSTANTS, RayBlock

if TYPE_CHECKING:
    from ...volumes.raycast_options import RaycastOptions
    from ...volumes.volume import RaycastVolume
    from .shading import Shading

LATTICE = 1 << 16
"""Steps over the volume's bounds, of which one point is the origin of local coordinates where a region cuts."""


_OF_MODE = {
    "isosurface": ["VOLUME_SURFACE"],
    "composite": ["VOLUME_COMPOSITE"],
    "mip": [],
    "local-mip": ["VOLUME_LOCAL"],
    "minimum": ["VOLUME_MINIMUM"],
    "average": ["VOLUME_AVERAGE"],
}
FEATURES_OF_FILTER = {"nearest": ["VOLUME_NEAREST"], "trilinear": [], "tricubic": ["VOLUME_TRICUBIC"]}
_TAPS = {"tricubic": 8}  # look-ups of a sample, where there are several
_OF_REFINEMENT = {"exact": [], "none": ["VOLUME_UNREFINED"], "regula-falsi": [], "newton": ["VOLUME_NEWTON"]}
_OF_INTEGRATOR = {
    "adaptive": ["VOLUME_PREINTEGRATED"],  # and more where that does not do
    "preintegrated": ["VOLUME_PREINTEGRATED"],
    "exponential": [],
    "riemann": ["VOLUME_RIEMANN"],
    "simpson": ["VOLUME_SIMPSON"],
    "romberg": ["VOLUME_ROMBERG"],
    "rk4": ["VOLUME_RK4"],
}


@dataclass(frozen=True)
class VolumeStyle(Style):
    """How a volume becomes pixels; ``values`` is not read: the value of a voxel stands beside each pixel."""

    casting: RaycastOptions = field(kw_only=True)
    # of light: lamps that shine on it. Without, it has its own colours.
    shading: Shading | None = field(default=None, kw_only=True)

    @property
    def relief(self) -> str | None:
        """Normals of surfaces."""
        return "normal" if self.casting.mode == "isosurface" and not self.casting.layered else None


class VolumeRenderer(Drawable[VolumeStyle]):
    """Casts rays through one volume; a view's region cuts in all modes, and rays end at what is outside.

    In its `GBuffer` ``owner`` holds the nearest voxel of what shows, counted along the first axis first;
    ``position`` the place along the ray (mm) and the value less the volume's ``offset``; ``across`` normals of
    surfaces; ``colours`` those of ``'composite'``. `explain` also says ``voxels_total``; ``nodes`` of the octree;
    ``skipped``, the share of its leaves in which there is nothing to see; and ``octree``, what it costs: ``bytes``,
    their ``share`` of the volume's, and the ``ms`` that building it took, all 0 while there is none.

    Source: Lesar, "Real-time ray casting of volumetric data" (2015), section III.
    """

    STYLE = VolumeStyle
    pipeline = "rays"  # `'rays'`

    def __init__(self, ctx: moderngl.Context, volume: RaycastVolume) -> None:
        super().__init__(ctx, CONSTANTS)
        # Values on the card are less by the volume's offset; so is all that is compared with them.
        self._offset = volume.offset
        self._volume = volume = replace(volume, offset=0.0) if volume.offset else volume  # copied to the GPU here
        self._shifted: tuple[RaycastOptions, RaycastOptions] | None = None
        self._shading: Shading | None = None
        self._clim: tuple[float, float] = (0.0, 1.0)
        self._surfaces: tuple[tuple[float, ...], ...] | None = None
        self._colours: ColourTexture | None = None
        with self._making():
            self._voxels = self._keep(VolumeTexture(ctx, volume), "voxels")
            if volume.colours is not None:
                self._colours = self._keep(ColourTexture(ctx, volume.colours), "colours of voxels")
            self._block = self._keep(RayBlock(ctx, volume, (self._voxels.scale, self._voxels.shift)))
            self._nodes = self._keep(NodeList(ctx, self._gl, volume))
            self._tables = self._keep(TransferTextures(ctx, volume))
            self._work = WorkLimits.from_context(ctx)
            bounds = np.array(volume.bounds).reshape(3, 2)
            place = bounds[:, 0], np.ptp(bounds, axis=1) / LATTICE, LATTICE
            self._cuts = self._keep(RegionCut(ctx, self._gl, self._programs, place))

    def _draw(self, view: View, style: VolumeStyle, outside: moderngl.Texture | None) -> GBuffer:
        if self._offset:
            if self._shifted is None or self._shifted[0] is not style.casting:
                self._shifted = style.casting, style.casting.less(self._offset)
            style = replace(style, casting=self._shifted[1])
        casting = style.casting
        self._nodes.make(casting)
        self._clim = self._volume.value_range if casting.transfer is None else casting.transfer.clim
        self._surfaces = casting.surfaces if casting.layered else None
        step = self._block.step_mm(casting)
        self._tables.make(casting, step)
        self._samples = self._volume.diagonal / step * _TAPS.get(casting.filter, 1)
        target = self._ray_target("gbuffer", view.size, style, marked=casting.sparse > 1)
        shaded = casting.coloured and style.shading is not None
        features = [*self._features_of(casting, outside is not None), *self._cuts.update(view)]
        features += ["VOLUME_SHADED"] if shaded else []
        self._shading = style.shading if shaded else None
        self._block.write(view, casting, self._nodes.levels)
        self._voxels.filter(casting.filter != "nearest")
        if self._colours is not None:
            self._colours.filter(casting.filter != "nearest")
        if casting.sparse > 1:
            self._cast_sparsely(target, features, style, outside)
        else:
            with self._passes.timed("rays"):
                self._cast(target, features, 1, view.size, outside)
        return target.buffer

    def _serves(self, outside: moderngl.Texture | None) -> bool:
        """Set the opaque depths that end rays."""
        return outside is None

    def _cast_sparsely(
        self, target: RayTarget, features: list[str], style: VolumeStyle, outside: moderngl.Texture | None
    ) -> None:
        """Cast some rays, fill in between, and cast the rest where that does not do."""
        casting = style.casting
        size, stride = target.buffer.size, casting.sparse
        coarse_target = self._ray_target("sparse", (-(-size[0] // stride), -(-size[1] // stride)), style, marked=False)
        with self._passes.timed("sparse rays"):
            self._cast(coarse_target, features, stride, size, outside)
        with self._passes.timed("between"):
            kind = "composite" if casting.coloured else casting.mode
            program, array = self._programs.screen("volumes/fill.frag", [*_OF_MODE[kind]])
            coarse = coarse_target.buffer
            textures = {
                "coarse_depth": coarse.depth,
                "coarse_owner": coarse.owner,
                "coarse_position": coarse.position,
                "coarse_normal": coarse.across,
                "coarse_colour": coarse.colours,
            }
            for name, texture in textures.items():
                unit = VOLUME_COARSE[name]
                if name in program and texture is not None:
                    texture.use(unit)
                    program[name] = unit
            self._place(program, stride, size)
            program["threshold"] = casting.sparse_threshold
            target.framebuffer.use()
            target.framebuffer.depth_mask = True
            self._ctx.enable_only(moderngl.DEPTH_TEST)
            self._ctx.depth_func = "1"
            array.render(moderngl.TRIANGLES, vertices=3)
        with self._passes.timed("other rays"):
            # Whoever wants a ray has depth 1, and the others 0: the triangle lies between.
            target.framebuffer.depth_mask = False
            self._ctx.depth_func = "<"
            self._cast(target, features, 1, size, outside, tested=True)
            self._ctx.depth_func = "<="

    def _cast(
        self,
        target: RayTarget,
        features: list[str],
        stride: int,
        size: tuple[int, int],
        outside: moderngl.Texture | None,
        *,
        tested: bool = False,
    ) -> None:
        """Cast a ray for every pixel of a frame, or for pixels that pass the depth test."""
        program, array = self._programs.screen("volumes/cast.frag", features)
        self._voxels.bind(program)
        if "outside" in program and outside is not None:
            outside.use(VOLUMES["outside"])
            program["outside"] = VOLUMES["outside"]
        self._tables.bind(program)
        self._nodes.bind(program)
        self._cuts.bind(program)
        if self._colours is not None:
            self._colours.bind(program)
        if self._surfaces is not None and "surface_colours" in program:
            rows = np.zeros((MAX_VALUES, 4), "<f4")
            rows[: len(self._surfaces)] = self._surfaces
            table: Any = program["surface_colours"]
            table.write(rows.tobytes())
        if self._shading is not None:
            self._shading.set_uniforms(program, self._volume, self._clim)
        self._place(program, stride, size)
        self._ctx.enable_only(moderngl.DEPTH_TEST if tested else moderngl.NOTHING)
        self._work.draw(target.framebuffer, self._samples, lambda: array.render(moderngl.TRIANGLES, vertices=3))

    @property
    def volume(self) -> RaycastVolume:
        """What is drawn."""
        return self._volume

    def bind_field(self, program: moderngl.Program) -> None:
        """Bind the volume, its octree if there is one, its cuts and the rays of the last picture for another pass."""
        self._check_alive()
        self._cuts.bind(program)
        self._block.buffer.bind_to_uniform_block(BLOCKS["Raycast"])
        self._voxels.bind(program)
        self._nodes.bind(program)

    def field_features(self, casting: RaycastOptions) -> list[str]:
        """Return the features of programs that read the volume."""
        coarse = (
            casting.filter != "nearest"
            and self._shows_stairs(casting)
            and not interpolates_finely(self._ctx, self._gl, self._voxels.kind)
        )
        return [*FEATURES_OF_FILTER[casting.filter], *self._voxels.features, *(["VOLUME_FETCHED"] if coarse else [])]

    def _shows_stairs(self, casting: RaycastOptions) -> bool:
        """Whether values that are off by 1/512 of what neighbours differ by would be seen."""
        if casting.mode == "composite" and casting.integrator in ("adaptive", "preintegrated"):
            return self._tables.finer or self._tables.exact  # else the table is gentle
        return casting.mode in ("composite", "isosurface")

    @staticmethod
    def _place(program: moderngl.Program, stride: int, size: tuple[int, int]) -> None:
        program["ray_stride"] = stride
        program["last_pixel"] = size[0] - 1, size[1] - 1

    def _features_of(self, casting: RaycastOptions, outside: bool) -> list[str]:
        features = [*_OF_MODE[casting.mode], *self.field_features(casting)]
        features += ["VOLUME_CELLS"] if casting.exact else []
        if casting.mode == "isosurface":
            features += [] if casting.exact else _OF_REFINEMENT[casting.refine]
            features += ["VOLUME_LAYERS"] if casting.layered else []
            features += ["VOLUME_CLOSED"] if casting.closed else []
        if casting.mode == "composite":
            features += ["VOLUME_COLOURS"] if self._colours is not None else []
            features += _OF_INTEGRATOR[casting.integrator]
            features += ["VOLUME_FINER"] if self._tables.finer else []
            features += ["VOLUME_EXACT"] if self._tables.exact else []
            features += ["VOLUME_HOMOGENEOUS"] if self._nodes.takes_means else []
        features += [] if casting.octree else ["VOLUME_WHOLE"]
        jitter = casting.jitter and not casting.exact
        return [*features, *(["VOLUME_JITTER"] if jitter else []), *(["SCENE_DEPTH"] if outside else [])]

    def _ray_target(self, name: str, size: tuple[int, int], style: VolumeStyle, *, marked: bool) -> RayTarget:
        """Return a target of that size and what the mode needs."""
        relief, coloured = style.relief, style.casting.coloured
        key = size, relief, coloured, marked
        return self._fitting(name, key, lambda: RayTarget(self._ctx, size, relief, coloured=coloured, marked=marked))

    def needs_outside(self, view: View, style: Style) -> bool:  # noqa: ARG002
        """Say whether rays shall end at opaque things: surfaces hide and are hidden by depth alone."""
        return isinstance(style, VolumeStyle) and (style.casting.mode != "isosurface" or style.casting.layered)

    def _facts(self, *, counts: bool) -> dict[str, Any]:  # noqa: ARG002
        return {
            "voxels_total": self._volume.n_points,
            "nodes": sum(int(x) * int(y) * int(z) for x, y, z, _ in self._nodes.levels),
            "skipped": self._nodes.skipped,
            "octree": dict(self._nodes.octree),
        }
