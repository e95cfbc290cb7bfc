// Colours of the page's G-buffer, for one layer.

#version 430

#include "page/lit_line.glsl"

layout(location = 0) out vec4 colour;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    colour = lit_line(pixel, nearest_line(pixel));
    if (colour.a == 0.0) discard;
    colour.a = 1.0;
}
