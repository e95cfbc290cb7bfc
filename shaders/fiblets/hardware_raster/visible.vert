// Marks the fiblets that a picture shows: a point for each pixel, scattered to the texel of the fiblet that owns it. Where the
// pixel to the left has the same owner, that one's point does.

#version 430

uniform usampler2D owner;
uniform int width;          // of the picture
uniform int seen_bits;
uniform ivec2 seen_size;

void main() {
    ivec2 pixel = ivec2(gl_VertexID % width, gl_VertexID / width);
    uint index = texelFetch(owner, pixel, 0).x;
    bool drawn = index != 0xFFFFFFFFu && (pixel.x == 0 || texelFetch(owner, pixel - ivec2(1, 0), 0).x != index);
    ivec2 texel = ivec2(int(index) & ((1 << seen_bits) - 1), int(index) >> seen_bits);
    gl_Position = drawn ? vec4((2.0 * vec2(texel) + 1.0) / vec2(seen_size) - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
