// Plans a picture: frustum culling (culling/criteria.glsl), and the programs that draw the remaining fiblets.
//
// Invariants
//   - A culled fiblet has no visible pixel.
//   - A fiblet of class 0 lies inside all planes, by `plane_rounding` and its radius: its segments need no clipping. One of
//     class 1 lies so between the near and the far plane, hence in front of the camera. Class 2 are all others, fiblets
//     that the caller's planes or region may touch, and fiblets with hidden points. Class 3 are fiblets of class 0 drawn as one segment.
//   - Where there is ONE_CLASS, it has all fiblets, and its program has the features that any of them needs.
//
// With FEATURE_CLUSTERS only fiblets visible in the last picture are tested; choose.glsl finds the others through their clusters.
//
// One invocation per 32 fiblets. It writes the plan of the drawing passes: fiblets visible in the last
// picture (drawn first, so that most others lose at their first look at the depth image), others that will probably show
// (two-phase culling only: culling/visibility_prediction.glsl), and the class of each.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "fiblets/compute/classes.glsl"
#if FEATURE_CULL_PYRAMID
#include "culling/visibility_prediction.glsl"
#endif
#include "frame/groups.glsl"
#include "fiblets/compute/visibility_bits.glsl"

uniform uint seed_words;  // of so many groups of 32, one has its seed drawn as if it had been seen; 0: none
uniform uint slots;       // of arguments

// Empties the lists of the chunk's last picture.
void empty_lists() {
    uint lengths = list_at(CLASSES), arguments = all_arguments_at();
    for (uint i = gl_LocalInvocationIndex; i < ROUNDS * CLASSES; i += gl_WorkGroupSize.x) visibility_bits[lengths + i] = 0u;
    for (uint i = gl_LocalInvocationIndex; i < 4u * ROUNDS * CLASSES * slots; i += gl_WorkGroupSize.x) {
        visibility_bits[arguments + i] = (i & 3u) == 1u || (i & 3u) == 2u ? 1u : 0u;
    }
}

void main() {
    if (group_index() == 0u) empty_lists();
    uint word = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    uint first = word * 32u;
    if (first >= chunk_fiblets) return;
    uint shown = 0u, low = 0u, high = 0u, likely = 0u, before = marks(SEEN, word);
    if (seed_words != 0u && ((chunk_first >> 5) + word) % seed_words == 0u) before |= 0x01010101u;
#if FEATURE_CLUSTERS
    uint tested = before;
#else
    uint tested = 0xFFFFFFFFu;
#endif
    if (chunk_fiblets - first < 32u) tested &= (1u << (chunk_fiblets - first)) - 1u;
    for (; tested != 0u; tested &= tested - 1u) {
        uint i = uint(findLSB(tested)), which;
        Capsule c = capsule_of(first + i);
        if (can_show(first + i, c, which)) shown |= 1u << i;
        low |= (which & 1u) << i;
        high |= (which >> 1) << i;
#if FEATURE_CULL_PYRAMID
        if (predicted_visible(c)) likely |= 1u << i;
#endif
    }
    set_marks(ROUND_LOW, word, shown & (before | ~likely));
    set_marks(ROUND_HIGH, word, shown & ~before);
    set_marks(CLASS_LOW, word, low & shown);
    set_marks(CLASS_HIGH, word, high & shown);
    set_marks(CANDIDATES, word, 0u);
    set_marks(SEEN, word, 0u);
    set_marks(TIED, word, 0u);
}
