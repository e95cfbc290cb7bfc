// Colours of points in place of per-point values: the bits of a float here, which is never calculated with. It stands for
// fiblets/attributes/packed_colour.glsl.

vec4 unpacked_colour(float value) { return unpackUnorm4x8(floatBitsToUint(value)); }
