// Adds up what all lines show in each pixel, in words of an image with atomics. Nothing is hidden, so that there is one round,
// and whole numbers are added, so that the order does not matter.
//
// The four words of a pixel lie side by side, in a row if a texture may be so wide: atomics cost what memory they touch costs.
//
// A wide line or a tube adds once to a pixel: by the segment beside the pixel, and by round ends where the line ends.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "fiblets/compute/software_raster/segments.glsl"
#if FEATURE_CLIP_REGION
#include "regions/boundaries.glsl"
#endif

#include "fiblets/compute/visibility_bits.glsl"
#include "fiblets/compute/bits.glsl"
#include "fiblets/gather/slices.glsl"

layout(r32ui, binding = {{ image_gathered }}) uniform uimage2DArray gathered;
uniform ivec2 word_shape;   // columns and rows of a pixel's words

#if FEATURE_PAINTED
#include "fiblets/attributes/streamline_index.glsl"
#include "fiblets/attributes/values.glsl"
#include "fiblets/gather/paint.glsl"
#include "fiblets/gather/run.glsl"

uint streamline;

void start_segment(uint segment, vec3 to, vec3 delta, vec3 ahead) { start_values(segment, to, delta, polyline.steps); }
#else
void start_segment(uint segment, vec3 to, vec3 delta, vec3 ahead) {}
#endif
#if FEATURE_TUBES
vec3 shown_normal(Hit hit) { return hit.normal; }
#endif

uint owner;

void plot(Fragment fragment, Segment segment) {
#if FEATURE_WIDE_LINES
    if (fragment.s >= 1.0 && !segment.piece.cap || fragment.s <= 0.0 && !segment.piece.start) return;
#endif
#if FEATURE_CLIP_REGION
    if (!region_keeps(fragment.pixel, fragment.z)) return;
#endif
    if (!new_surface(fragment.pixel, segment.index)) return;
    int slice = slice_of(fragment.pixel, depth_key(fragment.z), owner);
    if (slice < 0) return;
#if FEATURE_PAINTED
    float value = 0.0;
#if FEATURE_PAINT_VALUE
    float t = along(fragment, segment), at = t * polyline.steps, whole = floor(clamp(at, 0.0, max(polyline.steps - 1.0, 0.0)));
    value = value_along(segment.index, t, uint(whole), at - whole);
#endif
    uvec4 adds = uvec4(painted(streamline, run_direction(segment.to.local - segment.from.local), value));
    ivec2 word = fragment.pixel * word_shape, next = word_shape.x == 4 ? ivec2(2, 0) : ivec2(0, 1);
    imageAtomicAdd(gathered, ivec3(word, slice), adds.x);
    imageAtomicAdd(gathered, ivec3(word + ivec2(1, 0), slice), adds.y);
    imageAtomicAdd(gathered, ivec3(word + next, slice), adds.z);
    imageAtomicAdd(gathered, ivec3(word + next + ivec2(1, 0), slice), adds.w);
#else
    imageAtomicAdd(gathered, ivec3(fragment.pixel, slice), 1u);
#endif
}

void main() {
    for (uint k = gl_LocalInvocationIndex;; k += gl_WorkGroupSize.x) {
        uint f = nth_fiblet(k);
        if (f == NO_FIBLET) break;
        owner = chunk_first + f;
#if FEATURE_PAINTED
        streamline = streamline_of(f);
        begin_values(f);
#endif
        draw_fiblet(f);
    }
}
