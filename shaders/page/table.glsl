// A value through a look-up table, by vtkLookupTable's rules (shaders/resolve/colour_point_scalar.glsl).

#include "page/rows.glsl"

uniform highp sampler2D table;         // rgba8: entries, then below, above, NaN
uniform vec4 table_range;              // low, high, entries per unit, entries
uniform int logarithm;

vec4 of_value(float value) {
    int n = int(table_range.w), entry;
    if ((floatBitsToUint(value) & 0x7FFFFFFFu) > 0x7F800000u) entry = n + 2;
    else {
        if (logarithm == 1) value = value > 0.0 ? log(value) * 0.4342944819032518 : -3.0e38;
        if (value < table_range.x) entry = n;
        else if (value > table_range.y) entry = n + 1;
        else entry = int(min((value - table_range.x) * table_range.z, float(n - 1)));
    }
    return texelFetch(table, texel(uint(entry)), 0);
}
