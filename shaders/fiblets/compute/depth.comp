// First drawing pass: the nearest depth of every pixel, and which fiblets ever came nearest somewhere.
//
// One invocation decodes a fiblet in registers and draws its short segments straight into the depth image with
// imageAtomicMin. Losers are turned away by a plain load: what the image holds only ever falls, so a stale value can
// cost an atomic but never a pixel. A fiblet that won or tied a pixel becomes a candidate for owning it.
//
// With atomics of 64 bits the fiblet goes along with its depth (fiblets/compute/nearest.glsl), and split.comp finds the owners.

#version 430
#if FEATURE_INT64_ATOMICS
#extension GL_ARB_gpu_shader_int64 : require
#extension GL_NV_shader_atomic_int64 : require
#endif
layout(local_size_x = {{ group_size }}) in;

#if FEATURE_COVER_APART && !FEATURE_WIDE_LINES
#define COVER_APART
#endif
#include "fiblets/compute/software_raster/segments.glsl"
#if FEATURE_CLIP_REGION
#include "regions/boundaries.glsl"
#endif

#include "fiblets/compute/visibility_bits.glsl"

#if FEATURE_INT64_ATOMICS
#include "fiblets/compute/nearest.glsl"
uint owner;
#else
layout(r32ui, binding = {{ image_depth }}) coherent uniform uimage2D depth_image;
bool won;
#endif

#include "fiblets/compute/bits.glsl"

void start_segment(uint segment, vec3 to, vec3 delta, vec3 ahead) {}
#if FEATURE_TUBES
vec3 shown_normal(Hit hit) { return hit.normal; }
#endif

// Whether a nearest pixel is kept: by the caller's region, and as no part of an earlier layer's surface.
bool may_show(ivec2 pixel, float z, uint segment) {
#if FEATURE_CLIP_REGION
    if (!region_keeps(pixel, z)) return false;
#endif
    return new_surface(pixel, segment);
}

void plot(Fragment fragment, Segment segment) {
    ivec2 pixel = fragment.pixel;
#if FEATURE_INT64_ATOMICS
    uint at = pixel_index(pixel);
    uint64_t word = nearest_word(depth_key(fragment.z), owner);
    if (word < nearest[at] && may_show(pixel, fragment.z, segment.index)) atomicMin(nearest[at], word);
#else
    uint key = depth_key(fragment.z), there = imageLoad(depth_image, pixel).x;
    if (key > there || !may_show(pixel, fragment.z, segment.index)) return;
    if (key < there) there = imageAtomicMin(depth_image, pixel, key);
    if (key <= there) won = true;
#endif
}

void begin_cover(uint f) {
#if FEATURE_INT64_ATOMICS
    owner = chunk_first + f;
#else
    won = false;
#endif
}

void end_cover(uint f) {
#if !FEATURE_INT64_ATOMICS
    if (won) mark(CANDIDATES, f);
#endif
}

#ifndef COVER_APART
void main() {
    for (uint k = gl_LocalInvocationIndex;; k += gl_WorkGroupSize.x) {
        uint f = nth_fiblet(k);
        if (f == NO_FIBLET) break;
        begin_cover(f);
        draw_fiblet(f);
        end_cover(f);
    }
}
#else
#include "fiblets/compute/software_raster/cover_apart.glsl"
void main() { draw_together(); }
#endif
