// Two triangles over each of those squares (line_tiles.frag), and nothing over the others: six vertices a square.
//
//   tiles      1 where there are lines
//   start      of the first square, in pixels of the viewport that is drawn into
//   size       of that viewport
//   border     pixels to go beyond each square

#version 430

uniform sampler2D tiles;
uniform ivec2 start;
uniform ivec2 size;
uniform int border;

const int TILE = {{ tile }};

void main() {
    int tile = gl_VertexID / 6, corner = gl_VertexID - 6 * tile, across = textureSize(tiles, 0).x;
    ivec2 place = ivec2(tile % across, tile / across);
    ivec2 end = ivec2(corner == 1 || corner >= 3 && corner <= 4 ? 1 : 0, corner == 2 || corner >= 4 ? 1 : 0);
    vec2 pixel = vec2(start + TILE * (place + end) + border * (2 * end - 1));
    gl_Position = texelFetch(tiles, place, 0).r > 0.0 ? vec4(2.0 * pixel / vec2(size) - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
