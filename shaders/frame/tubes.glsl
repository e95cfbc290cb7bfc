// Tubes of a radius in millimetres; pvfiblets/engine/fiblets/line_tubes.py declares and packs them. Without the feature nothing of this file is left.
//
// Symbols
//   r            radius (mm)
//   D(x, y)      direction of the ray through (x, y) of the window, local mm: in perspective mm per W, D_0 + x D_x + y D_y;
//                in a parallel view D_0 everywhere
//   D_x, D_y     in both, a pixel to the right (upwards) of a point in its plane W is W D_x (W D_y) away
//   E            the eye, local mm: in perspective all rays come from there

#if FEATURE_TUBES
#include "uniforms/Tubes.glsl"
#endif
