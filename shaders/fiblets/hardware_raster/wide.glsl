// Wide lines: a rectangle around the capsule that a part of a segment takes in the window; fiblets/hardware_raster/capsule.frag finds out which
// of its pixels the capsule holds. Half the width is half_line_width. Around tubes it is as wide as their outline.
//
//        side 1  +----------------------+
//                | (a ............... b )|      before the start there is nothing but where the streamline starts
//        side 0  +----------------------+

#include "fiblets/segments/clipped_segment.glsl"

const float ROUNDING = 0.05;  // pixels

// Corner 0 to 3 of a triangle strip, clip coordinates.
vec4 corner_of(ClippedSegment piece, int corner) {
    vec2 run = piece.b.xy - piece.a.xy;
#if FEATURE_TUBES
    float size = length(run), reach = piece.reach, before = reach;
#elif FEATURE_LINE_ENDS
    float size = length(run), reach = half_line_width + ROUNDING, before = reach;   // a short segment's end reaches beyond its start
#else
    float size = length(run), reach = half_line_width + ROUNDING, before = piece.start ? reach : ROUNDING;
#endif
    vec2 along = size > 0.0 ? run / size : vec2(1.0, 0.0), across = vec2(-along.y, along.x);
    vec2 end = corner < 2 ? piece.a.xy - before * along : piece.b.xy + reach * along;
    vec2 at = end + ((corner & 1) == 0 ? -reach : reach) * across;
    return vec4(2.0 * at / viewport - 1.0, 0.0, 1.0);
}
