// First drawing pass: the nearest depth of every pixel, and which fiblets ever came nearest somewhere.
//
// One invocation decodes a fiblet in registers and draws its short segments straight into the depth image with
// imageAtomicMin. Losers are turned away by a plain load: what the image holds only ever falls, so a stale value can
// cost an atomic but never a pixel. A fiblet that won or tied a pixel becomes a candidate for owning it.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "raster/segments.glsl"

#include "compute/marks.glsl"

layout(r32ui, binding = 0) coherent uniform uimage2D depth_image;

uniform uint part;  // of the plan

uint bits_of(uint word) { return marks[word * 8u + part]; }

#include "compute/bits.glsl"

bool won;

void start_segment(uint segment, vec3 delta) {}

void plot(ivec2 pixel, float z, float s, uint segment) {
    uint key = depth_key(z), there = imageLoad(depth_image, pixel).x;
    if (key < there) there = imageAtomicMin(depth_image, pixel, key);
    if (key <= there) won = true;
}

void main() {
    for (uint k = gl_LocalInvocationIndex;; k += gl_WorkGroupSize.x) {
        uint f = nth_fiblet(k);
        if (f == NO_FIBLET) break;
        won = false;
        draw_fiblet(f);
        if (won) atomicOr(marks[((chunk.y + f) >> 5) * 8u + CANDIDATES], 1u << (f & 31u));
    }
}
