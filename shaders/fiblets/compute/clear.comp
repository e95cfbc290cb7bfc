// Empties the G-buffer's depth and the owner of every pixel. With atomics of 64 bits depth and
// owners come later (fiblets/compute/split.comp), and their words are emptied.

#version 430
#if FEATURE_INT64_ATOMICS
#extension GL_ARB_gpu_shader_int64 : require
#extension GL_NV_shader_atomic_int64 : require
#endif
layout(local_size_x = {{ group_size }}) in;

#include "frame/blocks.glsl"
#include "frame/groups.glsl"
#if FEATURE_INT64_ATOMICS
#include "fiblets/compute/nearest.glsl"
#endif

layout(r32ui, binding = {{ image_depth }}) writeonly uniform uimage2D depth_image;
layout(r32ui, binding = {{ image_owner }}) writeonly uniform uimage2D owner_image;

void main() {
    uint row = group_index();
    if (row >= uint(viewport.y)) return;
    for (uint x = gl_LocalInvocationIndex; x < uint(viewport.x); x += gl_WorkGroupSize.x) {
#if FEATURE_INT64_ATOMICS
        nearest[pixel_index(ivec2(x, row))] = nearest_word(0xFFFFFFFFu, 0xFFFFFFFFu);
#else
        imageStore(depth_image, ivec2(x, row), uvec4(0xFFFFFFFFu));
        imageStore(owner_image, ivec2(x, row), uvec4(0xFFFFFFFFu));
#endif
    }
}
