// Lists the clusters of a chunk that may show (fiblets/compute/cluster_box.glsl), by the last picture's pyramid or this one's.
//
// One invocation per cluster.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "fiblets/compute/cluster_box.glsl"
#include "frame/groups.glsl"
#include "fiblets/compute/visibility_bits.glsl"
#include "fiblets/compute/claims.glsl"

shared uint count;
shared uint start;

void main() {
    uint cluster = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (gl_LocalInvocationIndex == 0u) count = 0u;
    barrier();
    bool left = cluster_left(cluster);
    uint place = left ? atomicAdd(count, 1u) : 0u;
    barrier();
    if (gl_LocalInvocationIndex == 0u && count > 0u) start = claim(0u, count, GROUP_CLUSTERS);
    barrier();
    if (left) visibility_bits[list_at(0u) + start + place] = cluster;
}
