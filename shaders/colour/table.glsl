// A number through a look-up table by vtkLookupTable's rules: table_colour(). The same in NumPy: map_values() of
// pvfiblets/mappers/colouring.py.
//
//   v < lo : below-range colour    v > hi : above-range colour    NaN : NaN colour
//   else   : entry min(floor((v - lo) * n / (hi - lo)), n - 1)

#include "colour/rows.glsl"
#include "colour/missing.glsl"
#if FEATURE_TABLE_LOGARITHM
#include "colour/logarithm.glsl"
#endif

uniform sampler2D colour_table;        // n colours, then the colours of below, above and NaN, row by row
uniform int colour_entries;            // n
uniform vec3 colour_range;             // lo, hi, n / (hi - lo); logarithms of lo, hi on a log scale

uint table_entry(float value) {
    uint n = uint(colour_entries);
    if (is_missing(value)) return n + 2u;
#if FEATURE_TABLE_LOGARITHM
    value = logarithm(value);
#endif
    if (value < colour_range.x) return n;
    if (value > colour_range.y) return n + 1u;
    // min before the conversion: with lo = hi the scale is huge, and the product may not fit an integer.
    return uint(min((value - colour_range.x) * colour_range.z, float(colour_entries - 1)));
}

vec4 table_colour(float value) { return nth_colour(colour_table, table_entry(value)); }
