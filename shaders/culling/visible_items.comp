// Two-phase culling: notes which items (pvfiblets/engine/culling/two_phase_items.py) the last picture shows, a bit each.
//
// One invocation per pixel.

#version 430
layout(local_size_x = 8, local_size_y = 8) in;

uniform usampler2D shown;        // the number of a quad; 0xFFFFFFFF where nothing shows
uniform int count;               // items
uniform int shift;               // an item is 1 << shift quads

layout(std430, binding = {{ items_seen }}) buffer SeenBits { uint seen[]; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, textureSize(shown, 0)))) return;
    uint item = texelFetch(shown, pixel, 0).x >> uint(shift);
    if (item >= uint(count)) return;
    uint bit = 1u << (item & 31u);
    if ((seen[item >> 5u] & bit) == 0u) atomicOr(seen[item >> 5u], bit);
}
