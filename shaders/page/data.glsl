// Data of fiblets in a page: textures of two dimensions, since WebGL 2 has neither storage buffers nor buffer
// textures. It stands for fiblets/data/culling.glsl and fiblets/data/decoding.glsl: the functions are the same, and everything
// that decodes is the engine's own text.
//
// Words are as the file has them (pvfiblets/codec/layout.py).

#include "frame/blocks.glsl"
#include "uniforms/Coding.glsl"
#include "uniforms/Rotations.glsl"
#include "page/rows.glsl"

const uint chunk_first_rank = 0u, chunk_pages = 0u;

uniform highp usampler2D anchor_texels;      // rg32ui
uniform highp usampler2D page_texels;        // rgba32ui: rank, first code, first point
uniform highp usampler2D decoding_texels;    // r32ui
uniform highp usampler2D code_texels;        // r32ui
uniform uint chunk_fiblets;

uvec2 anchor_words(uint f) { return texelFetch(anchor_texels, texel(f), 0).xy; }
uvec4 page_words(uint row) { return texelFetch(page_texels, texel(row), 0); }
uint decoding_word(uint index) { return texelFetch(decoding_texels, texel(index), 0).x; }
uint code_word(uint index) { return texelFetch(code_texels, texel(index), 0).x; }
uint rotation_word(uint index) { return rotations[index >> 2][index & 3u]; }

// Capsules are not looked at here.
uint bound_word(uint index) { return 0u; }
const uint chunk_end_words = 0u;

#if FEATURE_ANCHORS_LOW
uniform highp usampler2D anchor_low_texels;  // r32ui
uint anchor_low_word(uint index) { return texelFetch(anchor_low_texels, texel(index), 0).x; }
#endif
