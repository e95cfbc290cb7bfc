// The task stage's work (paper: Schertzer et al. 2022, section 3.4.1, figure 2): one invocation per fiblet decides whether it
// is drawn. Where the driver has subgroup operations a ballot collects the answers, elsewhere shared memory does.
//
// Use: all invocations call cull(n); it returns how many survived, and the first has them in `survivors`. A task work group
// has {{ task_fiblets }} fiblets, because most are culled: a group that yields nothing should not cost its launch for 32 only.

#include "fiblets/hardware_raster/cull.glsl"
#include "fiblets/mesh/survivors.glsl"

uniform uint first_group;  // drawing calls are limited in length (pvfiblets/engine/fiblets/pipelines/mesh.py)

#if !FEATURE_SUBGROUPS
shared uint ballots[ROUNDS];
#endif

uint cull(out Survivors survivors) {
    uint thread = gl_LocalInvocationIndex, count = 0u;
    survivors.first = (first_group + gl_WorkGroupID.x) * THREADS * ROUNDS;
#if !FEATURE_SUBGROUPS
    if (thread < ROUNDS) ballots[thread] = 0u;
    barrier();
#endif
    for (uint i = 0u; i < ROUNDS; ++i) {
        uint f = survivors.first + THREADS * i + thread;
        bool here = f < chunk_fiblets && survives(f);
#if FEATURE_SUBGROUPS
        survivors.bits[i] = subgroupBallot(here).x;
        count += uint(bitCount(survivors.bits[i]));
#else
        if (here) atomicOr(ballots[i], 1u << thread);
#endif
    }
#if !FEATURE_SUBGROUPS
    barrier();
    for (uint i = 0u; i < ROUNDS; ++i) {
        survivors.bits[i] = ballots[i];
        count += uint(bitCount(ballots[i]));
    }
#endif
    return count;
}
