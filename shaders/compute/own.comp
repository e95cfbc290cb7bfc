// Second drawing pass: which fiblet owns each pixel. Candidates are decoded and drawn again; where a sample's depth is
// the one that the first pass kept, its fiblet takes the pixel.
//
// Ties (equal depth keys in one pixel) go to the fiblet with the smallest index: a picture does not depend on the order
// in which a driver runs groups. Every tied fiblet is a candidate, because it came nearest or tied when it was drawn.
//
// A fiblet with such a sample is seen: the last pass draws no others, and the next picture begins with them. (Those that
// lost all their pixels in ties are among them; the last pass finds that they own nothing.)

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "raster/segments.glsl"

#include "compute/marks.glsl"

layout(r32ui, binding = 0) readonly uniform uimage2D depth_image;
layout(r32ui, binding = 1) coherent uniform uimage2D owner_image;

uniform uint part;  // of the plan: which class

uint bits_of(uint word) {
    return marks[word * 8u + CANDIDATES] & (marks[word * 8u + part] | marks[word * 8u + part + 3u]);
}

#include "compute/bits.glsl"

uint owner;
bool kept;

void start_segment(uint segment, vec3 delta) {}

void plot(ivec2 pixel, float z, float s, uint segment) {
    if (depth_key(z) == imageLoad(depth_image, pixel).x) {
        kept = true;
        imageAtomicMin(owner_image, pixel, owner);
    }
}

void main() {
    for (uint k = gl_LocalInvocationIndex;; k += gl_WorkGroupSize.x) {
        uint f = nth_fiblet(k);
        if (f == NO_FIBLET) break;
        owner = chunk.y + f;
        kept = false;
        draw_fiblet(f);
        if (kept) atomicOr(marks[(owner >> 5) * 8u + SEEN], 1u << (f & 31u));
    }
}
