// Pipeline `tessellation`, wide lines: a point, for fiblets/tessellation/capsules.geom to make a rectangle between it and the one before.

#version 430

#include "fiblets/tessellation/segment.glsl"

out vec4 end_point;             // local mm; w: per-point value
flat out uvec4 segment_ids;     // fiblet; segment, steps in bits 8 to 15, start and cap in bits 16 and 17; bit 18: nothing; streamline; first point
flat out vec3 segment_ahead;    // the next segment's run

void main() {
    Segment segment = this_segment();
    uint next = segment.index + 1u;
    end_point = at_start ? vec4(segment.from, value_of(segment.index)) : vec4(segment.to, value_of(next));
    segment_ids = uvec4(patch_ids.x, segment.index | (uint(segment.steps) << 8u)
                        | (segment.start ? 0x10000u : 0u) | (segment.cap ? 0x20000u : 0u) | (segment.drawn ? 0u : 0x40000u), patch_ids.zw);
    segment_ahead = next == (patch_ids.y & 255u) ? patch_beyond : point_of(next + 1u) - segment.to;
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
