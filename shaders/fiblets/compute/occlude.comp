// Takes hidden fiblets out of the plan (culling/occlusion.glsl). Only fiblets not drawn yet are tested against this picture's own
// depth, as a whole, and refine.comp goes on. The coverage buffer is there before the picture, and all are tested.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "culling/occlusion.glsl"
#include "fiblets/compute/by_word.glsl"

uint asked(uint word) {
#if FEATURE_CULL_COVERAGE
    return planned(word);
#else
    return marks(ROUND_LOW, word) & marks(ROUND_HIGH, word);
#endif
}

// Whether it is hidden.
uint answers(uint f) {
#if FEATURE_CULL_COVERAGE
    return hidden(capsule_of(f)) ? 1u : 0u;
#else
    return hidden_as_a_whole(capsule_of(f)) ? 1u : 0u;
#endif
}

void main() {
    if (!find_answers()) return;
    set_marks(ROUND_LOW, word, marks(ROUND_LOW, word) & ~answered[0]);
    set_marks(ROUND_HIGH, word, marks(ROUND_HIGH, word) & ~answered[0]);
}
