// The colours of a slice, unlit; wholly translucent pixels are left out.

#version 430

in vec2 at;
uniform highp sampler2D pixels;
uniform float opacity;
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 weight;   // mixed.frag; nothing where it is not blended by it

void main() {
    colour = texture(pixels, at);
    if (colour.a <= 0.002) discard;
    colour.a *= opacity;
    weight = vec4(1.0, 0.0, 0.0, colour.a);
}
