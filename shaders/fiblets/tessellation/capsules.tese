// Pipeline `tessellation`, wide lines: one end of a segment, for fiblets/tessellation/capsules.geom to make a rectangle of.

#version 430

#include "fiblets/tessellation/segment.glsl"

out vec4 end_point;
flat out uvec4 segment_ids;     // streamline; tangent at the start; fiblet; segment, steps in bits 8 to 15, start and cap in bits 16 and 17; bit 18: nothing
flat out uint segment_tangent;  // at the end
flat out vec3 segment_ahead;    // the next segment's run
flat out float segment_first;

void main() {
    Segment segment = this_segment();
    end_point = at_start ? segment.from : segment.to;
    segment_ids = uvec4(patch_ids.x, segment.tangents.x, patch_ids.y, segment.index | (uint(segment.steps) << 8u)
                        | (segment.start ? 0x10000u : 0u) | (segment.cap ? 0x20000u : 0u) | (segment.drawn ? 0u : 0x40000u));
    segment_tangent = segment.tangents.y;
    segment_ahead = segment.index + 1u == (patch_ids.z & 255u) ? patch_beyond : delta_of(segment.index + 1u);
    segment_first = patch_first;
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
