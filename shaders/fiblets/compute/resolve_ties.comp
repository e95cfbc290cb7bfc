// Last drawing pass: fiblets that took the same pixel as another are drawn once more, and each writes the pixels that it
// owns. No two invocations write the same one. With atomics of 64 bits it is the only one after depth.comp: it draws all
// fiblets that own a pixel.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "fiblets/compute/software_raster/segments.glsl"

#include "fiblets/compute/visibility_bits.glsl"
#include "fiblets/compute/bits.glsl"
#include "fiblets/attributes/pixel.glsl"

layout(r32ui, binding = {{ image_depth }}) readonly uniform uimage2D depth_image;
layout(r32ui, binding = {{ image_owner }}) readonly uniform uimage2D owner_image;
layout(rg32ui, binding = {{ image_ids }}) writeonly uniform uimage2D ids_image;
layout(rg32f, binding = {{ image_position }}) writeonly uniform image2D position_image;
#include "fiblets/compute/store_across.glsl"
#include "fiblets/compute/edges.glsl"

uint owner;

void plot(Fragment fragment, Segment segment) {
    ivec2 pixel = fragment.pixel;
    if (imageLoad(owner_image, pixel).x != owner || depth_key(fragment.z) != imageLoad(depth_image, pixel).x) return;
    if (!new_surface(pixel, segment.index)) return;
    float t = along(fragment, segment);
    imageStore(ids_image, pixel, uvec4(pixel_ids(t), 0u, 0u));
    imageStore(position_image, pixel, vec4(pixel_place(segment.index, t), 0.0, 0.0));
    store_relief(pixel, fragment.relief);
    store_edges(pixel, segment);
}

void main() {
    for (uint k = gl_LocalInvocationIndex;; k += gl_WorkGroupSize.x) {
        uint f = nth_fiblet(k);
        if (f == NO_FIBLET) break;
        owner = chunk_first + f;
        begin_pixels(f);
        draw_fiblet(f);
    }
}
