// The one per-point value that a style may ask for: codes of a stored array, or a float32 for every anchor
// (pvfiblets/engine/fiblets/data/point_values.py), from storage buffers or from buffer textures.

#if FEATURE_VALUES_STORED
#if FEATURE_TEXTURE_DATA
uniform usamplerBuffer value_texels;  // r32ui
uint value_word(uint index) { return texelFetch(value_texels, int(index)).x; }
#else
layout(std430, binding = {{ storage_values }}) readonly buffer Values { uint values[]; };
uint value_word(uint index) { return values[index]; }
#endif
#elif FEATURE_VALUES_ARC_LENGTH || FEATURE_VALUES_CURVATURE
#if FEATURE_TEXTURE_DATA
uniform samplerBuffer start_texels;   // r32f
float start_value(uint f) { return texelFetch(start_texels, int(f)).x; }
#else
layout(std430, binding = {{ storage_values }}) readonly buffer Starts { float starts[]; };
float start_value(uint f) { return starts[f]; }
#endif
#endif
