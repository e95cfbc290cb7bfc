// The opacity that a line has beside that of its colour: opacity_of(). Pages have page/line_opacity.glsl instead.

#if FEATURE_PAINT_OPACITIES
uniform sampler2D paint_opacities; // of each streamline, in alpha, row by row
#include "colour/rows.glsl"
#endif

float opacity_of(uint streamline, float value) {
    float a = 1.0;
#if FEATURE_PAINT_OPACITIES
    a = nth_colour(paint_opacities, streamline).a;
#endif
#if FEATURE_PAINT_VALUE_OPACITY
    a *= isnan(value) ? 0.0 : clamp(value, 0.0, 1.0);
#endif
    return a;
}
