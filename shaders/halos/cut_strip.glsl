// The part of a strip's segment that is left before the near plane, beyond the far one, far beside the picture and beyond planes of
// the caller's. Without FEATURE_HALO_CUT nothing of the data can lie there, and all is left.
//
// Symbols
//   part         where on the segment what is left begins and ends, 0..1
//   a, b         its ends in the window; first, last: of what is left

#include "halos/widths.glsl"

#if FEATURE_HALO_CUT
const float BESIDE = {{ beside }};      // half pictures from the middle, beyond which an axis is cut off

// Narrows part to where a height that is a at 0 and b at 1 is not negative.
void narrow(float a, float b, inout vec2 part) {
    float t = a / (a - b);
    if (a < 0.0) part.x = b < 0.0 ? 2.0 : max(part.x, t);
    else if (b < 0.0) part.y = min(part.y, t);
}

// What a number that is a at the start and b at the end is at either end of a part of the segment: exact where that is whole.
vec2 cut(float a, float b, vec2 part) { return vec2(a + part.x * (b - a), b - (1.0 - part.y) * (b - a)); }

// False if nothing is left.
bool cut_strip(vec3 start, vec3 stop, vec4 a, vec4 b, vec2 cue, inout vec2 part, inout vec4 first, inout vec4 last) {
    vec2 margin = BESIDE * half_picture;
    float reach = 2.0 * max(reaches(cue.x, a.w).y, reaches(cue.y, b.w).y);
    narrow(a.w - a.z, b.w - b.z, part);
    narrow(a.z, b.z, part);
    narrow(margin.x * a.w + reach + a.x, margin.x * b.w + reach + b.x, part);
    narrow(margin.x * a.w + reach - a.x, margin.x * b.w + reach - b.x, part);
    narrow(margin.y * a.w + reach + a.y, margin.y * b.w + reach + b.y, part);
    narrow(margin.y * a.w + reach - a.y, margin.y * b.w + reach - b.y, part);
#if FEATURE_CLIP_PLANES
    for (int plane = 0; plane < clip_plane_count; ++plane) {
        narrow(clip_height_of(plane, start), clip_height_of(plane, stop), part);
    }
#endif
    if (part.x > part.y) return false;
    first += part.x * (b - a);
    last -= (1.0 - part.y) * (b - a);
    return true;
}
#else
vec2 cut(float a, float b, vec2 part) { return vec2(a, b); }
bool cut_strip(vec3 start, vec3 stop, vec4 a, vec4 b, vec2 cue, inout vec2 part, inout vec4 first, inout vec4 last) { return true; }
#endif
