// The weight of a line where lines have opacities of their own: weight_of().
//
// Symbols
//   a            opacity of the line there
//   A            absorbance, -ln(1 - a): that of several lines one behind the other is the sum of theirs
//   w            weight: A in units of 1/255 of the greatest there is

uniform float paint_opacity;       // of the whole drawable
uniform float paint_unit;          // w over A
const float MOST_OPAQUE = 0.999;

#if FEATURE_PAINT_OPACITIES
uniform sampler2D paint_opacities; // of each streamline, in alpha, row by row
#endif

float weight_of(float a, uint streamline, float value) {
#if FEATURE_PAINT_OPACITIES
    int row = textureSize(paint_opacities, 0).x;
    a *= texelFetch(paint_opacities, ivec2(int(streamline) % row, int(streamline) / row), 0).a;
#endif
#if FEATURE_PAINT_VALUE_OPACITY
    a *= isnan(value) ? 0.0 : clamp(value, 0.0, 1.0);
#endif
    return floor(0.5 - paint_unit * log(1.0 - min(paint_opacity * a, MOST_OPAQUE)));
}
