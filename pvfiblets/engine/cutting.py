"""Where a region begins and ends along each pixel's ray: `Cutter`, for ``shaders/regions/boundaries.glsl``.

This work is based on: Schertzer et al. 2022, section 5.1 and figure 10: a mesh drawn into a depth buffer for its front
and one for its back decides by pixel which fragments lie inside, which is right for convex meshes. Here every pixel has
a sorted list of all window depths at which the region's expression turns, whatever its shapes.

==========  =========================================================================================================
step        what it does
==========  =========================================================================================================
rays        planes, slabs, boxes and spheres: their rows of ``shaders/regions/rays.glsl``, composed in float64
surfaces    closed surfaces are drawn, layer by layer (:mod:`.surface_layers`)
combine     merges all crossings of a pixel and keeps those at which the expression turns, four to a pass and layer
==========  =========================================================================================================

Made once for a region, a size and a camera. A box, a sphere or a convex mesh takes one layer of 16 bytes a pixel.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ..codec.query.shapes import BOX, LABELS, MAX_LEAVES, MAX_OPS, PLANE, SLAB, SPHERE
from .frame import Array, local_frame
from .layer_stack import LayerStack
from .opengl import OpenGL
from .shaders import Programs
from .view import View

if TYPE_CHECKING:
    from ..codec.query.shapes import Region

__all__ = ["BOUNDARIES_UNIT", "Cutter", "rays_block"]

BOUNDARIES_UNIT = 26
"""Texture unit of the boundaries."""

RAYS_BINDING = 7
"""Binding of the uniform block ``Rays``, of this module's own programs only."""

_PLANES, _SPHERE, _SURFACE = range(3)
_ROWS = 6

_BLOCK = np.dtype(
    [
        ("info", "<i4", 4),
        ("program", "<i4", MAX_OPS),
        ("leaves", "<i4", (MAX_LEAVES, 4)),
        ("centres", "<f4", (MAX_LEAVES, 4)),
        ("rows", "<f4", (_ROWS * MAX_LEAVES, 4)),
    ]
)

# Of window coordinates' homogeneous unit coordinates (u, v, w, weight): planes of each kind.
_SIDES = {
    PLANE: np.array([[0.0, 0, 1, 0]]),
    SLAB: np.array([[0.0, 0, 1, 1], [0, 0, -1, 1]]),
    BOX: np.array([[1.0, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1], [0, 0, -1, 1]]),
}


def _window_matrix(to_clip: Array, size: tuple[int, int]) -> Array:
    """Return (4, 4): local mm to homogeneous window coordinates, as in ``shaders/frame/blocks.glsl``."""
    x, y, z, w = to_clip
    return np.array([size[0] / 2 * (x + w), size[1] / 2 * (y + w), (z + w) / 2, w])


def _expanded(rows: Array, about: Array) -> Array:
    """Rewrite rows over (q, 1) as rows over (q - about, 1)."""
    rows = rows.copy()
    rows[:, 3] += rows[:, :3] @ about
    return rows


def _scaled(values: Array, size: tuple[int, int]) -> Array:
    """Scale rows over (d, 1), one by one, to what float32 holds; numbers too small to matter become 0."""
    span = np.array([*size, 1.0, 1.0])
    largest = np.abs(values * span).max(axis=1, keepdims=True)
    values = values / np.where(largest > 0.0, largest, 1.0)
    return np.where(np.abs(values * span) < 1e-30, 0.0, values)


def _centre(window: Array, place: Array, size: tuple[int, int]) -> Array:
    """Return (3,): window coordinates of a leaf's centre, or what of the picture comes nearest to them."""
    q = window @ place
    if q[3] <= 0.0 or not np.isfinite(q / q[3]).all():
        return np.array([size[0] / 2, size[1] / 2, 0.0])
    return np.clip(q[:3] / q[3], 0.0, [*size, 1.0])


def rays_block(region: Region, window: Array, offset: Array, size: tuple[int, int]) -> npt.NDArray[Any]:
    """Pack the ``Rays`` uniform block (std140), but for surfaces.

    Parameters
    ----------
    region : Region
    window : numpy.ndarray
        ``(4, 4)`` local mm to homogeneous window coordinates, invertible.
    offset : numpy.ndarray
        ``(3,)`` data mm of local 0.
    size : tuple of int
        Pixels.

    Returns
    -------
    numpy.ndarray
        A structured scalar.
    """
    block: npt.NDArray[Any] = np.zeros((), _BLOCK)
    block["info"][:2] = len(region.program), len(region.leaves)
    block["program"][: len(region.program)] = region.program
    inverse = np.linalg.inv(window)
    for k, leaf in enumerate(region.leaves):
        if leaf.kind not in _SIDES and leaf.kind != SPHERE:
            continue
        to_unit = np.eye(4)
        to_unit[:3, :3] = leaf.linear
        to_unit[:3, 3] = leaf.linear @ (offset - leaf.centre)
        about = _centre(window, np.append(leaf.centre - offset, 1.0), size)
        unit = _expanded(to_unit @ inverse, about)
        first = _ROWS * k
        if leaf.kind == SPHERE:
            rows = _quadric(unit, size)
            block["leaves"][k] = _SPHERE, first, len(rows), 0
        else:
            rows = _scaled(_SIDES[leaf.kind] @ unit, size)
            block["leaves"][k] = _PLANES, first, len(rows), 0
        block["rows"][first : first + len(rows)] = rows
        block["centres"][k, :3] = about
    return block


def _quadric(unit: Array, size: tuple[int, int]) -> Array:
    """Return (3, 4): the rows of a sphere, from the map (d, 1) to homogeneous unit coordinates."""
    q = unit.T @ np.diag([1.0, 1.0, 1.0, -1.0]) @ unit
    span = np.array([*size, 1.0, 1.0])
    q /= np.abs(q * span * span[:, None]).max() or 1.0
    return np.array(
        [
            [q[0, 0], q[1, 1], 2 * q[0, 1], q[3, 3]],
            [2 * q[0, 3], 2 * q[1, 3], q[0, 2], q[1, 2]],
            [q[2, 2], q[2, 3], 0.0, 0.0],
        ]
    )


def check_region(region: Region) -> None:
    """Refuse what has no crossings along a ray.

    Raises
    ------
    ValueError
        If the region holds a label volume.
    """
    if any(leaf.kind == LABELS for leaf in region.leaves):
        raise ValueError(
            "a label volume cannot cut, as it has no surface to cut at: use it to filter streamlines, or cut by a closed "
            "surface around the labels, e.g. pyvista's contour_labels()"
        )


class Cutter:
    """Keeps the boundaries of a region along the rays of a picture.

    Parameters
    ----------
    ctx : moderngl.Context
        OpenGL 3.3 or later.
    gl : OpenGL
    programs : Programs
    """

    def __init__(self, ctx: moderngl.Context, gl: OpenGL, programs: Programs) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._made: tuple[object, ...] | None = None
        self._stack: LayerStack | None = None
        self._block: moderngl.Buffer | None = None
        self.layers = 0

    def prepare(self, view: View, origin: Array, scale: Array, top: int) -> bool:
        """Bring the boundaries up to date; nothing is done where region, size and camera are what they were.

        Changes the framebuffer's binding for a while, and leaves blending, culling and the depth test off.

        Parameters
        ----------
        view : View
            Its region in data mm. Where its matrix flattens space, no depth tells inside from outside, and every
            pixel is kept.
        origin, scale, top
            Of the anchors, as in :func:`pvfiblets.engine.frame.reference_anchor`.

        Returns
        -------
        bool
            Whether there is a region to cut by.

        Raises
        ------
        ValueError
            If the region holds a label volume.
        EngineError
            If a pixel's boundaries are more than this OpenGL has layers for, or memory does not suffice.
        """
        region = view.region
        if region is None:
            self.release()
            return False
        check_region(region)
        key = (region, view.size, view.model_view_projection.tobytes(), tuple(origin), tuple(scale), top)
        if self._made == key:
            return True
        self._made = None
        _, to_data, to_clip = local_frame(view, origin, scale, top)
        window = _window_matrix(to_clip, view.size)
        with self._gl.framebuffers_kept():
            self._ctx.enable_only(moderngl.NOTHING)
            self._ctx.wireframe = False
            self._make(region, window, to_data[:3, 3], view.size)
        self._made = key
        return True

    def _make(self, region: Region, window: Array, offset: Array, size: tuple[int, int]) -> None:
        try:
            block = rays_block(region, window, offset, size)
        except np.linalg.LinAlgError:
            stack = self._stack_of(size, 1)
            stack.framebuffers[0].clear(-1.0, 2.0, 2.0, 2.0)
            self.layers = 1
            return
        if self._block is None:
            self._block = self._ctx.buffer(reserve=_BLOCK.itemsize)
        self._block.write(block.tobytes())
        needed = -(-(1 + 2 * len(region.leaves)) // 4)
        self._combine(self._stack_of(size, needed), 0, needed)
        self.layers = needed

    def _combine(self, stack: LayerStack, start: int, stop: int) -> None:
        """Draw some layers of the boundaries."""
        assert self._block is not None
        program, array = self._programs.screen("regions/combine.frag")
        program["Rays"].binding = RAYS_BINDING  # type: ignore[union-attr]
        self._block.bind_to_uniform_block(RAYS_BINDING)
        for layer in range(start, stop):
            program["first"] = 4 * layer
            stack.framebuffers[layer].use()
            array.render(moderngl.TRIANGLES, vertices=3)

    def _stack_of(self, size: tuple[int, int], layers: int) -> LayerStack:
        """Make room for layers of a size; what is there is lost where it grows."""
        held = self._stack
        if held is None or held.size != size or held.layers < layers:
            if held is not None:
                held.release()
                self._stack = None
            self._stack = held = LayerStack(self._ctx, self._gl, size, layers, (4,))
        return held

    def bind(self, program: Any) -> None:
        """Bind the boundaries and tell a program where they are, if it asks."""
        if self._stack is None:
            return
        self._stack.textures[0].use(BOUNDARIES_UNIT)
        for name, value in {"region_boundaries": BOUNDARIES_UNIT, "region_layers": self.layers}.items():
            if name in program:
                program[name] = value

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        return 0 if self._stack is None else self._stack.nbytes

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        if self._stack is not None:
            self._stack.release()
            self._stack = None
        if self._block is not None:
            self._block.release()
            self._block = None
        self._made = None
        self.layers = 0
