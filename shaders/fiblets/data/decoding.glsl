// Data for decoding, beside fiblets/data/culling.glsl: the second half of a record, the codes, and the rotations that direction
// codes stand for (codec/layout.glsl and pvfiblets/codec/direction_codebook.py), from storage buffers or from buffer textures.

#if FEATURE_TEXTURE_DATA
uniform usamplerBuffer decoding_texels;    // r32ui: OpenGL before 4.0 has no buffer textures of three components
uniform usamplerBuffer code_texels;        // r32ui
uint decoding_word(uint index) { return texelFetch(decoding_texels, int(index)).x; }
uint code_word(uint index) { return texelFetch(code_texels, int(index)).x; }

#else
layout(std430, binding = {{ storage_decoding }}) readonly buffer Decoding { uint decoding[]; };
layout(std430, binding = {{ storage_codes }}) readonly buffer Codes { uint codes[]; };
uint decoding_word(uint index) { return decoding[index]; }
uint code_word(uint index) { return codes[index]; }
#endif

// 16 KiB, the least that OpenGL promises to a uniform block: cap angle by cap angle 256 words, four to a row. Invocations read different
// ones: graphics cards serve these one by one from a uniform block, but not from a storage buffer.
#if FEATURE_STORED_ROTATIONS
layout(std430, binding = {{ storage_rotations }}) readonly buffer StoredRotations { uint rotations[]; };
uint rotation_word(uint index) { return rotations[index]; }
#else
#include "uniforms/Rotations.glsl"
uint rotation_word(uint index) { return rotations[index >> 2][index & 3u]; }
#endif
