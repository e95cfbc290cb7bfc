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
// It writes the plan of the drawing passes, by words of 32 fiblets (fiblets/compute/by_word.glsl): fiblets visible in the last
// picture (drawn first, so that most others lose at their first look at the depth image), others that will probably show
// (two-phase culling only: culling/visibility_prediction.glsl), and the class of each.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "fiblets/compute/classes.glsl"
#if FEATURE_CULL_PYRAMID
#include "culling/visibility_prediction.glsl"
#endif
#include "fiblets/compute/by_word.glsl"

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

uint seen_before(uint word) {
    bool seeded = seed_words != 0u && ((chunk_first >> 5) + word) % seed_words == 0u;
    return marks(SEEN, word) | (seeded ? 0x01010101u : 0u);
}

uint asked(uint word) {
    uint here = chunk_fiblets - 32u * word, all = here < 32u ? (1u << here) - 1u : 0xFFFFFFFFu;
#if FEATURE_CLUSTERS
    return all & seen_before(word);
#else
    return all;
#endif
}

// Whether it shows, the bits of its class, and whether it will probably show.
uint answers(uint f) {
    uint which;
    Capsule c = capsule_of(f);
    uint found = can_show(f, c, which) ? 1u : 0u;
#if FEATURE_CULL_PYRAMID
    if (predicted_visible(c)) found |= 8u;
#endif
    return found | which << 1;
}

void main() {
    if (group_index() == 0u) empty_lists();
    if (!find_answers()) return;
    uint before = seen_before(word), shown = answered[0];
    set_marks(ROUND_LOW, word, shown & (before | ~answered[3]));
    set_marks(ROUND_HIGH, word, shown & ~before);
    set_marks(CLASS_LOW, word, shown & answered[1]);
    set_marks(CLASS_HIGH, word, shown & answered[2]);
    set_marks(CANDIDATES, word, 0u);
    set_marks(SEEN, word, 0u);
    set_marks(TIED, word, 0u);
}
