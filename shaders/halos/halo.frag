// Line or halo, and how deep it lies.
// Paper: Everts et al. 2009, sections 3.3 (equations 2 and 3), 3.4 (tapering, smooth edges) and 3.6 (filtering).
//
// Symbols
//   foot         the nearest place of the axis in the window; of a point, the point
//   s, t         where on the axis that is: linear in the window, and on the segment itself
//   r            distance from the foot over half the strip's width: 2 |v - 0.5| in the paper
//   m            half width that the mask leaves, 0..1: sqrt(x (2 - x)), an ellipse, x = min(u, 1 - u) / 0.2 at most 1
//   f            displacement function
//
// Algorithm
// Line where r <= share m, halo where r <= m, nothing beyond. A halo lies d_max f(r) farther from the viewer than its line. Where
// a filter's threshold cuts a line its distance along the line, estimated by how fast the number changes, is the mask's x.
// The depth buffer keeps the nearest: 1 - depth, so that float32 is fine far away.
//
// Out: item | place along the segment, 16 bits; ink, 8 bits; halo or line, 1 bit.

#version 430

#include "frame/blocks.glsl"
#include "halos/block.glsl"
#include "halos/widths.glsl"
#define VARYING flat in
#include "halos/varyings.glsl"

layout(location = 0) out uvec2 shown;
#if FEATURE_EDGES
#include "frame/edges.glsl"
layout(location = 1) out uint edges;
#endif
#if FEATURE_CLIP_REGION
#include "regions/boundaries.glsl"
#endif

float displacement(float x) {
#if FEATURE_HALO_BENT
    if (halo_displacement_kind == 1) return x * x;
    if (halo_displacement_kind == 2) return sqrt(x);
    float at = x * float(halo_table_entries - 1);
    int before = min(int(at), halo_table_entries - 2), after = before + 1;
    return mix(halo_table[before >> 2][before & 3], halo_table[after >> 2][after & 3], at - float(before));
#else
    return x;
#endif
}

void main() {
    uint beyond = 0u;       // which end of the segment the pixel is beyond
    vec2 from_start = gl_FragCoord.xy - half_picture - varying_ends.xy;
    float over_w = varying_depths.x, far = varying_depths.z, t = 0.0;
#if !FEATURE_HALO_POINTS
    vec2 axis = varying_ends.zw - varying_ends.xy;
    float place = dot(from_start, axis) / max(dot(axis, axis), 1e-30), s = clamp(place, 0.0, 1.0);
    beyond = place < 0.0 ? FREE_START : place > 1.0 ? FREE_END : 0u;
    if ((varying_item & beyond) != 0u) discard;      // corners may be there where bends are sharp for their width
    from_start -= s * axis;
    over_w = (1.0 - s) * over_w + s * varying_depths.y;
    far += s * (varying_depths.w - far);
    t = s * varying_depths.y / over_w;
#endif
#if FEATURE_CLIP_REGION
    if (!region_keeps(ivec2(gl_FragCoord.xy), 1.0 - far)) discard;       // of a halo its line counts
#endif
    float w = 1.0 / over_w, x = 1.0, rise = 0.0, cue = 0.0;      // rise: of x, along the segment
#if FEATURE_HALO_CUE
    cue = varying_cue.x + t * (varying_cue.y - varying_cue.x);
#endif
    vec2 reach = reaches(cue, w);
    float r = length(from_start) * w / reach.y, share = reach.x / reach.y;
#if FEATURE_HALO_TAPER
    float u = varying_mask.x + t * (varying_mask.y - varying_mask.x);
    x = 5.0 * min(u, 1.0 - u);
    rise = (u < 0.5 ? 5.0 : -5.0) * (varying_mask.y - varying_mask.x);
#endif
#if FEATURE_HALO_FILTER
    vec2 change = varying_filter.yw - varying_filter.xz;      // of number.x, and of how much that changes per mm
    vec2 number = t < 0.5 ? varying_filter.xz + t * change : varying_filter.yw - (1.0 - t) * change;      // exact at both ends
    float above = number.x - halo_filter_low, below = halo_filter_high - number.x;
    if (!(number.x >= halo_filter_low && number.x <= halo_filter_high)) discard;       // NaN as well
    float fall = number.y * halo_filter_taper;
    if (fall > 0.0 && min(above, below) < x * fall) {
        x = min(above, below) / fall;
        rise = (above < below ? change.x : -change.x) / fall;
    }
#endif
    x = clamp(x, 0.0, 1.0);
    float m = sqrt(x * (2.0 - x));
    if (!(r <= m)) discard;
    float edge = share * m;
    bool line = r <= edge;
#if FEATURE_EDGES
    // A line lies between its edges, a halo between the line's and its own. Both may be drawn wider than they are, and run
    // aslant where the mask narrows them.
    float away = length(from_start), narrower = (reach.x - own_reach(cue, w)) * over_w * m;
    vec2 outer = reach * over_w * m - narrower, outwards = away > 1e-4 ? from_start / away : vec2(1.0, 0.0);
    bool inwards = !line && away - outer.x < outer.y - away;
    float half_width = line || inwards ? outer.x : outer.y;
    vec2 n = outwards;
    uint end = 0u;
#if !FEATURE_HALO_POINTS
    float steep = (1.0 - x) / max(m * m, 1e-6) * rise * (varying_depths.x / over_w) * (varying_depths.y / over_w);
    steep /= max(dot(axis, axis), 1e-30);
    n -= half_width * steep * axis;
    // Ends that nothing goes on beyond: half a pixel away at most, in thirds of a pixel (frame/edges.glsl).
    float pixels = length(axis), from_end = (1.0 - place) * pixels;
    bool begins = (varying_item & FREE_START) != 0u && place * pixels < 0.5, ends = (varying_item & FREE_END) != 0u && from_end < 0.5;
    bool turned = (n.x * axis.y < n.y * axis.x) != inwards;      // whether n, turned to the left, points to the start
    uint third = uint((begins ? place * pixels : from_end) * 3.0 + 0.5);
    if (begins || ends) end = begins && ends ? 7u : begins == turned ? 2u + third : 5u - third;
#endif
    if (inwards) n = -n;
    float slant = inversesqrt(dot(n, n)), within = (inwards ? away - half_width : half_width - away) * slant;
    edges = packed_edges(n, within, (line ? 2.0 * outer.x : outer.y - outer.x) * slant, end);
#endif
    float d = line ? 0.0 : halo_displacement * displacement(r);
    float back = d * (halo_depth_per_mm + halo_depth_swing / (w * (w + halo_w_per_mm * d)));
    // A halo beyond the far plane is there. Of what is equally deep lines lie before halos, and segments before the ends of
    // others that go on round; by the least steps of a float32, so that it does not matter which is drawn first.
    uint steps = (beyond >> 29u) + (line ? 0u : 8u);
    gl_FragDepth = uintBitsToFloat(floatBitsToUint(max(far - back, 1e-9)) - steps);
    float ink = halo_smooth != 0 ? clamp(0.5 - (r - edge) * reach.y * over_w, 0.0, 1.0) : float(line);
#if FEATURE_HALO_CUT
    t = varying_part.x + t * (varying_part.y - varying_part.x);
#endif
    shown = uvec2(varying_item & ~(FREE_START | FREE_END), uint(t * 65535.0 + 0.5) << 16u | uint(ink * 255.0 + 0.5) << 8u | (line ? 1u : 0u));
}
