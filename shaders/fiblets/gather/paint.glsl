// Contribution of a line to a pixel (pvfiblets/engine/fiblets/gather/gathering.py): its colour times a weight, and the weight, as whole numbers.
// Sums of whole numbers do not depend on the order in which lines are drawn.
//
// Symbols
//   c            colour, each channel in 0..1 (shaders/colour), dimmed by the light that falls on the line
//   w            weight: 1 where all lines have the same opacity, else of its own (paint_weight.glsl)

#include "colour/line_colour.glsl"
#if FEATURE_PAINT_ALPHA
#include "fiblets/gather/paint_weight.glsl"
#endif

#if FEATURE_PAINT_LIGHT
#include "frame/gentle_light.glsl"

uniform vec3 paint_light;          // unit vector to the light, data coordinates
#endif

// tangent: unit vector, data coordinates.
vec4 painted(uint streamline, vec3 tangent, float value) {
    vec4 c = line_colour(streamline, tangent, value);
    float w = 1.0;
#if FEATURE_PAINT_LIGHT
    c.rgb *= gentle_light(across_line(tangent, paint_light));   // as resolve/line_light.glsl dims the nearest line
#endif
#if FEATURE_PAINT_ALPHA
    w = weight_of(c.a, streamline, value);
#endif
    return vec4(floor(255.0 * c.rgb + 0.5) * w, w);
}
