// A colour at every point of a streamline, interpolated and packed into a number.

#include "fiblets/attributes/packed_colour.glsl"

vec4 line_colour(uint streamline, vec3 tangent, float value) { return unpacked_colour(value); }
