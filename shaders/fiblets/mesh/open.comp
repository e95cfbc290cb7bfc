// Marks the fiblets of clusters that may show (fiblets/compute/cluster_box.glsl), for the task stage. The bits are empty before.
//
// A work group tests a cluster by each invocation, and then marks the fiblets of those that are left, cluster by cluster.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "fiblets/compute/cluster_box.glsl"
#include "frame/groups.glsl"
#include "fiblets/mesh/open_fiblets.glsl"

uniform uint marked_round;

shared uint count;
shared uint found[{{ group_size }}];

void main() {
    uint cluster = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (gl_LocalInvocationIndex == 0u) count = 0u;
    barrier();
    if (cluster_left(cluster)) found[atomicAdd(count, 1u)] = cluster;
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < CLUSTER * count; i += gl_WorkGroupSize.x) {
        uint k = found[i / CLUSTER] * CLUSTER + i % CLUSTER;
        if (k >= chunk_fiblets) continue;
        uint f = clustered(k);
        atomicOr(open_fiblets[open_word(marked_round, f)], 1u << (f & 31u));
    }
}
