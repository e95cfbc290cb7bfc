// Second drawing pass: which fiblet owns each pixel, and what the pixel shows. Candidates are drawn again; where a sample's
// depth is the one that the first pass kept, its fiblet takes the pixel.
//
// Ties (equal depth keys in one pixel) go to the fiblet with the smallest index: a picture does not depend on the order
// in which a driver runs groups. Every tied fiblet is a candidate, because it came nearest or tied when it was drawn. One
// that takes a pixel from another may have written it before that one did: it is marked, and resolve_ties.comp writes it again.
//
// A fiblet that took a pixel is seen: the next picture begins with it.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "fiblets/compute/software_raster/segments.glsl"

#include "fiblets/compute/visibility_bits.glsl"
#include "fiblets/compute/bits.glsl"
#include "fiblets/attributes/pixel.glsl"

layout(r32ui, binding = {{ image_depth }}) readonly uniform uimage2D depth_image;
layout(r32ui, binding = {{ image_owner }}) coherent uniform uimage2D owner_image;
layout(rg32ui, binding = {{ image_ids }}) writeonly uniform uimage2D ids_image;
layout(rg32f, binding = {{ image_position }}) writeonly uniform image2D position_image;
#include "fiblets/compute/store_across.glsl"
#include "fiblets/compute/edges.glsl"

uint owner;
bool kept;
bool tied;

void plot(Fragment fragment, Segment segment) {
    ivec2 pixel = fragment.pixel;
    if (depth_key(fragment.z) != imageLoad(depth_image, pixel).x || !new_surface(pixel, segment.index)) return;
    kept = true;
    uint before = imageAtomicMin(owner_image, pixel, owner);
    if (before < owner) return;
    if (before > owner && before != NO_FIBLET) tied = true;
    float t = along(fragment, segment);
    imageStore(ids_image, pixel, uvec4(pixel_ids(t), 0u, 0u));
#if !FEATURE_SUBSAMPLES || FEATURE_VALUES_STORED || FEATURE_VALUES_ARC_LENGTH || FEATURE_VALUES_VOLUME
    imageStore(position_image, pixel, vec4(pixel_place(segment.index, t), 0.0, 0.0));
#endif
    store_relief(pixel, fragment.relief);
    store_edges(pixel, segment);
}

void main() {
    for (uint k = gl_LocalInvocationIndex;; k += gl_WorkGroupSize.x) {
        uint f = nth_fiblet(k);
        if (f == NO_FIBLET) break;
        owner = chunk_first + f;
        kept = tied = false;
        begin_pixels(f);
        draw_fiblet(f);
        if (kept) mark(SEEN, f);
        if (tied) mark(TIED, f);
    }
}
