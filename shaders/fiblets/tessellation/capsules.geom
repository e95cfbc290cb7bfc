// Pipeline `tessellation`, wide lines: a segment comes in, a rectangle goes out around the part of it that is drawn.

#version 430

layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;

#include "fiblets/hardware_raster/wide.glsl"
#include "fiblets/hardware_raster/write_varyings.glsl"

in vec4 end_point[];
flat in uvec4 segment_ids[];
flat in uint segment_tangent[];
flat in vec3 segment_ahead[];
flat in float segment_first[];

void main() {
    vec4 from = end_point[0], to = end_point[1];
    uvec4 ids = segment_ids[0];
    ClippedSegment piece;
    if ((ids.w & 0x40000u) != 0u) return;
    if (!piece_of(from.xyz, to.xyz, (ids.w & 0x10000u) != 0u, (ids.w & 0x20000u) != 0u, piece)) return;
    Varyings varyings = Varyings(ids.x, uvec2(ids.y, segment_tangent[0]), ids.z, segment_first[0], ids.w & 255u, float((ids.w >> 8u) & 255u), vec2(from.w, to.w), segment_ahead[0]);
    for (int corner = 0; corner < 4; ++corner) {
        gl_Position = corner_of(piece, corner);
        write_varyings(varyings, piece, from.xyz, to.xyz);
        EmitVertex();
    }
    EndPrimitive();
}
