// Stores what the G-buffer's texture `across` says of a pixel (pvfiblets/engine/gbuffer.py), as fiblets/raster/segments.glsl found it;
// without FEATURE_CROSS_LINE nothing.

#if FEATURE_CROSS_LINE && FEATURE_TUBES
#include "frame/tangent.glsl"
layout(r32ui, binding = 4) writeonly uniform uimage2D across_image;
void store_across(ivec2 pixel) { imageStore(across_image, pixel, uvec4(packed_direction(normal_here))); }
#elif FEATURE_CROSS_LINE
layout(r16f, binding = 4) writeonly uniform image2D across_image;
void store_across(ivec2 pixel) { imageStore(across_image, pixel, vec4(across_here)); }
#else
void store_across(ivec2 pixel) {}
#endif
