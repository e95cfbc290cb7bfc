"""The mesh pipelines on OpenGL without mesh shaders: their stages as compute shaders that write to buffers.

Task and mesh stage run with the very includes that the real ones are made of; ``fiblets/mesh/outputs.glsl`` alone, a
page of assignments to built-in arrays, gives way to writes into a buffer. A vertex stage then hands vertices,
primitive by primitive, to the rasteriser and the pipeline's own fragment stage.
"""

import moderngl
import numpy as np

from pvfiblets.engine.fiblets.pipelines import CONSTANTS
from pvfiblets.engine.fiblets.pipelines.mesh import TASK_FIBLETS, MeshPipeline
from pvfiblets.engine.gl.bindings import FIBLET_ROUNDS
from pvfiblets.engine.gl.shaders import assemble

TASK_WORDS, VERTICES, INDICES, VARYING, MOST = 16, 480, 180, 24, 60
MESH_WORDS = VERTICES + INDICES + VARYING * MOST + 4
SHARES = {False: 1, True: 4}

TASK = """
#version 430
layout(local_size_x = {{ mesh_threads }}) in;
#include "fiblets/mesh/cull.glsl"
#include "fiblets/mesh/shares.glsl"
layout(std430, binding = 8) writeonly buffer Tasks { uint tasks[]; };
void main() {
    Survivors survivors;
    uint count = cull(survivors), at = (first_group + gl_WorkGroupID.x) * 16u;
    if (gl_LocalInvocationIndex != 0u) return;
    tasks[at] = SHARES * count;
    tasks[at + 1u] = survivors.first;
    for (uint i = 0u; i < ROUNDS; ++i) tasks[at + 2u + i] = survivors.bits[i];
}
"""

# Where the words of a mesh stand: vertices, indices, what primitives hand over, their number.
LAYOUT = """
const uint MESH_WORDS = 2104u, INDICES = 480u, HANDED_AT = 660u, COUNT = 2100u;
"""

MESH = """
#version 430
layout(local_size_x = THREADS_OF) in;
#include "fiblets/mesh/survivors.glsl"
#include "fiblets/mesh/segment.glsl"
layout(std430, binding = 8) readonly buffer Tasks { uint tasks[]; };
layout(std430, binding = 9) writeonly buffer Meshes { uint meshes[]; };
LAYOUT
#define VARYING
#define TO(name) name
#include "fiblets/hardware_raster/write_varyings.glsl"
uint mesh;
void put_vertex(uint vertex, vec4 at) {
    for (uint a = 0u; a < 4u; ++a) meshes[mesh + 4u * vertex + a] = floatBitsToUint(at[a]);
}
void put_triangle(uint primitive, uvec3 vertices) {
    for (uint i = 0u; i < 3u; ++i) meshes[mesh + INDICES + 3u * primitive + i] = vertices[i];
}
void put_line(uint primitive, uvec2 vertices) {
    for (uint i = 0u; i < 2u; ++i) meshes[mesh + INDICES + 2u * primitive + i] = vertices[i];
}
void put_counts(uint vertices, uint primitives) {
    if (gl_LocalInvocationIndex == 0u) meshes[mesh + COUNT] = primitives;
}
void put_varyings(uint primitive, Varyings varyings, ClippedSegment piece, vec3 from, vec3 to) {
    write_varyings(varyings, piece, from, to);
    uint at = mesh + HANDED_AT + 24u * primitive;
    for (uint a = 0u; a < 2u; ++a) meshes[at + a] = varying_ids[a];
#if FEATURE_WIDE_LINES && (FEATURE_PEEL || FEATURE_GATHER_SLICES)
    meshes[at + 2u] = varying_streamline;
    meshes[at + 3u] = floatBitsToUint(varying_first);
#endif
#if FEATURE_WIDE_LINES && !FEATURE_TUBES
    for (uint a = 0u; a < 4u; ++a) meshes[at + 4u + a] = floatBitsToUint(varying_start[a]);
    for (uint a = 0u; a < 4u; ++a) meshes[at + 8u + a] = floatBitsToUint(varying_end[a]);
    meshes[at + 12u] = varying_onward;
#elif !FEATURE_TUBES
    for (uint a = 0u; a < 2u; ++a) meshes[at + 4u + a] = varying_cells[a];
    for (uint a = 0u; a < 2u; ++a) meshes[at + 6u + a] = floatBitsToUint(varying_depths[a]);
#endif
#if FEATURE_TUBES || FEATURE_WIDE_LINES && FEATURE_CLIP_PLANES
    for (uint a = 0u; a < 3u; ++a) meshes[at + 13u + a] = floatBitsToUint(varying_from[a]);
    for (uint a = 0u; a < 3u; ++a) meshes[at + 16u + a] = floatBitsToUint(varying_to[a]);
#endif
}
#include "fiblets/mesh/STAGE.glsl"
void main() {
    uint at = gl_WorkGroupID.y * 16u, k = gl_WorkGroupID.x;
    mesh = (gl_WorkGroupID.y * gl_NumWorkGroups.x + k) * MESH_WORDS;
    if (k >= tasks[at]) {
        put_counts(0u, 0u);
        return;
    }
    Survivors survivors;
    survivors.first = tasks[at + 1u];
    for (uint i = 0u; i < ROUNDS; ++i) survivors.bits[i] = tasks[at + 2u + i];
    draw_share(survivor(survivors, k / SHARES), k % SHARES);
}
"""

VERTEX = """
#version 430
#include "fiblets/segments/clipped_segment.glsl"
#define VARYING flat out
#include "fiblets/hardware_raster/varyings.glsl"
layout(std430, binding = 9) readonly buffer Meshes { uint meshes[]; };
LAYOUT
float value(uint at) { return uintBitsToFloat(meshes[at]); }
void main() {
#if FEATURE_WIDE_LINES
    const uint corners = 3u, most = 30u;
#else
    const uint corners = 2u, most = 60u;
#endif
    uint number = uint(gl_VertexID), corner = number % corners, primitive = number / corners % most;
    uint mesh = number / corners / most * MESH_WORDS, at = mesh + HANDED_AT + 24u * primitive;
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    if (primitive >= meshes[mesh + COUNT]) return;
    uint vertex = mesh + 4u * meshes[mesh + INDICES + corners * primitive + corner];
    gl_Position = vec4(value(vertex), value(vertex + 1u), value(vertex + 2u), value(vertex + 3u));
    varying_ids = uvec2(meshes[at], meshes[at + 1u]);
#if FEATURE_WIDE_LINES && (FEATURE_PEEL || FEATURE_GATHER_SLICES)
    varying_streamline = meshes[at + 2u];
    varying_first = value(at + 3u);
#endif
#if FEATURE_WIDE_LINES && !FEATURE_TUBES
    varying_start = vec4(value(at + 4u), value(at + 5u), value(at + 6u), value(at + 7u));
    varying_end = vec4(value(at + 8u), value(at + 9u), value(at + 10u), value(at + 11u));
    varying_onward = meshes[at + 12u];
#elif !FEATURE_TUBES
    varying_cells = uvec2(meshes[at + 4u], meshes[at + 5u]);
    varying_depths = vec2(value(at + 6u), value(at + 7u));
#endif
#if FEATURE_TUBES || FEATURE_WIDE_LINES && FEATURE_CLIP_PLANES
    varying_from = vec3(value(at + 13u), value(at + 14u), value(at + 15u));
    varying_to = vec3(value(at + 16u), value(at + 17u), value(at + 18u));
#endif
}
"""


class EmulatedMesh(MeshPipeline):
    """A mesh pipeline whose task and mesh stages are compute shaders; keeps what they wrote last.

    ``tasks`` and ``meshes`` are lists, one item a round and chunk: ``(groups, 10)`` words, count, first fiblet and
    bits; and ``(groups, meshes of a group, words)``.
    """

    def __init__(self, ctx, gl, programs, n_fiblets, *, serial=False):
        super().__init__(ctx, gl, programs, n_fiblets, serial=serial)
        self.kept = {}
        self.tasks, self.meshes = [], []

    def _has_ballots(self):
        return False

    def draw(self, job):
        self.tasks, self.meshes = [], []
        super().draw(job)

    def _compiled(self, job, features):
        every = frozenset([*self._features(job), *features]) - {"PER_PRIMITIVE", "MESH_EXT"}
        serial = self.name == "mesh-serial"
        key = serial, bool(job.wide), every
        if key not in self.kept:
            stage, threads = ("serial", "1") if serial else ("together", "{{ mesh_threads }}")
            mesh = MESH.replace("LAYOUT", LAYOUT).replace("STAGE", stage).replace("THREADS_OF", threads)
            fragment = "fiblets/hardware_raster/capsule.frag" if job.wide else "fiblets/hardware_raster/line.frag"
            program = self._ctx.program(
                vertex_shader=assemble("vertex", every, CONSTANTS, source=VERTEX.replace("LAYOUT", LAYOUT)),
                fragment_shader=assemble(fragment, every, CONSTANTS),
            )
            self.kept[key] = (
                self._ctx.compute_shader(assemble("task", every, CONSTANTS, source=TASK)),
                self._ctx.compute_shader(assemble("mesh", every, CONSTANTS, source=mesh)),
                program,
                self._ctx.vertex_array(program, []),
            )
        return self.kept[key]

    def _round(self, job, features):
        task, mesh, program, array = self._compiled(job, features)
        ctx, wide = self._ctx, bool(job.wide)
        if job.clustered:
            self._mark_open(job, second="SECOND_ROUND" in features)
        for chunk in job.chunks:
            chunk.bind_storage()
            if job.clustered:
                self._bind_open(chunk)
            groups, each = -(-chunk.n_fiblets // TASK_FIBLETS), TASK_FIBLETS * SHARES[wide]
            tasks = ctx.buffer(reserve=groups * TASK_WORDS * 4)
            meshes = ctx.buffer(reserve=groups * each * MESH_WORDS * 4)
            tasks.bind_to_storage_buffer(8)
            meshes.bind_to_storage_buffer(9)
            self._bind(task, job, features)
            if "first_round" in program:
                self._target.kept.use(FIBLET_ROUNDS["first_round"])
                program["first_round"] = FIBLET_ROUNDS["first_round"]
            for first in range(0, groups, self._max_tasks):
                task["first_group"] = first
                task.run(min(self._max_tasks, groups - first))
            ctx.memory_barrier()
            mesh.run(each, groups)
            ctx.memory_barrier()
            ctx.enable_only(moderngl.DEPTH_TEST)
            ctx.depth_func = "<"
            primitives = groups * each * (30 if wide else MOST)
            array.render(moderngl.TRIANGLES if wide else moderngl.LINES, vertices=primitives * (3 if wide else 2))
            self.tasks.append(np.frombuffer(tasks.read(), "<u4").reshape(groups, TASK_WORDS)[:, :10])
            self.meshes.append(np.frombuffer(meshes.read(), "<u4").reshape(groups, each, MESH_WORDS))
            tasks.release()
            meshes.release()

    def release(self):
        super().release()
        for things in self.kept.values():
            for thing in things:
                thing.release()
        self.kept.clear()


def emulated_renderer(monkeypatch, gl, fiblets, *, serial=False, **options):
    """Return a FibletRenderer that draws with an :class:`EmulatedMesh`."""
    from pvfiblets.engine import FibletRenderer
    from pvfiblets.engine.fiblets import renderer

    def make(name, ctx, opengl, programs, sizes, limits, alike):
        return EmulatedMesh(ctx, opengl, programs, sum(sizes), serial=serial)

    with monkeypatch.context() as patch:
        patch.setattr(renderer, "make_pipeline", make)
        return FibletRenderer(gl, fiblets, pipeline="compute", **options)
