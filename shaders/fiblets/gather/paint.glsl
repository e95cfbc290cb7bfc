// What a line adds to a pixel (pvfiblets/engine/fiblets/gathering.py): its colour times a weight, and the weight, as whole numbers. Sums of whole
// numbers do not depend on the order in which lines are drawn.
//
// Symbols
//   c            colour, each channel in 0..255, dimmed by the light that falls on the line (resolve/line_light.glsl)
//   a            opacity of the line there
//   A            absorbance, -ln(1 - a): that of several lines one behind the other is the sum of theirs
//   w            weight: 1 where all lines have the same opacity; else A in units of 1/255 of the greatest there is

#if FEATURE_PAINT_SOLID
uniform vec3 paint_solid;
#endif
#if FEATURE_PAINT_STREAMLINE || FEATURE_PAINT_TABLE
// Row by row, one colour a streamline; or a table's, then those of below, above and NaN (resolve/colour_point_scalar.glsl).
uniform sampler2D paint_colours;
#endif
#if FEATURE_PAINT_TABLE
uniform int paint_entries;
uniform vec3 paint_range;          // lo, hi, entries / (hi - lo); logarithms where the table is spread over these
#endif
#if FEATURE_PAINT_LIGHT
uniform vec3 paint_light;          // unit vector to the light, data coordinates
const float PAINT_FLOOR = 0.6;
#endif
#if FEATURE_PAINT_ALPHA
uniform float paint_opacity;       // of the whole drawable
uniform float paint_unit;          // w over A
const float MOST_OPAQUE = 0.999;
#endif

#if FEATURE_PAINT_OPACITIES
uniform sampler2D paint_opacities; // of each streamline, in alpha, row by row
#endif

#if FEATURE_PAINT_STREAMLINE || FEATURE_PAINT_TABLE
vec4 paint_entry(int k) {
    int row = textureSize(paint_colours, 0).x;
    return texelFetch(paint_colours, ivec2(k % row, k / row), 0);
}
#endif

#if FEATURE_PAINT_TABLE
int paint_place(float value) {
    if (isnan(value)) return paint_entries + 2;
#if FEATURE_PAINT_LOGARITHM
    value = value > 0.0 ? log2(value) * 0.30102999566 : -3.0e38;
#endif
    if (value < paint_range.x) return paint_entries;
    if (value > paint_range.y) return paint_entries + 1;
    return int(min((value - paint_range.x) * paint_range.z, float(paint_entries - 1)));
}
#endif

// tangent: unit vector, data coordinates.
vec4 painted(uint streamline, vec3 tangent, float value) {
    vec4 colour = vec4(1.0);
#if FEATURE_PAINT_DIRECTION
    colour.rgb = abs(tangent);
#elif FEATURE_PAINT_SOLID
    colour.rgb = paint_solid;
#elif FEATURE_PAINT_STREAMLINE
    colour = paint_entry(int(streamline));
#elif FEATURE_PAINT_TABLE
    colour = paint_entry(paint_place(value));
#endif
#if FEATURE_PAINT_LIGHT
    float along = dot(tangent, paint_light);
    along *= along;
    colour.rgb *= PAINT_FLOOR + (1.0 - PAINT_FLOOR) * (1.0 - along * along);
#endif
#if FEATURE_PAINT_OPACITIES
    int row = textureSize(paint_opacities, 0).x;
    colour.a *= texelFetch(paint_opacities, ivec2(int(streamline) % row, int(streamline) / row), 0).a;
#endif
#if FEATURE_PAINT_VALUE_OPACITY
    colour.a *= isnan(value) ? 0.0 : clamp(value, 0.0, 1.0);
#endif
    float weight = 1.0;
#if FEATURE_PAINT_ALPHA
    weight = floor(0.5 - paint_unit * log(1.0 - min(paint_opacity * colour.a, MOST_OPAQUE)));
#endif
    return vec4(floor(255.0 * colour.rgb + 0.5) * weight, weight);
}
