// Two-phase culling of lines and points with halos: lists the items to draw, each of some neighbouring quads
// (pvfiblets/engine/culling/listing.py). The first round lists those that the last picture showed; the second, of the others,
// those that the depth of the first does not hide.
//
// Nothing of a strip is nearer than its axis, and that is nearest at a vertex: an item whose vertices are all behind everything in
// the rectangle that its strips touch is hidden.
//
// One invocation per item.

#version 430
layout(local_size_x = 64) in;

#include "halos/vertices.glsl"
#include "culling/squares.glsl"
#include "compute/groups.glsl"

layout(std430, binding = 0) readonly buffer SeenBits { uint seen[]; };
layout(std430, binding = 1) writeonly buffer Listed { uint listed[]; };
layout(std430, binding = 2) buffer Counts { uint counts[]; };      // how many are listed

uniform int second_round;
uniform int items;

const int QUADS = 1 << {{ item_shift }};
const float CORNER = 1.5;      // half widths from the axis to a strip's farthest corner: sqrt(2) where it ends in a disc
const float SLACK = 1e-6;      // of depth, for rounding

// Whether an item may be seen.
bool may_show(int first) {
    vec2 low = vec2(3e38), high = vec2(-3e38);
    float nearest = 0.0;                           // the largest 1 - depth
    bool any_seen = false, any_beside = false;
#if FEATURE_HALO_POINTS
    int count = min(first + QUADS, halo_counts.x);
    for (int k = first; k < count; ++k) {
#else
    int count = min(first + QUADS, halo_counts.x) + 1;
    bool before = false;                           // whether a segment of this item ends at vertex k
    for (int k = first; k < count; ++k) {
        bool after = k + 1 < count && !is_last(k), used = before || after;
        before = after;
        if (!used) continue;
#endif
        vec3 here = local_place(k);
        vec4 at = window_of(here);
        if (at.w <= 1e-30) {
            any_beside = true;
            continue;
        }
        any_seen = true;
        vec2 middle = at.xy / at.w;
        float reach = CORNER * reaches(cue_at(here), at.w).y / at.w;
        low = min(low, middle - reach);
        high = max(high, middle + reach);
        nearest = max(nearest, at.z / at.w);
    }
    if (!any_seen) return false;
    if (any_beside) return true;
    low += halo_mask.yz;
    high += halo_mask.yz;
    if (any(lessThan(high, vec2(0.0))) || any(greaterThan(low, viewport.xy))) return false;
    if (second_round == 0) return true;
    ivec2 from = ivec2(clamp(low - 0.6, vec2(0.0), viewport.xy - 1.0)), to = ivec2(clamp(high + 0.6, vec2(0.0), viewport.xy - 1.0));
    return 1.0 - nearest <= farthest_in(from, to) + SLACK;
}

void main() {
    uint item = group_index() * 64u + gl_LocalInvocationIndex;
    if (item >= uint(items)) return;
    bool early = (seen[item >> 5u] >> (item & 31u) & 1u) != 0u;
    if (early == (second_round != 0)) return;
    if (may_show(int(item) * QUADS)) listed[atomicAdd(counts[0], 1u)] = item;
}
