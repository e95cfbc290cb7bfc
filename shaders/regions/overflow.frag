// Whether any pixel of a square has more boundaries than there are layers (regions/combine.frag).

#version 430

uniform sampler2DArray region_boundaries;
uniform ivec4 rectangle;  // left, lower, right, upper
uniform int last;         // layer

out vec2 found;

const int SQUARE = 4;  // as in pvfiblets/engine/regions/surface_crossings.py
const float OVERFLOW = -9.0;

void main() {
    ivec2 low = ivec2(gl_FragCoord.xy) * SQUARE + rectangle.xy, high = min(low + SQUARE, rectangle.zw);
    bool over = false;
    for (int y = low.y; y < high.y; ++y) {
        for (int x = low.x; x < high.x; ++x) {
            over = over || texelFetch(region_boundaries, ivec3(x, y, last), 0).w == OVERFLOW;
        }
    }
    found = vec2(over);
}
