// One RGBA colour per line.

#include "colour/rows.glsl"

uniform sampler2D colour_list;

vec4 line_colour(uint streamline, vec3 tangent, float value) { return nth_colour(colour_list, streamline); }
