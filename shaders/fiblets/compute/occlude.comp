// Takes out of the plan what is hidden (culling/occlusion.glsl). Behind this picture's own depth only those are tested that
// are not drawn yet, as a whole, and refine.comp goes on. The coverage buffer is there before the picture, and all are tested.
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

void test_plan(uint word, uint first) {
    uint tested = 0u, kept = 0u;
    for (uint which = 0u; which < CLASSES; ++which) tested |= visibility_bits[word + which];
    for (uint rest = tested; rest != 0u; rest &= rest - 1u) {
        uint i = uint(findLSB(rest));
        if (!out_of_sight(capsule_of(first + i))) kept |= 1u << i;
    }
    for (uint which = 0u; which < CLASSES; ++which) visibility_bits[word + which] &= kept;
}

void main() {
    uint word = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    uint first = word * 32u;
    if (first >= chunk_fiblets) return;
    word = ((chunk_first >> 5u) + word) * WORDS;
#if FEATURE_CULL_COVERAGE
    test_plan(word, first);
#endif
    test_plan(word + REST, first);
}
