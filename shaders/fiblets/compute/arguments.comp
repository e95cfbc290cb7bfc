// From the lengths of the lists to the arguments of indirect dispatches, folded into rows as group_index() expects.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "fiblets/compute/visibility_bits.glsl"

uniform uint list_count;  // of this round: chunks times classes
uniform uint max_groups;  // along one axis

void main() {
    for (uint i = gl_LocalInvocationIndex; i < list_count; i += gl_WorkGroupSize.x) {
        uint at = argument_base + 4u * i;
        uint groups = (visibility_bits[at + 3u] + {{ group_words }}u - 1u) / {{ group_words }}u;
        visibility_bits[at] = min(groups, max_groups);
        visibility_bits[at + 1u] = (groups + max_groups - 1u) / max_groups;
        visibility_bits[at + 2u] = 1u;
    }
}
