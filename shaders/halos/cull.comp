// Two-phase culling of lines and points with halos: lists the items to draw, each of some neighbouring quads
// (pvfiblets/engine/culling/two_phase_items.py). The first round lists those that the last picture showed; the second, of the others,
// those that the depth of the first does not hide.
//
// Nothing of a strip is nearer than its axis, and that is nearest at a vertex: an item whose vertices are all behind everything in
// the rectangle that its strips touch is hidden.
//
// One invocation per item.

#version 430
layout(local_size_x = 64) in;

#include "halos/vertices.glsl"
#include "culling/pyramid_lookup.glsl"
#include "frame/groups.glsl"

layout(std430, binding = {{ items_seen }}) readonly buffer SeenBits { uint seen[]; };
layout(std430, binding = {{ items_listed }}) writeonly buffer Listed { uint listed[]; };
layout(std430, binding = {{ items_counts }}) buffer Counts { uint counts[]; };      // how many are listed

uniform int second_round;
uniform int items;

const int QUADS = 1 << {{ item_shift }};
const float CORNER = 1.5;      // half widths from the axis to a strip's farthest corner: sqrt(2) where it ends in a disc
const float SLACK = 1e-6;      // of depth, for rounding

// What some vertices that follow each other on a line cover.
struct Cover {
    vec2 low;          // pixels from the picture's middle
    vec2 high;
    float nearest;     // the largest 1 - depth; -1 where there are none in front of the eye
    bool beside;       // whether some lie beside the eye or behind it
};

// May be seen: is not beside the picture, and not behind all that is drawn there.
bool may_show(Cover cover) {
    if (cover.nearest < 0.0) return false;
    if (cover.beside) return true;
    vec2 low = cover.low + half_picture, high = cover.high + half_picture;
    if (any(lessThan(high, vec2(0.0))) || any(greaterThan(low, viewport))) return false;
    if (second_round == 0) return true;
    ivec2 from = ivec2(clamp(low - 0.6, vec2(0.0), viewport - 1.0)), to = ivec2(clamp(high + 0.6, vec2(0.0), viewport - 1.0));
    return 1.0 - cover.nearest <= farthest_in(from, to) + SLACK;
}

// An item holds the end of one line and the beginning of the next, or more of short ones: up to the first end, and from there on.
bool may_show(int first) {
    Cover covers[2];
    covers[0] = covers[1] = Cover(vec2(3e38), vec2(-3e38), -1.0, false);
#if FEATURE_HALO_POINTS
    int count = min(first + QUADS, halo_items);
    const int part = 0;
    for (int k = first; k < count; ++k) {
#else
    int count = min(first + QUADS, halo_items) + 1, part = 0, next = 0;
    bool before = false;                           // whether a segment of this item ends at vertex k
    for (int k = first; k < count; ++k) {
        bool after = k + 1 < count && !is_last(k), used = before || after;
        part = next;
        if (!after) next = 1;
        before = after;
        if (!used) continue;
#endif
        vec3 here = local_place(k);
        vec4 at = window_of(here);
        if (at.w <= 1e-30) {
            covers[part].beside = true;
            continue;
        }
        vec2 middle = at.xy / at.w;
        float reach = CORNER * reaches(cue_at(here), at.w).y / at.w;
        covers[part].low = min(covers[part].low, middle - reach);
        covers[part].high = max(covers[part].high, middle + reach);
        covers[part].nearest = max(covers[part].nearest, at.z / at.w);
    }
    return may_show(covers[0]) || may_show(covers[1]);
}

void main() {
    uint item = group_index() * 64u + gl_LocalInvocationIndex;
    if (item >= uint(items)) return;
    bool early = (seen[item >> 5u] >> (item & 31u) & 1u) != 0u;
    if (early == (second_round != 0)) return;
    if (may_show(int(item) * QUADS)) listed[atomicAdd(counts[0], 1u)] = item;
}
