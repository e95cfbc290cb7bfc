// Translucent lines of one layer: the nearest, and behind it what sum.frag has added up, slice by slice (shaders/resolve/slices.glsl
// and slices_colour.glsl). Of everything translucent in a pixel the mean is shown, as VTK has it without depth peeling
// (shaders/resolve/layers.glsl): the output is this layer's share of it, over its alpha, since blending multiplies by alpha.

#version 430

#include "page/lit_line.glsl"
#include "page/line_opacity.glsl"

uniform highp sampler2D sums0;         // red, green, blue, each in 0..255 times weight, and weight
uniform highp sampler2D sums1;
uniform highp sampler2D sums2;
uniform highp sampler2D sums3;
uniform float opacity;                 // of the layer
uniform float absorbance;              // of a unit of weight
uniform float least;                   // weight of a slice that has a line

layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 weight;

vec3 seen;
float seen_weight, reaching;

void add(ivec2 pixel, highp sampler2D sums) {
    vec4 sum = texelFetch(sums, pixel, 0);
    if (sum.a < least) return;
    float through = exp(-absorbance * sum.a), share = reaching * (1.0 - through);
    seen += share * lit(pixel, mix(sum.rgb / (255.0 * sum.a), faded.rgb, faded.a), vec3(0.70710678, 0.70710678, 0.0));
    seen_weight += share;
    reaching *= through;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 word = nearest_line(pixel);
    vec4 line = lit_line(pixel, word);
    float a = opacity * line.a * opacity_of(word.x & 0x0FFFFFFFu, uintBitsToFloat(word.w));
    seen = a * line.rgb;
    seen_weight = a;
    reaching = 1.0 - a;
    add(pixel, sums0);
    add(pixel, sums1);
    add(pixel, sums2);
    add(pixel, sums3);
    float alpha = 1.0 - reaching;
    if (alpha <= 0.0) discard;
    colour = vec4(seen / alpha, alpha);
    weight = vec4(seen_weight / alpha, 0.0, 0.0, alpha);
}
