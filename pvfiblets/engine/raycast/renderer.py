"""`RaycastRenderer`: one volume on one OpenGL context, ray cast into a G-buffer when something changed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...raycast.octree import build_octree, flags
from ..errors import EngineError
from ..gbuffer import EMPTY, GBuffer
from ..opengl import BufferTexture, OpenGL
from ..passes import Passes
from ..shaders import Programs
from ..view import View
from .blocks import CONSTANTS, RayBlock
from .style import RaycastStyle
from .textures import VolumeTexture

if TYPE_CHECKING:
    from ...raycast.casting import Casting
    from ...raycast.octree import Octree
    from ...raycast.transfer import Transfer
    from ...raycast.volume import RaycastVolume
    from ..view import Style

__all__ = ["RaycastRenderer"]

TABLE_SIZE = 1024
"""Entries of colours by value: opacities are linear between those of the user, extinctions are not."""

VOXELS_UNIT, NODES_UNIT, COLOURS_UNIT, SEGMENTS_UNIT, OUTSIDE_UNIT = 10, 11, 12, 13, 14

_OF_MODE = {
    "isosurface": ["RAYCAST_SURFACE"],
    "composite": ["RAYCAST_LIGHT"],
    "mip": [],
    "local-mip": ["RAYCAST_LOCAL"],
}
_OF_FILTER = {"nearest": ["RAYCAST_NEAREST"], "trilinear": [], "tricubic": ["RAYCAST_TRICUBIC"]}
_OF_REFINEMENT = {"none": ["RAYCAST_UNREFINED"], "regula-falsi": [], "newton": ["RAYCAST_NEWTON"]}
_OF_INTEGRATOR = {
    "preintegrated": ["RAYCAST_PREINTEGRATED"],
    "exponential": [],
    "riemann": ["RAYCAST_RIEMANN"],
    "simpson": ["RAYCAST_SIMPSON"],
    "rk4": ["RAYCAST_RK4"],
}


class RaycastRenderer:
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
        self._voxels: VolumeTexture | None = None
        self._block: RayBlock | None = None
        self._buffer: GBuffer | None = None
        self._target: moderngl.Framebuffer | None = None
        self._nodes: tuple[moderngl.Buffer, BufferTexture] | None = None
        self._nodes_for: object = None
        self._tables: dict[str, moderngl.Texture] = {}
        self._tables_for: object = None
        self._octrees: dict[int, Octree] = {}
        self._levels: npt.NDArray[np.int64] = np.zeros((0, 4), np.int64)
        self._skipped = 0.0
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
            Its region is not looked at.
        style : RaycastStyle
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
        """
        if not isinstance(style, RaycastStyle):
            raise TypeError(f"style is a {type(style).__name__}; volumes need a RaycastStyle")
        voxels, block = self._alive()
        if self._buffer is not None and outside is None and self._made == (view, style):
            return self._buffer
        self._made = None
        casting = style.casting
        self._make_nodes(casting)
        self._make_tables(casting, block)
        with self._gl.framebuffers_kept():
            buffer, target = self._targets(view.size, casting)
            features = self._features_of(casting, outside is not None)
            self._features = sorted(features)
            block.write(view, casting, self._levels)
            self._passes.begin()
            self._ctx.scissor = None
            with self._passes.timed("clear"):
                self._gl.clear_integers(target, (EMPTY,), 0)
                self._gl.clear_integers(target, (EMPTY,), 1)
            with self._passes.timed("rays"):
                self._cast(target, voxels, features, casting, outside)
        self._generation += 1
        buffer.generation = self._generation
        if outside is None:
            self._made = (view, style)
        return buffer

    def _cast(
        self,
        target: moderngl.Framebuffer,
        voxels: VolumeTexture,
        features: list[str],
        casting: Casting,
        outside: moderngl.Texture | None,
    ) -> None:
        program, array = self._programs.screen("raycast/cast.frag", features)
        voxels.filter(casting.filter != "nearest")
        bound: list[tuple[str, Any, int]] = [("voxels", voxels.texture, VOXELS_UNIT)]
        bound += [("colours", self._tables.get("colours"), COLOURS_UNIT)]
        bound += [("segments", self._tables.get("segments"), SEGMENTS_UNIT), ("outside", outside, OUTSIDE_UNIT)]
        for name, texture, unit in bound:
            if name in program and texture is not None:
                texture.use(unit)
                program[name] = unit
        assert self._nodes is not None
        self._nodes[1].bind(NODES_UNIT)
        self._gl.set_sampler(program, "nodes", NODES_UNIT)
        target.use()
        self._ctx.enable_only(moderngl.NOTHING)
        array.render(moderngl.TRIANGLES, vertices=3)

    def _features_of(self, casting: Casting, outside: bool) -> list[str]:
        features = [*_OF_MODE[casting.mode], *_OF_FILTER[casting.filter]]
        if casting.mode == "isosurface":
            features += _OF_REFINEMENT[casting.refine]
        if casting.mode == "composite":
            features += _OF_INTEGRATOR[casting.integrator]
        return [*features, *(["RAYCAST_JITTER"] if casting.jitter else []), *(["OUTSIDE"] if outside else [])]

    # What is kept of the volume

    def _make_nodes(self, casting: Casting) -> None:
        """Bring the octree's list up to date with what there is to see."""
        key = casting.octree, casting.mode, casting.filter, casting.values, casting.transfer, casting.low, casting.high
        if self._nodes_for == key:
            return
        margin = 2 if casting.filter == "tricubic" else 1
        if margin not in self._octrees:
            self._octrees[margin] = build_octree(self._volume, margin)
        octree = self._octrees[margin]
        lists = _numbers(octree, casting)
        shapes = [numbers.shape for numbers in lists]
        starts = np.cumsum([0, *(numbers.size for numbers in lists)])
        self._levels = np.array([[*shape, start] for shape, start in zip(shapes, starts[:-1], strict=True)], np.int64)
        data = np.concatenate([numbers.ravel(order="F") for numbers in lists]).astype("<f4")
        self._skipped = float(np.mean(lists[0] == 0.0)) if casting.mode in ("isosurface", "composite") else 0.0
        self._drop_nodes()
        try:
            buffer = self._ctx.buffer(data)
        except moderngl.Error as error:
            raise EngineError(f"no memory for an octree of {data.nbytes} bytes") from error
        self._nodes = buffer, self._gl.texture_buffer(buffer, "r32f")
        self._nodes_for = key

    def _make_tables(self, casting: Casting, block: RayBlock) -> None:
        """Bring colours by value up to date."""
        transfer = casting.transfer if casting.mode == "composite" else None
        step = block.step_mm(casting) if casting.integrator == "preintegrated" else None
        if self._tables_for == (transfer, step):
            return
        for texture in self._tables.values():
            texture.release()
        self._tables = {}
        if transfer is not None:
            self._tables["colours"] = _table(self._ctx, _medium(transfer)[None])
            if step is not None:
                self._tables["segments"] = _table(self._ctx, transfer.preintegrated(step).transpose(1, 0, 2))
        self._tables_for = transfer, step

    def _targets(self, size: tuple[int, int], casting: Casting) -> tuple[GBuffer, moderngl.Framebuffer]:
        relief = "normal" if casting.mode == "isosurface" else None
        coloured = casting.mode == "composite"
        buffer = self._buffer
        fits = buffer is not None and buffer.size == size and buffer.relief == relief
        if buffer is None or not fits or (buffer.colours is not None) != coloured or self._target is None:
            self._drop_targets()
            buffer = self._buffer = GBuffer(self._ctx, size)
            buffer.want_relief(self._ctx, relief)
            if coloured:
                buffer.want_colours(self._ctx)
            shown = [buffer.depth, buffer.owner, buffer.ids, buffer.position, buffer.across, buffer.colours]
            self._target = self._ctx.framebuffer([texture for texture in shown if texture is not None])
        return buffer, self._target

    def needs_outside(self, view: View, style: Style) -> bool:  # noqa: ARG002
        """Say whether rays shall end at opaque things: surfaces hide and are hidden by depth alone."""
        return isinstance(style, RaycastStyle) and style.casting.mode != "isosurface"

    def _alive(self) -> tuple[VolumeTexture, RayBlock]:
        if self._voxels is None or self._block is None:
            raise EngineError("this renderer has been released; make a new one")
        return self._voxels, self._block

    def explain(self, *, counts: bool = True) -> dict[str, Any]:  # noqa: ARG002
        """Say what the last redraw was made of, and wait for it to end.

        Returns
        -------
        dict
            ``passes`` (name, ms), ``features``, ``buffers`` (name, bytes), ``voxels_total``, ``nodes`` of the octree,
            ``skipped``: share of its leaves in which there is nothing to see.
        """
        sizes = {} if self._voxels is None else {"voxels": self._voxels.nbytes}
        if self._block is not None:
            sizes |= {name: buffer.size for name, buffer in self._block.buffers.items()}
        if self._nodes is not None:
            sizes["octree"] = self._nodes[0].size
        sizes |= {name: 16 * table.width * table.height for name, table in self._tables.items()}
        if self._buffer is not None:
            sizes["gbuffer"] = self._buffer.nbytes
        return {
            "passes": self._passes.report(),
            "features": list(self._features),
            "buffers": [{"name": name, "bytes": size} for name, size in sizes.items()],
            "voxels_total": self._volume.n_points,
            "nodes": 0 if self._nodes is None else self._nodes[0].size // 4,
            "skipped": self._skipped,
        }

    def _drop_nodes(self) -> None:
        if self._nodes is not None:
            buffer, texture = self._nodes
            texture.release()
            buffer.release()
            self._nodes = None

    def _drop_targets(self) -> None:
        if self._target is not None:
            self._target.release()
            self._target = None
        if self._buffer is not None:
            self._buffer.release()
            self._buffer = None

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for holder in (self._voxels, self._block, *self._tables.values()):
            if holder is not None:
                holder.release()
        self._voxels = self._block = None
        self._tables = {}
        self._tables_for = self._nodes_for = None
        self._drop_nodes()
        self._drop_targets()
        self._programs.release()
        self._passes.release()
        self._made = None


def _numbers(octree: Octree, casting: Casting) -> list[npt.NDArray[np.float32]]:
    """Return a number for each node, leaves first: 0 where there is nothing to see, of peaks the greatest value."""
    within = casting.low, casting.high
    if not casting.octree:
        return [np.full(level.least.shape, np.inf, np.float32) for level in octree.levels]
    if casting.mode == "isosurface":

        def visible(least: Any, greatest: Any) -> npt.NDArray[np.bool_]:
            seen = [(least <= value) & (greatest >= value) for value in casting.values]
            return np.logical_or.reduce(seen)
    elif casting.transfer is not None and casting.mode == "composite":
        transfer = casting.transfer

        def visible(least: Any, greatest: Any) -> npt.NDArray[np.bool_]:
            there = (greatest >= within[0]) & (least <= within[1])
            return there & transfer.visible_range(least, greatest)
    else:
        return [
            np.where((level.greatest >= within[0]) & (level.least <= within[1]), level.greatest, -np.inf)
            for level in octree.levels
        ]
    return [level.astype(np.float32) for level in flags(octree, visible)]


def _medium(transfer: Transfer) -> npt.NDArray[np.float32]:
    """(k, 4) colour and extinction per mm, at values so dense that they may be taken as linear between."""
    values = np.linspace(*transfer.clim, max(TABLE_SIZE, len(transfer.table)))
    return np.concatenate([transfer.colour(values), transfer.extinction(values)[:, None]], axis=1).astype("<f4")


def _table(ctx: moderngl.Context, rows: npt.NDArray[Any]) -> moderngl.Texture:
    """A texture of colours, linear between them."""
    height, width = rows.shape[:2]
    texture = ctx.texture((width, height), 4, np.ascontiguousarray(rows, "<f4"), dtype="f4")
    texture.filter = moderngl.LINEAR, moderngl.LINEAR
    texture.repeat_x = texture.repeat_y = False
    return texture
