// Where the driver has atomics of 64 bits (fiblets/compute/nearest.glsl): from words to the G-buffer's depth and owners. When all is
// drawn, owners are marked: resolve_ties.comp writes their pixels, and the next picture begins with them.
//
// A work group per row of pixels. A run of pixels with the same owner marks it once.

#version 450
#extension GL_ARB_gpu_shader_int64 : require
#extension GL_NV_shader_atomic_int64 : require
layout(local_size_x = {{ group_size }}) in;

#include "frame/blocks.glsl"
#include "frame/groups.glsl"
#include "fiblets/compute/visibility_bits.glsl"
#include "fiblets/compute/nearest.glsl"

layout(r32ui, binding = {{ image_depth }}) writeonly uniform uimage2D depth_image;
layout(r32ui, binding = {{ image_owner }}) writeonly uniform uimage2D owner_image;

uniform uint marking;  // 1: owners in the chunk are marked, and nothing else is done

void main() {
    uint row = group_index();
    if (row >= uint(viewport.y)) return;
    for (uint x = gl_LocalInvocationIndex; x < uint(viewport.x); x += gl_WorkGroupSize.x) {
        uint at = pixel_index(ivec2(x, row));
        uint key = key_of(nearest[at]), fiblet = fiblet_of(nearest[at]);
        if (marking == 0u) {
            imageStore(depth_image, ivec2(x, row), uvec4(key));
            imageStore(owner_image, ivec2(x, row), uvec4(fiblet));
            continue;
        }
        if (key == 0xFFFFFFFFu) continue;
        if (x > 0u && fiblet_of(nearest[at - 1u]) == fiblet) continue;
        uint f = fiblet - chunk_first;
        if (f >= chunk_fiblets || (marks(SEEN, f >> 5) & 1u << (f & 31u)) != 0u) continue;
        mark(SEEN, f);
        mark(CANDIDATES, f);
    }
}
