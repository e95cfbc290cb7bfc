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
    uint listed = visibility_bits[length_at(0u)], entry = group_index() * GROUP_CLUSTERS, end = min(entry + GROUP_CLUSTERS, listed);
    for (; entry < end; ++entry) {
        uint k = visibility_bits[list_at(0u) + entry] * CLUSTER + gl_LocalInvocationIndex;
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
