// One colour for all lines.

uniform vec3 colour_solid;

vec4 line_colour(uint streamline, vec3 tangent, float value) { return vec4(colour_solid, 1.0); }
