// Counts fiblets for reports: the fiblets in the view volume (culling/criteria.glsl), as the cull pass finds them, and the fiblets
// of the last picture, where the visibility bits hold them.
//
// One invocation per 32 fiblets. A set has fewer than 2^32 fiblets: 32 bits count them all.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "culling/criteria.glsl"
#include "frame/groups.glsl"
#include "fiblets/compute/visibility_bits.glsl"

layout(std430, binding = {{ storage_fiblet_counts }}) buffer Counts { uint in_view; uint drawn; };

uniform int marked;  // whether there are marks

void main() {
    uint word = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    uint first = word * 32u;
    if (first >= chunk_fiblets) return;
    uint inside = 0u, these = 0u, count = min(32u, chunk_fiblets - first);
    for (uint i = 0u; i < count; ++i) inside += outside_view(first + i, capsule_of(first + i)) ? 0u : 1u;
    if (marked != 0) these = uint(bitCount(planned(word)));
    atomicAdd(in_view, inside);
    atomicAdd(drawn, these);
}
