// Mask of tiles of TILE by TILE pixels with a line within them or a pixel beside them: a texel for each.

#version 430

#include "page/tile_size.glsl"

uniform highp usampler2D texels;
uniform int first;                     // 1: tiles without any are cleared

layout(location = 0) out uint some;

void main() {
    ivec2 size = textureSize(texels, 0), from = max(ivec2(gl_FragCoord.xy) * TILE - 1, ivec2(0));
    ivec2 stop = min(ivec2(gl_FragCoord.xy) * TILE + TILE + 1, size);
    some = 0u;
    for (int y = from.y; y < stop.y && some == 0u; ++y)
        for (int x = from.x; x < stop.x; ++x) {
            uvec4 texel = texelFetch(texels, ivec2(x, y), 0);
            some |= ~(texel.x & texel.y);
        }
    some = min(some, 1u);
    if (first + int(some) == 0) discard;
}
