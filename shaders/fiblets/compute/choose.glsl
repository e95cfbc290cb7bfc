// Puts fiblets of listed clusters into a round of drawing, if they can show, are in no round yet, and the including pass wants them:
//   bool wanted(Capsule c)
//
// A group serves {{ group_clusters }} clusters, an invocation a fiblet at a time: a cluster's lie near each other, and decide alike.

#include "fiblets/compute/classes.glsl"
#include "frame/groups.glsl"
#include "fiblets/compute/visibility_bits.glsl"
#include "fiblets/compute/clusters.glsl"

bool wanted(Capsule c);

void choose(uint round) {
    uint first = group_index() * GROUP_CLUSTERS, end = min(first + GROUP_CLUSTERS, visibility_bits[length_at(0u)]) * CLUSTER;
    for (uint i = first * CLUSTER + gl_LocalInvocationIndex; i < end; i += gl_WorkGroupSize.x) {
        uint k = visibility_bits[list_at(0u) + i / CLUSTER] * CLUSTER + i % CLUSTER;
        if (k >= chunk_fiblets) continue;
        uint f = clustered(k), which;
        if ((planned(f >> 5) >> (f & 31u) & 1u) != 0u) continue;
        Capsule c = capsule_of(f);
        if (!can_show(f, c, which) || !wanted(c)) continue;
        if ((round & 1u) != 0u) mark(ROUND_LOW, f);
        if ((round & 2u) != 0u) mark(ROUND_HIGH, f);
        if ((which & 1u) != 0u) mark(CLASS_LOW, f);
        if ((which & 2u) != 0u) mark(CLASS_HIGH, f);
    }
}
