// Distance of the farthest of a tile's pixels in the picture so far: a float's bits, a texel for each tile of
// FAR_TILE by FAR_TILE pixels. Lines behind that are hidden there (segment.vert).

#version 430

#include "page/far_tile_size.glsl"

uniform highp sampler2D depths;

layout(location = 0) out uint farthest;

void main() {
    ivec2 from = ivec2(gl_FragCoord.xy) * FAR_TILE, stop = min(from + FAR_TILE, textureSize(depths, 0));
    float most = 0.0;
    for (int y = from.y; y < stop.y && most < 1.0; ++y)
        for (int x = from.x; x < stop.x; ++x) most = max(most, texelFetch(depths, ivec2(x, y), 0).r);
    farthest = floatBitsToUint(most);
}
