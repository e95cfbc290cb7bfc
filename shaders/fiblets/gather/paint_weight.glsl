// The weight of a line where lines have opacities of their own: weight_of().
//
// Symbols
//   a            opacity of the line there
//   A            absorbance, -ln(1 - a): that of several lines one behind the other is the sum of theirs
//   w            weight: A in units of 1/255 of the greatest there is

#include "fiblets/gather/line_opacity.glsl"

uniform float paint_opacity;       // of the whole drawable
uniform float paint_unit;          // w over A
const float MOST_OPAQUE = 0.999;

float weight_of(float a, uint streamline, float value) {
    a *= opacity_of(streamline, value);
    return floor(0.5 - paint_unit * log(1.0 - min(paint_opacity * a, MOST_OPAQUE)));
}
