// It stands for fiblets/gather/paint_colour.glsl: the colour of a line where all lines of a pixel are added up, with all opacities
// but the layer's in its alpha.

#include "page/line_colour.glsl"
#include "page/line_opacity.glsl"

vec4 line_colour(uint streamline, vec3 tangent, float value) {
    vec4 c = colour_of_line(streamline, tangent, floatBitsToUint(value));
    return vec4(c.rgb, c.a * opacity_of(streamline, floatBitsToUint(value)));
}
