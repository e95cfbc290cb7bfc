// Lists the groups of 32 fiblets that a round of drawing has something to do for, class by class, and counts them.
//
// One invocation per 32 fiblets. A work group claims its places in each list with one atomic. Lists come out in any order:
// no pass depends on it.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "uniforms/Chunk.glsl"
#include "frame/groups.glsl"
#include "fiblets/compute/visibility_bits.glsl"

uniform uint refined;   // 1: the rest are those that refine.comp kept

shared uint counts[CLASSES];
shared uint starts[CLASSES];

uint bits_of(uint word, uint which) {
    if (drawing <= DRAW_REST) return visibility_word(word, which + CLASSES * drawing);
    if (drawing == TEST_REST) return visibility_word(word, REST + which);
    return taken_again(word, which);
}

void main() {
    uint word = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex, before = chunk_first >> 5u;
    bool here = word * 32u < chunk_fiblets;
    if (here && refined != 0u) {
        uint at = (before + word) * WORDS, kept = visibility_bits[at + KEPT];
        for (uint which = 0u; which < CLASSES; ++which) visibility_bits[at + REST + which] &= kept;
        visibility_bits[at + KEPT] = 0u;
    }
    if (gl_LocalInvocationIndex < CLASSES) counts[gl_LocalInvocationIndex] = 0u;
    barrier();
    uint slots[CLASSES];
    for (uint which = 0u; which < CLASSES; ++which) {
        bool any = here && bits_of(before + word, which) != 0u;
        slots[which] = any ? atomicAdd(counts[which], 1u) : 0xFFFFFFFFu;
    }
    barrier();
    if (gl_LocalInvocationIndex < CLASSES && counts[gl_LocalInvocationIndex] > 0u) {
        uint which = gl_LocalInvocationIndex;
        starts[which] = atomicAdd(visibility_bits[argument_of(chunk_number, which) + 3u], counts[which]);
    }
    barrier();
    for (uint which = 0u; which < CLASSES; ++which) {
        if (slots[which] != 0xFFFFFFFFu) visibility_bits[list_entry(which, before, starts[which] + slots[which])] = word;
    }
}
