// How wide segments join. A pixel beside a joint belongs to the segment beside it; the round end is drawn only where
// it lies beside neither, on the outer side of the bend:
//
//      ------------.  wedge         A pixel is within half a width of the line where it is so of the line's nearest point. If that is
//       segment k  |\.              on a segment, the pixel lies beside it; if it is the joint, in the wedge. Nothing is left
//      ------------o- \.            open, and pixels do not show the end of one segment over the middle of the next.
//                   \   \.
//                    \ segment k + 1
//
// Symbols
//   ahead        the next segment's run, mm; none where the line ends, or may not go on there as it does here
//   onward       unit vector of that run in the window; none where it is shorter than LEAST pixels, and rounding would tell its
//                direction: then the whole round end is drawn
//   overlap      pixels of the wedge over the next segment: rounding must not part them

#include "frame/blocks.glsl"

const float JOINT_LEAST = 0.1, JOINT_OVERLAP = 0.05;
const uint NO_ONWARD = 0x80008000u;   // as no direction is packed

// At the end of a segment in the window: x, y, depth, W.
vec2 onward_at(vec4 end, vec3 ahead) {
    vec4 c = window_from_local[0] * ahead.x + window_from_local[1] * ahead.y + window_from_local[2] * ahead.z;
    vec2 run = c.xy - end.xy * c.w;
    float size = length(run);
    return size > JOINT_LEAST * end.w ? run / size : vec2(0.0);
}

// away: from the joint to the pixel.
bool beyond_joint(vec2 onward, vec2 away) { return dot(onward, away) > JOINT_OVERLAP; }

uint packed_onward(vec2 onward) {
    if (onward == vec2(0.0)) return NO_ONWARD;
    ivec2 s = ivec2(round(32767.0 * onward));
    return uint(s.x & 0xFFFF) | (uint(s.y) << 16u);
}

vec2 unpacked_onward(uint word) {
    return word == NO_ONWARD ? vec2(0.0) : vec2(ivec2(int(word << 16) >> 16, int(word) >> 16)) / 32767.0;
}
