// The colours of a slice, unlit; wholly translucent pixels are left out. Where pixels are clear or opaque and nothing between
// (clear 0), the edge is where half of the colour is: blended there, what is behind would shine.

#version 430

in vec2 at;
uniform highp sampler2D pixels;
uniform float opacity;
uniform int clear;
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 weight;   // mixed.frag; nothing where it is not blended by it

void main() {
    colour = texture(pixels, at);
    if (colour.a <= (clear == 0 ? 0.5 : 0.002)) discard;
    if (clear == 0) colour = vec4(colour.rgb / colour.a, 1.0);
    colour.a *= opacity;
    weight = vec4(1.0, 0.0, 0.0, colour.a);
}
