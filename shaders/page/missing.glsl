// Whether a number is NaN: is_missing(). By its bits, as GLSL ES lets compilers take isnan() for false.

bool is_missing(float value) { return (floatBitsToUint(value) & 0x7FFFFFFFu) > 0x7F800000u; }
