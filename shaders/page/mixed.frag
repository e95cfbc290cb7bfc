// The mean of all translucent things in a pixel, and their opacity over the background (vtkOrderIndependentTranslucentPass).

#version 430

uniform highp sampler2D mixed;         // sum of colours by weight; what passes
uniform highp sampler2D weights;       // sum of weights
layout(location = 0) out vec4 colour;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sum = texelFetch(mixed, pixel, 0);
    if (sum.a >= 1.0) discard;
    colour = vec4(sum.rgb / max(texelFetch(weights, pixel, 0).r, 0.01), 1.0 - sum.a);
}
