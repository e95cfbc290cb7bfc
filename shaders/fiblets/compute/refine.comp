// Takes hidden fiblets out of the plan, second test: the capsules of the remaining ones in pieces (culling/hidden.glsl).

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "culling/hidden.glsl"
#include "fiblets/compute/visibility_bits.glsl"
#include "fiblets/compute/bits.glsl"

void main() {
    for (uint k = gl_LocalInvocationIndex;; k += gl_WorkGroupSize.x) {
        uint f = nth_fiblet(k);
        if (f == NO_FIBLET) break;
        if (!hidden_in_pieces(capsule_of(f))) mark(KEPT, f);
    }
}
