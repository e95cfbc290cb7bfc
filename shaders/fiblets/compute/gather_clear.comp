// Empties the sums of all pixels (fiblets/compute/gather.comp), and the lengths of all lists.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "frame/blocks.glsl"
#include "frame/groups.glsl"
#include "fiblets/compute/visibility_bits.glsl"

layout(r32ui, binding = {{ image_gathered }}) writeonly uniform uimage2DArray gathered;

uniform uint argument_count;  // words

void main() {
    uint row = group_index();
    if (row == 0u) {
        for (uint i = gl_LocalInvocationIndex; i < argument_count; i += gl_WorkGroupSize.x) visibility_bits[argument_base + i] = 0u;
    }
    ivec3 size = imageSize(gathered);
    if (row >= uint(size.y)) return;
    for (int layer = 0; layer < size.z; ++layer) {
        for (uint x = gl_LocalInvocationIndex; x < uint(size.x); x += gl_WorkGroupSize.x) imageStore(gathered, ivec3(x, row, layer), uvec4(0u));
    }
}
