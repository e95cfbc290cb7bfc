// Lists the fiblets that a round of drawing has to draw, class by class, and writes the arguments of the dispatches that do.
//
// One invocation per 32 fiblets. A work group claims its places in each list with one atomic. Lists come out in any order:
// no pass depends on it.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "frame/groups.glsl"
#include "fiblets/compute/visibility_bits.glsl"
#include "fiblets/compute/claims.glsl"

uniform uint refined;      // 1: the rest are the survivors of refine.comp
shared uint counts[CLASSES];
shared uint starts[CLASSES];

void main() {
    uint word = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex, round = 0u, low = 0u, high = 0u;
    if (word < chunk_words()) {
        if (refined != 0u) {
            uint gone = in_round(word) & ~marks(KEPT, word);
            set_marks(ROUND_LOW, word, marks(ROUND_LOW, word) & ~gone);
            set_marks(ROUND_HIGH, word, marks(ROUND_HIGH, word) & ~gone);
            set_marks(KEPT, word, 0u);
        }
        round = in_round(word);
        low = marks(CLASS_LOW, word);
        high = marks(CLASS_HIGH, word);
    }
    uint bits[CLASSES] = uint[](round & ~low & ~high, round & low & ~high, round & ~low & high, round & low & high);
    if (gl_LocalInvocationIndex < CLASSES) counts[gl_LocalInvocationIndex] = 0u;
    barrier();
    uint places[CLASSES];
    for (uint which = 0u; which < CLASSES; ++which) places[which] = bits[which] == 0u ? 0u : atomicAdd(counts[which], uint(bitCount(bits[which])));
    barrier();
    if (gl_LocalInvocationIndex < CLASSES && counts[gl_LocalInvocationIndex] > 0u) {
        uint which = gl_LocalInvocationIndex;
        starts[which] = claim(which, counts[which], {{ group_size }}u);
    }
    barrier();
    for (uint which = 0u; which < CLASSES; ++which) {
        uint entry = starts[which] + places[which];
        for (uint rest = bits[which]; rest != 0u && entry < list_room(); rest &= rest - 1u, ++entry) {
            visibility_bits[list_at(which) + entry] = word * 32u + uint(findLSB(rest));
        }
    }
}
