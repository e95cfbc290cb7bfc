// Empties the G-buffer's depth and the owner of every pixel.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "frame/blocks.glsl"

layout(r32ui, binding = 0) writeonly uniform uimage2D depth_image;
layout(r32ui, binding = 1) writeonly uniform uimage2D owner_image;

void main() {
    uint row = group_index();
    if (row >= uint(viewport.y)) return;
    for (uint x = gl_LocalInvocationIndex; x < uint(viewport.x); x += gl_WorkGroupSize.x) {
        imageStore(depth_image, ivec2(x, row), uvec4(0xFFFFFFFFu));
        imageStore(owner_image, ivec2(x, row), uvec4(0xFFFFFFFFu));
    }
}
