// The opacity that a line has beside that of its colour (shaders/resolve/opacity_streamline.glsl and its neighbours). It
// stands for fiblets/gather/line_opacity.glsl.

#include "page/missing.glsl"
#include "page/rows.glsl"

uniform highp usampler2D opacities;    // r8ui, by streamline, in 255ths
uniform int by_streamline;             // 1: these count
uniform int by_point;                  // 1: values of points are opacities; NaN is not to be seen

float opacity_of(uint streamline, float value) {
    float a = 1.0;
    if (by_streamline == 1) a = float(texelFetch(opacities, texel(streamline), 0).r) / 255.0;
    if (by_point == 1) a *= is_missing(value) ? 0.0 : clamp(value, 0.0, 1.0);
    return a;
}
