// Stores what the G-buffer's texture `across` says of a pixel (pvfiblets/engine/gbuffer.py), as raster/segments.glsl found it;
// without FEATURE_ACROSS nothing.

#if FEATURE_ACROSS && FEATURE_TUBES
#include "attributes/tangent.glsl"
layout(r32ui, binding = 4) writeonly uniform uimage2D across_image;
void store_across(ivec2 pixel) { imageStore(across_image, pixel, uvec4(packed_direction(normal_here))); }
#elif FEATURE_ACROSS
layout(r16f, binding = 4) writeonly uniform image2D across_image;
void store_across(ivec2 pixel) { imageStore(across_image, pixel, vec4(across_here)); }
#else
void store_across(ivec2 pixel) {}
#endif
