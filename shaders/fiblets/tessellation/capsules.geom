// Pipeline `tessellation`, wide lines: two points come in, of a segment the last before the first, and a rectangle goes out around the
// part of it that is drawn.

#version 430

layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;

#include "fiblets/hardware_raster/wide.glsl"
#include "fiblets/hardware_raster/write_varyings.glsl"

in vec4 end_point[];
flat in uvec4 segment_ids[];
flat in vec3 segment_ahead[];

void main() {
    vec4 from = end_point[1], to = end_point[0];
    uvec4 ids = segment_ids[1];
    ClippedSegment piece;
    if ((ids.y & 0x40000u) != 0u) return;
    if (!piece_of(from.xyz, to.xyz, (ids.y & 0x10000u) != 0u, (ids.y & 0x20000u) != 0u, piece)) return;
    Varyings varyings = Varyings(ids.z, ids.x, uintBitsToFloat(ids.w), ids.y & 255u, float((ids.y >> 8u) & 255u), vec2(from.w, to.w),
                                 segment_ahead[1]);
    for (int corner = 0; corner < 4; ++corner) {
        gl_Position = corner_of(piece, corner);
        write_varyings(varyings, piece, from.xyz, to.xyz);
        EmitVertex();
    }
    EndPrimitive();
}
