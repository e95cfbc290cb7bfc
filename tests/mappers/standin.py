"""An independent renderer with the engine's interface: OpenGL's own lines from the points themselves.

It shares no code with the engine: no culling, no decoding, no compute shaders; planes cut by
gl_ClipDistance. Tests of the mapper that pass with both renderers say nothing about the engine, and
those that pass with one tell whose fault it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, ClassVar

import moderngl
import numpy as np

EMPTY = 0xFFFFFFFF
GL_CLIP_DISTANCE0 = 0x3000

VERTEX = """
#version 330
in vec3 point;
in uint streamline;
in float index;
in float value;
uniform mat4 matrix;
out vec3 position;
out float along;
out float number;
flat out uint id;
void main()
{
  gl_Position = matrix * vec4(point, 1.0);
  position = point;
  along = index;
  number = value;
  id = streamline;
}
"""

# A line's tangent is the same at both ends of a segment, so a geometry shader hands it over.
GEOMETRY = """
#version 330
layout(lines) in;
layout(line_strip, max_vertices = 2) out;
uniform vec4 planes[8];
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[8]; };
in vec3 position[];
in float along[];
in float number[];
flat in uint id[];
flat out vec3 tangent;
flat out uint streamline;
out float at;
out float value;
void main()
{
  for (int i = 0; i < 2; ++i)
  {
    gl_Position = gl_in[i].gl_Position;
    for (int p = 0; p < 8; ++p)
    {
      gl_ClipDistance[p] = dot(planes[p], vec4(position[i], 1.0));
    }
    tangent = normalize(position[1] - position[0]);
    streamline = id[0];
    at = along[i];
    value = number[i];
    EmitVertex();
  }
}
"""

FRAGMENT = """
#version 330
flat in vec3 tangent;
flat in uint streamline;
in float at;
in float value;
layout(location = 0) out uint key;
layout(location = 1) out uvec2 ids;
layout(location = 2) out vec2 position;
uint octahedral(vec3 d)
{
  d /= abs(d.x) + abs(d.y) + abs(d.z);
  vec2 p = d.yz;
  if (d.x < 0.0)
  {
    p = (1.0 - abs(d.zy)) * vec2(d.y < 0.0 ? -1.0 : 1.0, d.z < 0.0 ? -1.0 : 1.0);
  }
  ivec2 s = ivec2(round(p * 32767.0));
  return (uint(s.x) & 0xFFFFu) | (uint(s.y) << 16);
}
void main()
{
  key = uint(min(gl_FragCoord.z * 4294967295.0, 4294966784.0));
  ids = uvec2(streamline, octahedral(tangent));
  position = vec2(at, value);
}
"""


@dataclass
class PlainFiblets:
    """The part of a FibletSet that a mapper and this renderer need."""

    points: np.ndarray
    offsets: np.ndarray
    values: np.ndarray | None = None
    promise: float = 0.0

    @property
    def n_streamlines(self) -> int:
        return len(self.offsets) - 1

    @property
    def n_points(self) -> int:
        return len(self.points)

    @property
    def bounds(self) -> tuple[float, ...]:
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        return tuple(float(end) for pair in zip(low, high, strict=True) for end in pair)


class LineRenderer:
    """Draws `PlainFiblets` into a G-buffer with GL_LINE_STRIP."""

    made: ClassVar[list[LineRenderer]] = []

    def __init__(self, ctx: Any, fiblets: PlainFiblets) -> None:
        self.ctx = ctx
        self.released = False
        self.draws = 0
        self.origin = fiblets.points.mean(axis=0)
        counts = np.diff(fiblets.offsets)
        owner = np.repeat(np.arange(len(counts)), counts)
        index = np.arange(len(fiblets.points)) - np.repeat(fiblets.offsets[:-1], counts)
        values = np.zeros(len(owner)) if fiblets.values is None else fiblets.values
        vertex = np.empty(len(owner), [("point", "f4", 3), ("id", "u4"), ("index", "f4"), ("value", "f4")])
        vertex["point"] = fiblets.points - self.origin
        vertex["id"], vertex["index"], vertex["value"] = owner, index, values
        starts = np.flatnonzero(index == 0)[1:]
        elements = np.insert(np.arange(len(owner), dtype=np.uint32), starts, EMPTY)
        self._program = ctx.program(VERTEX, FRAGMENT, GEOMETRY)
        self._buffers = [ctx.buffer(vertex.tobytes()), ctx.buffer(elements.astype("u4").tobytes())]
        self._lines = ctx.vertex_array(
            self._program,
            [(self._buffers[0], "3f4 1u4 1f4 1f4", "point", "streamline", "index", "value")],
            index_buffer=self._buffers[1],
        )
        self._target: Any = None
        self._key: Any = None
        self._gbuffer: Any = None
        LineRenderer.made.append(self)

    def needs_outside(self, view: Any, style: Any) -> bool:
        return False

    def render(self, view: Any, style: Any, outside: Any = None) -> Any:
        key = (view, style)
        if key == self._key:
            return self._gbuffer
        if self._target is None or self._target.size != tuple(view.size):
            self._release_target()
            textures = [
                self.ctx.texture(view.size, 1, dtype="u4"),
                self.ctx.texture(view.size, 2, dtype="u4"),
                self.ctx.texture(view.size, 2, dtype="f4"),
            ]
            for texture in textures:
                texture.filter = moderngl.NEAREST, moderngl.NEAREST
            depth = self.ctx.depth_renderbuffer(view.size)
            self._target = self.ctx.framebuffer(textures, depth)
        matrix = np.array(view.model_view_projection, dtype=np.float64)
        matrix[:, 3] += matrix[:, :3] @ self.origin
        self._target.use()
        self.ctx.scissor = None
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        self.ctx.depth_func = "<"
        self._target.color_mask = [(True,) * 4] * 3
        self._target.depth_mask = True
        self._target.clear(depth=1.0)
        self._target.color_attachments[0].write(np.full(view.size, EMPTY, "u4").tobytes())
        self._program["matrix"].write(matrix.T.astype("f4").tobytes())
        planes = np.zeros((8, 4))
        count = len(view.clip_planes)
        planes[:count] = view.clip_planes
        planes[:, 3] += planes[:, :3] @ self.origin
        self._program["planes"].write(planes.astype("f4").tobytes())
        for plane in range(count):
            self.ctx.enable_direct(GL_CLIP_DISTANCE0 + plane)
        self._lines.render(moderngl.LINE_STRIP)
        for plane in range(count):
            self.ctx.disable_direct(GL_CLIP_DISTANCE0 + plane)
        self.draws += 1
        self._key = key
        depth, ids, position = self._target.color_attachments
        self._gbuffer = SimpleNamespace(depth=depth, ids=ids, position=position, relief=None, generation=self.draws)
        return self._gbuffer

    def explain(self) -> dict[str, Any]:
        return {"passes": [], "features": [], "buffers": [], "fiblets_total": 0}

    def _release_target(self) -> None:
        if self._target is not None:
            for attachment in (*self._target.color_attachments, self._target.depth_attachment):
                attachment.release()
            self._target.release()
            self._target = None
            self._key = None

    def release(self) -> None:
        if self.released:
            return
        self._release_target()
        for thing in (self._lines, self._program, *self._buffers):
            thing.release()
        self.released = True
