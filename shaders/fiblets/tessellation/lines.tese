// Pipeline `tessellation`, thin lines: one end of a segment's part (fiblets/hardware_raster/thin.glsl).

#version 430

#include "fiblets/tessellation/segment.glsl"
#include "fiblets/hardware_raster/thin.glsl"
#include "fiblets/hardware_raster/write_varyings.glsl"

void main() {
    Segment segment = this_segment();
    ClippedSegment piece;
    if (!segment.drawn || !piece_of(segment.from, segment.to, segment.start, segment.cap, piece)) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside, at both ends
        return;
    }
    Thin line = thin_line(piece);
    gl_Position = at_start ? line.first : line.last;
    Varyings varyings = Varyings(patch_ids.z, patch_ids.x, uintBitsToFloat(patch_ids.w), segment.index, segment.steps,
                                 vec2(value_of(segment.index), value_of(segment.index + 1u)), vec3(0.0));
    write_varyings(varyings, piece, segment.from, segment.to);
}
