"""The paper's rival (Russig et al. 2020, section 4; after Nunes et al. 2012): spline tubes by hardware tessellation.

A circle is swept along each segment's cubic Hermite curve. How finely depends on its size on the screen: 6 to 30
corners around, and up to 5 additional samples along. It runs on a bare moderngl context; no VTK. Unlike a swept
sphere such a tube has open ends, and where the radius changes fast it bulges less.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

LEAST_SIDES, MOST_SIDES, ADDITIONAL = 6, 30, 5  # the paper's
TOLERANCE = 0.125  # pixels: below it a level is fine enough
STAGES = {
    "vertex_shader": "baselines/tessellated.vert",
    "tess_control_shader": "baselines/tessellated.tesc",
    "tess_evaluation_shader": "baselines/tessellated.tese",
    "fragment_shader": "baselines/tessellated.frag",
}


class TessellatedTubes:
    """Spline tubes on the GPU, OpenGL 4.3 or later, and a framebuffer that they are drawn into.

    ``tolerance``: pixels that a polygon may stray from its curve as long as the levels go that far; ``sides``: the
    least and the most corners around a tube.
    """

    def __init__(
        self,
        ctx: Any,
        tubes: Any,
        size: tuple[int, int],
        *,
        tolerance: float = TOLERANCE,
        sides: tuple[int, int] = (LEAST_SIDES, MOST_SIDES),
    ) -> None:
        self._ctx, self._size = ctx, tuple(size)
        self._scaled = bool(tubes.scaled)
        self.origin = tubes.points.mean(axis=0) if tubes.n_nodes else np.zeros(3)
        nodes = np.empty((tubes.n_nodes, 11), np.float32)
        nodes[:, :3] = tubes.points - self.origin
        nodes[:, 3] = tubes.radius
        nodes[:, 4:7] = tubes.tangents
        nodes[:, 7] = tubes.radius_slopes
        nodes[:, 8:] = carried_normals(tubes.tangents, tubes.segments)
        indices = np.ascontiguousarray(tubes.segments, np.uint32)
        self.nbytes = nodes.nbytes + indices.nbytes
        self._program = _program(ctx, tolerance=tolerance, sides=sides)
        self._nodes, self._indices = ctx.buffer(nodes.tobytes()), ctx.buffer(indices.tobytes())
        layout = (self._nodes, "4f 4f 3f", "node_place", "node_slope", "node_across")
        self._array = ctx.vertex_array(self._program, [layout], index_buffer=self._indices, index_element_size=4)
        self._colour = ctx.renderbuffer(self._size, 4)
        self._depth = ctx.depth_renderbuffer(self._size)
        self._target = ctx.framebuffer([self._colour], self._depth)

    def render(self, model_view_projection: Any) -> None:
        """Draw one picture."""
        import moderngl

        from pvfiblets.engine.gl.moderngl_extras import GLExtras

        shift = np.eye(4)
        shift[:3, 3] = self.origin
        matrix = np.asarray(model_view_projection, np.float64) @ shift
        x, y, z, w = matrix
        # Clip coordinates may have any scale: with a unit normal the last row is the distance in front of the eye.
        unit = np.linalg.norm(w[:3])
        planes = np.array([w + x, w - x, w + y, w - y, w + z])
        planes /= np.linalg.norm(planes[:, :3], axis=1)[:, None]
        eye = np.linalg.solve(matrix[[0, 1, 3], :3], -matrix[[0, 1, 3], 3])
        near = -float(planes[4] @ (*eye, 1.0))  # the eye lies that far outside of the near plane
        values = {
            "to_clip": matrix.T,
            "depth_row": w / unit,
            "planes": planes,
            "eye": eye,
            "nearest": near,
            "pixels": 0.5 * self._size[1] * np.linalg.norm(y[:3]) / unit,
            "scaled": self._scaled,
        }
        for name, value in values.items():
            if name in self._program:  # compilers drop what a stage does not use
                self._program[name].write(np.asarray(value, np.int32 if name == "scaled" else np.float32).tobytes())
        self._ctx.patch_vertices = 2
        self._ctx.enable_only(moderngl.DEPTH_TEST)
        with GLExtras(self._ctx).framebuffers_kept():  # this one may be released next
            self._target.use()
            self._target.clear(depth=1.0)
            self._array.render(moderngl.PATCHES)

    def depth(self) -> Array:
        """Return the last picture's window depth: (height, width), the bottom row first, 1 in empty pixels."""
        width, height = self._size
        depth = np.frombuffer(self._target.read(attachment=-1, components=1, dtype="f4"), np.float32)
        return depth.reshape(height, width).astype(np.float64)

    def release(self) -> None:
        """Give everything back."""
        for thing in (self._array, self._nodes, self._indices, self._target, self._colour, self._depth, self._program):
            thing.release()


def _program(ctx: Any, *, tolerance: float, sides: tuple[int, int]) -> Any:
    from pvfiblets.engine.gl.shaders import assemble

    constants = {
        "tolerance": float(tolerance),
        "least_sides": float(sides[0]),
        "most_sides": float(sides[1]),
        "most_steps": float(1 + ADDITIONAL),
    }
    return ctx.program(**{stage: assemble(name, constants=constants) for stage, name in STAGES.items()})


def carried_normals(tangents: Array, segments: npt.NDArray[np.int64]) -> Array:
    """Return a unit vector across each node's tangent that turns as little as can be from node to node."""
    # Each tube starts with any, which is projected from node to node onto the plane across the next tangent.
    lengths = np.linalg.norm(tangents, axis=1, keepdims=True)
    unit = np.divide(tangents, lengths, out=np.zeros(tangents.shape), where=lengths > 0.0)
    normals = across(unit)
    if not len(segments):
        return normals
    starts = np.ones(len(segments), bool)
    starts[1:] = segments[1:, 0] != segments[:-1, 1]
    first = np.flatnonzero(starts)
    counts = np.diff([*first, len(segments)])
    order = np.argsort(-counts, kind="stable")  # long chains first: those still going are at the front
    first, counts = first[order], counts[order]
    for step in range(counts[0]):
        going = int(np.searchsorted(-counts, -step, side="left"))
        from_node, to_node = segments[first[:going] + step].T
        carried = normals[from_node]
        carried = carried - unit[to_node] * np.einsum("ij,ij->i", carried, unit[to_node])[:, None]
        length = np.linalg.norm(carried, axis=1, keepdims=True)
        kept = length[:, 0] > 1e-6
        normals[to_node[kept]] = carried[kept] / length[kept]
    return normals


def across(unit: Array) -> Array:
    """Return a unit vector across each of some, (n, 3); any one for zero vectors."""
    axis = np.where(np.abs(unit[:, :1]) < math.sqrt(1.0 / 3.0) + 1e-3, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    found: Array = axis - unit * np.einsum("ij,ij->i", axis, unit)[:, None]
    found /= np.linalg.norm(found, axis=1, keepdims=True)
    return found
