// Stores what the G-buffer's texture `across` says of a pixel (pvfiblets/engine/gbuffer.py), as fiblets/compute/software_raster/segments.glsl found it;
// without FEATURE_CROSS_LINE nothing.

#if FEATURE_CROSS_LINE && FEATURE_TUBES
#include "frame/tangent.glsl"
layout(r32ui, binding = {{ image_across }}) writeonly uniform uimage2D across_image;
void store_relief(ivec2 pixel, vec3 normal) { imageStore(across_image, pixel, uvec4(packed_direction(normal))); }
#elif FEATURE_CROSS_LINE
layout(r16f, binding = {{ image_across }}) writeonly uniform image2D across_image;
void store_relief(ivec2 pixel, vec3 across) { imageStore(across_image, pixel, vec4(across.x)); }
#else
void store_relief(ivec2 pixel, vec3 relief) {}
#endif
#if FEATURE_TUBES
vec3 shown_normal(Hit hit) { return smooth_normal(hit, tangent_between(tangents, hit.t)); }
#endif
