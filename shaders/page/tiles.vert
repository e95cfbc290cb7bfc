// The picture as tiles, an instance each, without the empty ones of tile_mask.frag: passes over lines then cost
// only the area that the lines cover.

#version 430

#include "page/tile_size.glsl"

uniform highp usampler2D tiles;

uniform vec2 whole;                    // size of the picture

void main() {
    int columns = textureSize(tiles, 0).x;
    ivec2 tile = ivec2(gl_InstanceID % columns, gl_InstanceID / columns);
    vec2 corner = vec2(TILE * (tile + ivec2(gl_VertexID & 1, gl_VertexID >> 1)));
    gl_Position = texelFetch(tiles, tile, 0).x == 0u ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(2.0 * corner / whole - 1.0, 0.0, 1.0);
}
