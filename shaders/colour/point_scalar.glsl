// A number at every point, through a look-up table.

#include "colour/table.glsl"

vec4 line_colour(uint streamline, vec3 tangent, float value) { return table_colour(value); }
