// Facts on a surface's layers for the CPU (regions/layers.glsl), by squares of pixels:
//
//   x   the most fragments of front or of back faces at a pixel; a layer holds two of each
//   y   the most fragments at a pixel, negative where some share a depth, so that all layers together hold fewer

#version 430

#include "regions/layers.glsl"

uniform ivec4 rectangle;  // that the surface may touch: left, lower, right, upper
uniform int base, count;  // first layer, and how many

out vec2 found;

const int SQUARE = 4;  // as in pvfiblets/engine/regions/surface_crossings.py

void main() {
    ivec2 low = ivec2(gl_FragCoord.xy) * SQUARE + rectangle.xy, high = min(low + SQUARE, rectangle.zw);
    int most = 0, total = 0;
    bool shared_depth = false;
    for (int y = low.y; y < high.y; ++y) {
        for (int x = low.x; x < high.x; ++x) {
            ivec2 fragments = layers_counts(texelFetch(layers_even, ivec3(x, y, base >> 1), 0).w);
            int larger = max(fragments.x, fragments.y), left = fragments.x + fragments.y;
            most = max(most, larger);
            total = max(total, left);
            if (larger < 2 || larger > 2 * count) left = 0;  // no two to share a depth, or not all layers are there
            for (int layer = base; left > 0 && layer < base + count; ++layer) {
                vec4 ends;
                float end;
                layers_fetch(ivec3(x, y, layer), ends, end);
                ivec4 there = layers_there(layers_ends(ends, end));
                left -= there.x + there.y + there.z + there.w;
            }
            shared_depth = shared_depth || left > 0;
        }
    }
    found = vec2(most, shared_depth ? -total : total);
}
