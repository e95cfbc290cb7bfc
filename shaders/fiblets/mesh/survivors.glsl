// What the task stage tells the mesh stage: which of its fiblets survived culling, a bit each. The k-th mesh work group of a
// task work group finds its own among them. Bits are a fiftieth of what a list of indices would take, and keep the order: of
// two fragments at the same depth that of the smaller index stays, because OpenGL draws the meshes of a task, and tasks, in
// their order.
//
// {{ task_rounds }} rounds of {{ mesh_threads }} invocations test {{ task_fiblets }} fiblets.

#include "fiblets/compute/nth_bit.glsl"

const uint THREADS = {{ mesh_threads }}u, ROUNDS = {{ task_rounds }}u;

struct Survivors {
    uint first;                      // fiblet
    uint bits[{{ task_rounds }}];
};

uint survivor(Survivors survivors, uint k) {
    for (uint i = 0u; i < ROUNDS; ++i) {
        uint here = uint(bitCount(survivors.bits[i]));
        if (k < here) return survivors.first + THREADS * i + nth_bit(survivors.bits[i], k);
        k -= here;
    }
    return 0xFFFFFFFFu;  // there is no such mesh work group
}
