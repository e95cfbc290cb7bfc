// Place of a fragment along its segment, and the line's value there: a float's bits, or a colour.

#include "fiblets/segments/thin_line_rule.glsl"
#include "fiblets/segments/clipped_segment.glsl"
#include "fiblets/segments/edges.glsl"
#include "fiblets/segments/joint.glsl"
#include "fiblets/attributes/tangent.glsl"
#include "page/missing.glsl"
#include "page/region.glsl"
#define VARYING flat in
#include "page/segment_varyings.glsl"

const bool SPRITES = false;

#if FEATURE_VALUES_STORED
uniform vec2 shown_values;     // least and greatest that is drawn; the first above the second: all

float value_between(float t) {
    vec2 ends = seg_along.zw;
    if (is_missing(ends.x) || is_missing(ends.y)) return t < 0.5 ? ends.x : ends.y;
    return mix(ends.x, ends.y, t);
}
#endif

// s: position along the piece in the window; t: along the segment.
float along_segment(float s) {
#if FEATURE_CLIP_REGION
    if (!region_keeps(clamp(mix(seg_start.z, seg_end.z, s), 0.0, 0.99999988))) discard;
#endif
    float ratio = seg_start.w / max(seg_end.w, 1e-30);
    return mix(seg_along.x, seg_along.y, clamp(s * ratio / max(1.0 - s + s * ratio, 1e-30), 0.0, 1.0));
}

uint bits_at(float t) {
    uint bits = 0u;
#if FEATURE_VALUES_STORED
    float value = value_between(t);
    if (shown_values.x <= shown_values.y && !(value >= shown_values.x && value <= shown_values.y)) discard;
    bits = floatBitsToUint(value);
#endif
#if FEATURE_VALUES_COLOUR
    bits = packUnorm4x8(mix(unpackUnorm4x8(seg_colours.x), unpackUnorm4x8(seg_colours.y), t));
#endif
    return bits;
}
