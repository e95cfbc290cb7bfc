// Stores where the edges run of what a pixel shows (pvfiblets/engine/gbuffer.py); without FEATURE_EDGES nothing.

#if FEATURE_EDGES
#include "fiblets/segments/segment_edges.glsl"
layout(r32ui, binding = {{ image_edges }}) writeonly uniform uimage2D edges_image;

void store_edges(ivec2 pixel, Segment segment) { imageStore(edges_image, pixel, uvec4(edges_of(pixel, segment))); }
#else
void store_edges(ivec2 pixel, Segment segment) {}
#endif
