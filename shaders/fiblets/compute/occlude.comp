// Takes hidden fiblets out of the plan (culling/occlusion.glsl). Only fiblets not drawn yet are tested against this picture's own
// depth, as a whole, and refine.comp goes on. The coverage buffer is there before the picture, and all are tested.
//
// One invocation per 32 fiblets.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "culling/occlusion.glsl"
#include "frame/groups.glsl"
#include "fiblets/compute/visibility_bits.glsl"

bool out_of_sight(Capsule c) {
#if FEATURE_CULL_COVERAGE
    return hidden(c);
#else
    return hidden_as_a_whole(c);
#endif
}

void main() {
    uint word = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    uint first = word * 32u, gone = 0u;
    if (first >= chunk_fiblets) return;
    uint low = marks(ROUND_LOW, word), high = marks(ROUND_HIGH, word);
#if FEATURE_CULL_COVERAGE
    uint tested = low | high;
#else
    uint tested = low & high;
#endif
    for (uint rest = tested; rest != 0u; rest &= rest - 1u) {
        uint i = uint(findLSB(rest));
        if (out_of_sight(capsule_of(first + i))) gone |= 1u << i;
    }
    set_marks(ROUND_LOW, word, low & ~gone);
    set_marks(ROUND_HIGH, word, high & ~gone);
}
