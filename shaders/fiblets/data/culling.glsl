// Data of a fiblet for culling, from storage buffers (OpenGL 4.3) or from buffer textures (OpenGL 3.3). Nothing else
// knows where data lie: the functions are the same.
//
// `f` is an index within the chunk. A chunk holds whole pages, and at its end the anchor of the fiblet that follows.
// pvfiblets/engine/fiblets/data/chunks.py makes the buffers.
//
//   anchors      two words a fiblet
//   pages        four words a row: rank, first code, first point of a page; behind the pages, streamlines by rank
//   bounds       capsule radii, two to a word; from word chunk_end_words on, the end vectors, one word by rank
//   anchors_low  lower halves of 32-bit anchors, three to a fiblet, two to a word

#include "frame/blocks.glsl"
#include "uniforms/Chunk.glsl"
#include "uniforms/Coding.glsl"

#if FEATURE_TEXTURE_DATA
uniform usamplerBuffer anchor_texels;      // rg32ui
uniform usamplerBuffer page_texels;        // rgba32ui
uniform usamplerBuffer bound_texels;       // r32ui
uvec2 anchor_words(uint f) { return texelFetch(anchor_texels, int(f)).xy; }
uvec4 page_words(uint row) { return texelFetch(page_texels, int(row)); }
uint bound_word(uint index) { return texelFetch(bound_texels, int(index)).x; }
#if FEATURE_ANCHORS_LOW
uniform usamplerBuffer anchor_low_texels;  // r32ui
uint anchor_low_word(uint index) { return texelFetch(anchor_low_texels, int(index)).x; }
#endif

#else
layout(std430, binding = {{ storage_anchors }}) readonly buffer Anchors { uvec2 anchors[]; };
layout(std430, binding = {{ storage_pages }}) readonly buffer Pages { uvec4 pages[]; };
layout(std430, binding = {{ storage_bounds }}) readonly buffer Bounds { uint bounds[]; };
uvec2 anchor_words(uint f) { return anchors[f]; }
uvec4 page_words(uint row) { return pages[row]; }
uint bound_word(uint index) { return bounds[index]; }
#if FEATURE_ANCHORS_LOW
layout(std430, binding = {{ storage_anchors_low }}) readonly buffer AnchorsLow { uint anchors_low[]; };
uint anchor_low_word(uint index) { return anchors_low[index]; }
#endif
#endif
