// Turns the owners of all pixels into one bit per fiblet: those that are seen. The last pass draws no others, and the
// next picture begins with them.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "frame/blocks.glsl"

layout(std430, binding = 12) coherent buffer Seen { uint seen[]; };
layout(r32ui, binding = 1) readonly uniform uimage2D owner_image;

// An invocation looks through neighbouring pixels, which often have the same owner, and stops only at changes.
void main() {
    uint row = group_index(), width = uint(viewport.x), span = (width + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    if (row >= uint(viewport.y)) return;
    uint x = gl_LocalInvocationIndex * span, end = min(x + span, width), last = 0xFFFFFFFFu;
    for (;;) {
        uint owner = 0xFFFFFFFFu;
        for (; x < end; ++x) {
            owner = imageLoad(owner_image, ivec2(x, row)).x;
            if (owner != 0xFFFFFFFFu && owner != last) break;
        }
        if (x >= end) break;
        last = owner;
        uint bit = 1u << (owner & 31u);
        if ((seen[owner >> 5] & bit) == 0u) atomicOr(seen[owner >> 5], bit);
    }
}
