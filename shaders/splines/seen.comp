// Two-phase culling: notes which segments own a pixel of the last picture, a bit each.
//
// One invocation per pixel.

#version 430
layout(local_size_x = 8, local_size_y = 8) in;

uniform usampler2D owner;        // 0xFFFFFFFF where nothing shows
uniform int count;               // segments

layout(std430, binding = 0) buffer SeenBits { uint seen[]; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, textureSize(owner, 0)))) return;
    uint segment = texelFetch(owner, pixel, 0).x;
    if (segment >= uint(count)) return;
    uint bit = 1u << (segment & 31u);
    if ((seen[segment >> 5u] & bit) == 0u) atomicOr(seen[segment >> 5u], bit);
}
