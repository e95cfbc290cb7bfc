// The colour of a line where all lines of a pixel are added up, RGBA, before any light: line_colour().

#if FEATURE_PAINT_DIRECTION
vec4 line_colour(uint streamline, vec3 tangent, float value) { return vec4(abs(tangent), 1.0); }
#elif FEATURE_PAINT_SOLID
uniform vec3 paint_solid;

vec4 line_colour(uint streamline, vec3 tangent, float value) { return vec4(paint_solid, 1.0); }
#elif FEATURE_PAINT_POINT
vec4 line_colour(uint streamline, vec3 tangent, float value) { return unpacked_colour(value); }
#else
// Row by row, one colour a streamline; or a table's, then those of below, above and NaN (resolve/colour_point_scalar.glsl).
uniform sampler2D paint_colours;

vec4 paint_entry(int k) {
    int row = textureSize(paint_colours, 0).x;
    return texelFetch(paint_colours, ivec2(k % row, k / row), 0);
}

#if FEATURE_PAINT_STREAMLINE
vec4 line_colour(uint streamline, vec3 tangent, float value) { return paint_entry(int(streamline)); }
#else
uniform int paint_entries;
uniform vec3 paint_range;          // lo, hi, entries / (hi - lo); logarithms where the table is spread over these

int paint_place(float value) {
    if (isnan(value)) return paint_entries + 2;
#if FEATURE_PAINT_LOGARITHM
    value = value > 0.0 ? log2(value) * 0.30102999566 : -3.0e38;
#endif
    if (value < paint_range.x) return paint_entries;
    if (value > paint_range.y) return paint_entries + 1;
    return int(min((value - paint_range.x) * paint_range.z, float(paint_entries - 1)));
}

vec4 line_colour(uint streamline, vec3 tangent, float value) { return paint_entry(paint_place(value)); }
#endif
#endif
