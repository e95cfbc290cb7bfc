// Whether a number is NaN: is_missing(). Pages have page/missing.glsl instead.

bool is_missing(float value) { return isnan(value); }
