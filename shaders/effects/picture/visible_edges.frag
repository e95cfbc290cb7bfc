// Input of antialias_coverage.frag: the lines that a picture shows, and all of its colours, with an empty border of one texel around
// the picture. It runs once for each drawable, the first time for all pixels, then for pixels that show it.
//
//   keys, edges   of the drawable's G-buffer (pvfiblets/engine/gbuffer.py)
//   drawn, depths colours and depths of VTK's framebuffer; single, or `samples` per pixel     (FEATURE_PICTURE_SAMPLES)
//   origin        pixel of the framebuffer at which the picture begins
//   narrower      excess of the drawn width over the line's, in pixels
//
// A pixel shows a line where nothing is drawn before it. Translucent things leave no depth: lines are visible through them.
// Out: bits of the window depth | edges (frame/edges.glsl), 0 where there is no line | colour, 4 x 8 bits.

#version 430

#include "frame/edges.glsl"

uniform usampler2D keys;
uniform usampler2D edges;
#if FEATURE_PICTURE_SAMPLES
uniform sampler2DMS drawn;
uniform sampler2DMS depths;
uniform int samples;
const vec4 LIGHT = vec4(2.2, 2.2, 2.2, 1.0);
#else
uniform sampler2D drawn;
uniform sampler2D depths;
#endif
uniform ivec2 origin;
uniform float narrower;
uniform int first;

out uvec4 shown;

const float MARGIN = 1.0 / 8388608.0;      // two units of a depth buffer of 24 bits: VTK rounds

uint thinned(uint word) {
    uint inside = (word >> 11u) & 2047u, width = (word >> 22u) & 127u;
    inside -= min(inside, uint(0.5 * narrower * EDGE_STEPS + 0.5));
    width -= min(width - 1u, uint(narrower * WIDTH_STEPS + 0.5));
    return (word & 0xE00007FFu) | (inside << 11u) | (width << 22u);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - 1;
    shown = uvec4(0u);
    bool inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, textureSize(keys, 0)));
    uint key = inside ? texelFetch(keys, pixel, 0).r : 0xFFFFFFFFu;
    if (key == 0xFFFFFFFFu && first == 0) discard;
    if (!inside) return;
#if FEATURE_PICTURE_SAMPLES && !FEATURE_PICTURE_ALIKE
    float depth = 1.0;
    for (int i = 0; i < samples; ++i) depth = min(depth, texelFetch(depths, pixel + origin, i).r);
    vec4 colour = texelFetch(drawn, pixel + origin, 0);
    bool same = true;
    for (int i = 1; i < samples; ++i) same = same && texelFetch(drawn, pixel + origin, i) == colour;
    if (!same) {
        vec4 sum = vec4(0.0);
        for (int i = 0; i < samples; ++i) sum += pow(texelFetch(drawn, pixel + origin, i), LIGHT);
        colour = pow(sum / float(samples), 1.0 / LIGHT);      // as VTK's own resolve has it
    }
#else
    float depth = texelFetch(depths, pixel + origin, 0).r;
    vec4 colour = texelFetch(drawn, pixel + origin, 0);
#endif
    float z = float(key) / 4294967295.0;
    bool visible = key != 0xFFFFFFFFu && z <= depth + MARGIN;
    if (!visible && first == 0) discard;
    uint word = visible ? thinned(texelFetch(edges, pixel, 0).r) : 0u;
    shown = uvec4(floatBitsToUint(visible ? z : depth), word, packUnorm4x8(colour), 0u);
}
