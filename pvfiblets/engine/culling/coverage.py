"""The paper's coverage buffer: the last picture's depth, dilated, as the next camera sees it.

Paper: Schertzer et al. 2022, sections 3.4.1, 3.4.2 and 4.4, appendix C. Made before a picture, of the one before:

========  ===========================================================================================================
step      task
========  ===========================================================================================================
max       the farthest depth of squares of 16 x 16 pixels: four levels of :class:`DepthPyramid`
dilate    the buffer is moved backwards and inwards by a radius R (``shaders/culling/coverage_dilate.frag``)
move      it is drawn as a mesh grid from the next camera (``shaders/culling/coverage_grid.vert``)
========  ===========================================================================================================

A fiblet is then tested by a few texel fetches (``shaders/culling/coverage.glsl``). From the same camera no pixel is
lost; after a turn some are, for one picture: what came into view from behind something is not in the buffer, as in the
paper.

R is no property of the fiblets but a choice: thick fiblets are never hidden, long ones take more fetches. It is the
capsule radius that :data:`THICK` of the fiblets stay below, and an eighth of a long fiblet, which then takes five
fetches or fewer. The paper's is the whole length of a fiblet. Fiblets hidden on a brain of 60 million points, by R in
mm (10 is the chosen one): 6: 41 %, 8: 42 %, 10: 39 %, 14: 33 %, 20: 16 %, 30 (the paper's): 6 %.

Nothing is hidden in the first picture, after a change of size, line width, tolerance or clip planes, and where the last
view's matrix is singular.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np

from ...codec import layout
from ..errors import EngineError
from ..frame import Array, local_frame
from ..gbuffer import GBuffer
from ..gl.bindings import CULLING
from ..gl.moderngl_extras import GLExtras
from ..gl.shaders import Programs
from ..view import Style, View
from .pyramid import DepthPyramid

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

LEVEL = 3
"""Level of the pyramid: squares of 16 pixels."""

THICK = 0.95
"""Share of fiblets whose capsules are thinner than R."""

MARGIN = 1.5
"""Greatest distance in pixels of a drawn pixel from its line (``shaders/culling/hidden.glsl``)."""

SAMPLE = 64
"""Pages whose fiblets decide on R."""

_EMPTY, _UNCOVERED = 3.0e38, -3.0e38


def dilation_radius(fiblets: FibletSet) -> float:
    """Choose by how much the coverage buffer is dilated."""
    n, n_pages = int(fiblets.n_fiblets), len(fiblets.pages) - 1
    if n == 0:
        return 0.0
    radii, lengths = [], []
    for page in np.unique(np.linspace(0, n_pages - 1, min(n_pages, SAMPLE)).astype(int)):
        rows = slice(page * layout.PAGE, min((page + 1) * layout.PAGE, n))
        radii.append(np.asarray(fiblets.reach[rows], np.float64) * fiblets.reach_scale)
        words = np.asarray(fiblets.anchors[rows])
        anchors = np.stack([layout.unpack(f"anchor_{axis}", words) for axis in "xyz"], axis=1).astype(np.float64)
        if fiblets.anchors_low is not None:
            anchors = anchors * 65536.0 + np.asarray(fiblets.anchors_low[rows])
        inner = layout.unpack("end", words)[:-1] == 0
        lengths.append(np.linalg.norm(np.diff(anchors * fiblets.anchor_scale, axis=0)[inner], axis=1))
    chords = np.concatenate(lengths)
    longest = float(np.quantile(chords, THICK)) if len(chords) else 2.0 * fiblets.parameters.largest_radius
    return float(np.quantile(np.concatenate(radii), THICK)) + longest / 8.0


@dataclass(frozen=True)
class _Camera:
    """A view in local millimetres, in float64: depth along the view, and the lines that the picture's points show.

    A point of the line through pixel (x, y) at depth zeta is ``origin + zeta * ray`` and, in a perspective view,
    ``origin + (zeta + eye) * (ray + x * ray_x + y * ray_y)``; in a parallel one, ``origin + x * ray_x + y * ray_y +
    zeta * ray``.
    """

    reference: Array
    window: Array  # (4, 4) local mm to homogeneous window coordinates, whose z is that of clip
    axis: Array  # unit vector; zeta(p) = axis . p
    eye: float
    perspective: bool
    origin: Array
    ray: Array
    ray_x: Array
    ray_y: Array
    depth: Array  # window depth m to zeta: (m d0 - d1) / (d2 - m d3)


class CoverageBuffer:
    """Hides what the last picture hid."""

    feature = "CULL_COVERAGE"
    halfway = False
    predicts = False
    outside: moderngl.Texture | None = None

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs, fiblets: FibletSet) -> None:
        self._ctx = ctx
        self._programs = programs
        self._pyramid = DepthPyramid(ctx, gl, programs)
        self._gl = gl
        self._origin = np.asarray(fiblets.origin, np.float64)
        self._scale = np.asarray(fiblets.anchor_scale, np.float64)
        self._top = 2**32 - 1 if fiblets.anchors_low is not None else 2**16 - 1
        self.radius = dilation_radius(fiblets)
        self._thicker = 0.0
        self._last: tuple[GBuffer, View, Style] | None = None
        self._axis = np.zeros(3)
        self._side = 16
        self._textures: list[moderngl.Texture] = []
        self._framebuffers: list[moderngl.Framebuffer] = []
        self._grid: moderngl.VertexArray | None = None

    def _resize(self, size: tuple[int, int]) -> None:
        if self._textures and self._textures[0].size == size:
            return
        self._drop()
        for _ in range(2):
            try:
                texture = self._ctx.texture(size, 1, dtype="f4")
            except moderngl.Error as error:
                self._drop()
                raise EngineError(f"no memory for a coverage buffer of {size[0]} x {size[1]} texels") from error
            texture.filter = moderngl.NEAREST, moderngl.NEAREST
            self._textures.append(texture)
            self._framebuffers.append(self._ctx.framebuffer([texture]))

    def before(self, target: GBuffer, view: View, style: Style) -> None:
        """Make the buffer for a picture of the last one, which the target still holds."""
        last, self._last = self._last, None
        self._thicker = style.thickness  # tubes are thicker than the capsules of their axes
        width, height = view.size
        self._side = 2 << LEVEL
        while self._side > max(2, min(width, height) // 2):
            self._side //= 2
        self._resize((-(-width // self._side), -(-height // self._side)))
        now = self._camera(view)
        self._axis = np.zeros(3) if now is None else now.axis
        before = None
        if last is not None and last[0] is target and self._comparable(last, view, style):
            before = self._camera(last[1])
        with self._gl.framebuffers_kept():
            if now is not None and before is not None:
                self._pyramid.build(target)
                self._dilate(before, 1.0 + (MARGIN + style.half_width) / self._side)
                self._move(before, now)
            else:
                self._framebuffers[1].clear(_UNCOVERED)

    def forget(self) -> None:
        """Hide nothing in the next picture."""
        self._last = None

    def after(self, target: GBuffer, view: View, style: Style) -> None:
        """Take note that the target holds the picture of this view."""
        self._last = target, view, style

    def build(self, target: GBuffer) -> None:
        """Do nothing: the buffer is made before the picture."""

    def bind(self, program: Any) -> None:
        """Bind the buffer and tell a program where it is."""
        self._textures[1].use(CULLING["occlusion"])
        program["coverage"] = CULLING["occlusion"]
        program["coverage_axis"] = (*self._axis, self.radius + self._thicker)
        program["coverage_side"] = float(self._side)

    @staticmethod
    def _comparable(last: tuple[GBuffer, View, Style], view: View, style: Style) -> bool:
        """Whether what hid then hides now: same lines, and nothing else is cut away."""
        _, before, then = last
        same = (then.half_width, then.detail, then.thickness) == (style.half_width, style.detail, style.thickness)
        cut = np.array_equal(before.clip_planes, view.clip_planes) and before.region == view.region
        return before.size == view.size and same and cut

    def _camera(self, view: View) -> _Camera | None:
        """Describe a view; None if it shows no depth."""
        reference, _, clip = local_frame(view, self._origin, self._scale, self._top)
        x, y, z, w = clip
        width, height = view.size
        window = np.array([width / 2 * (x + w), height / 2 * (y + w), z, w])
        perspective = bool(np.abs(w[:3]).max() > 0.0)
        along = w if perspective else z
        norm = float(np.linalg.norm(along[:3]))
        rows = np.array([window[0, :3], window[1, :3], along[:3]])
        try:
            inverse = np.linalg.inv(rows)
        except np.linalg.LinAlgError:
            return None
        if not np.isfinite(inverse).all():
            return None
        axis, constants = along[:3] / norm, np.array([window[0, 3], window[1, 3], along[3]])
        # Window depth is (a zeta + b) / (c zeta + d), as the near plane is parallel to the picture's.
        a, c = float((z[:3] + w[:3]) @ axis) / 2, float(w[:3] @ axis)
        b, d = (z[3] + w[3]) / 2, w[3]
        if perspective:
            origin = inverse @ -constants
            ray, ray_x, ray_y = (inverse * norm).T[[2, 0, 1]]
            eye = float(w[3] / norm)
        else:
            ray, ray_x, ray_y = inverse[:, 2] * norm, inverse[:, 0] * w[3], inverse[:, 1] * w[3]
            origin, eye = inverse @ -np.array([constants[0], constants[1], 0.0]), 0.0
        return _Camera(
            reference=reference.astype(np.float64),
            window=window,
            axis=axis,
            eye=eye,
            perspective=perspective,
            origin=origin,
            ray=ray,
            ray_x=ray_x * self._side,
            ray_y=ray_y * self._side,
            depth=np.array([d, b, a, c]),
        )

    def _dilate(self, camera: _Camera, less: float) -> None:
        program, array = self._programs.screen("culling/coverage_dilate.frag")
        texels = self._textures[0].size
        corners = [(x, y) for x in (0, texels[0]) for y in (0, texels[1])]
        pitch = np.linalg.norm([camera.ray_x, camera.ray_y], axis=1)
        if camera.perspective:
            rays = [camera.ray + x * camera.ray_x + y * camera.ray_y for x, y in corners]
            pitch = np.array(
                [
                    min(np.linalg.norm(np.cross(step, ray)) / np.linalg.norm(ray) for ray in rays)
                    for step in (camera.ray_x, camera.ray_y)
                ]
            )
        d, b, a, c = camera.depth
        far = (d - b) / (a - c) if a > c else _EMPTY
        self._pyramid.texture.use(CULLING["occlusion"])
        level = self._side.bit_length() - 2
        for name, value in {
            "pyramid": CULLING["occlusion"],
            "first_level": level,
            "last_level": self._pyramid.levels - 1,
            "texels": texels,
            "depth_terms": tuple(camera.depth),
            "eye": camera.eye,
            "ray": tuple(camera.ray),
            "ray_x": tuple(camera.ray_x),
            "ray_y": tuple(camera.ray_y),
            "pitch": tuple(pitch),
            "perspective": int(camera.perspective),
            "radius": (self.radius + self._thicker, less),
            "far": far,
        }.items():
            program[name] = value
        self._ctx.enable_only(moderngl.NOTHING)
        self._framebuffers[0].use()
        array.render(moderngl.TRIANGLES, vertices=3)

    def _move(self, before: _Camera, now: _Camera) -> None:
        stages = {"vertex": "culling/coverage_grid.vert", "fragment": "culling/coverage_grid.frag"}
        program = self._programs.render(stages)
        if self._grid is None:
            self._grid = self._ctx.vertex_array(program, [])
        columns, rows = texels = self._textures[0].size
        # From the last camera's homogeneous (X d, Y d, d, 1) or (X, Y, zeta, 1) to local millimetres, in float64.
        place = np.zeros((4, 4))
        place[:3] = np.stack([before.ray_x, before.ray_y, before.ray, before.origin], axis=1)
        place[:3, 3] += (before.reference - now.reference) * self._scale
        place[3, 3] = 1.0
        x, y, z, w = now.window
        clip = np.array([2 / (self._side * columns) * x - w, 2 / (self._side * rows) * y - w, z, w])
        self._textures[0].use(CULLING["occlusion"])
        program["dilated"] = CULLING["occlusion"]
        program["texels"] = texels
        program["perspective"] = int(before.perspective)
        program["eye"] = before.eye
        program["clip_from_texel"] = tuple((clip @ place).T.ravel())
        program["zeta_from_texel"] = tuple(np.append(now.axis, 0.0) @ place)
        program["jump"] = self.radius + self._thicker
        self._framebuffers[1].clear(_UNCOVERED)
        self._framebuffers[1].use()
        self._ctx.enable_only(moderngl.BLEND | moderngl.CULL_FACE)
        self._ctx.blend_equation = (moderngl.MAX, moderngl.MAX)
        self._ctx.front_face, self._ctx.cull_face = "ccw", "back"
        if columns > 1 and rows > 1:
            self._grid.render(moderngl.TRIANGLES, vertices=6 * (columns - 1) * (rows - 1))
        self._ctx.blend_equation = (moderngl.FUNC_ADD, moderngl.FUNC_ADD)
        self._ctx.enable_only(moderngl.NOTHING)

    @property
    def texture(self) -> moderngl.Texture:
        """The buffer: greatest zeta (mm) at which something may show, by squares of the picture."""
        return self._textures[1]

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        return self._pyramid.nbytes + sum(4 * texture.width * texture.height for texture in self._textures)

    def _drop(self) -> None:
        for framebuffer in self._framebuffers:
            framebuffer.release()
        for texture in self._textures:
            texture.release()
        self._framebuffers.clear()
        self._textures.clear()

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._drop()
        if self._grid is not None:
            self._grid.release()
            self._grid = None
        self._pyramid.release()
        self._last = None
