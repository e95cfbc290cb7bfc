// The colour of a line before any light, of one layer, as shaders/resolve and fiblets/gather/paint_colour.glsl have it.
//
//   mode     0 direction, 1 one colour, 2 a colour for each streamline, 3 values of points through a table, 4 colours of points

#include "page/table.glsl"

uniform highp sampler2D colours;       // rgba8, by streamline
uniform int mode;
uniform vec3 one_colour;

// bits: of a value, or a colour.
vec4 colour_of_line(uint streamline, vec3 tangent, uint bits) {
    if (mode == 0) return vec4(abs(tangent), 1.0);
    if (mode == 2) return texelFetch(colours, texel(streamline), 0);
    if (mode == 3) return of_value(uintBitsToFloat(bits));
    if (mode == 4) return unpackUnorm4x8(bits);
    return vec4(one_colour, 1.0);
}
