// Input of antialias_coverage.frag, from the page's G-buffer, with a border of one texel around the picture: the page's
// counterpart of effects/picture/visible_edges.frag, which explains `narrower`.

#version 430

#include "codec/layout.glsl"
#include "frame/edges.glsl"

uniform highp usampler2D texels;
uniform highp sampler2D depths;
uniform highp sampler2D drawn;
uniform float narrower;
uniform int first;                     // 1: pixels without a line count, too

layout(location = 0) out uvec4 shown;

uint thinned(uint word) {
    uint inside = (word >> 11u) & 2047u, width = (word >> 22u) & 127u;
    inside -= min(inside, uint(0.5 * narrower * EDGE_STEPS + 0.5));
    width -= min(width - 1u, uint(narrower * WIDTH_STEPS + 0.5));
    return (word & 0xE00007FFu) | (inside << 11u) | (width << 22u);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - 1;
    shown = uvec4(0u);
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, textureSize(texels, 0)))) return;
    uvec4 texel = texelFetch(texels, pixel, 0);
    bool line = texel.x != 0xFFFFFFFFu || texel.y != 0xFFFFFFFFu;
    if (!line && first == 0) discard;
    shown = uvec4(floatBitsToUint(texelFetch(depths, pixel, 0).r), line ? thinned(texel.z) : 0u, packUnorm4x8(texelFetch(drawn, pixel, 0)), 0u);
}
