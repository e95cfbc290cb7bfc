// Empties the owner of every pixel, and the G-buffer's depth unless lines are added to those in it. With atomics of 64 bits depth and
// owners come later (fiblets/compute/split.comp), and their words begin as these would.

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

layout(r32ui, binding = {{ image_depth }}) uniform uimage2D depth_image;
layout(r32ui, binding = {{ image_owner }}) writeonly uniform uimage2D owner_image;

uniform int adds;

void main() {
    uint row = group_index();
    if (row >= uint(viewport.y)) return;
    for (uint x = gl_LocalInvocationIndex; x < uint(viewport.x); x += gl_WorkGroupSize.x) {
#if FEATURE_INT64_ATOMICS
        uint depth = adds != 0 ? imageLoad(depth_image, ivec2(x, row)).x : 0xFFFFFFFFu;
        nearest[pixel_index(ivec2(x, row))] = nearest_word(depth, 0xFFFFFFFFu);
#else
        if (adds == 0) imageStore(depth_image, ivec2(x, row), uvec4(0xFFFFFFFFu));
        imageStore(owner_image, ivec2(x, row), uvec4(0xFFFFFFFFu));
#endif
    }
}
