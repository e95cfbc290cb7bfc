// Asks of every streamline where its points lie. Three passes over a batch of fiblets, one invocation each:
//   CLASSIFY     whole fiblets by their capsules. Those that this leaves undecided are listed
//   SIFT         of those, list the ones whose streamline's answer is still open: one that has points inside and points
//                outside by now has only its two ends to be asked about
//   DECODE       the points of these, until the streamline's answer is settled
// Lists keep neighbouring invocations busy alike.
//
// Points are tested as balls of the radius by which float32 may have moved them (walk_margin). A point that this leaves
// undecided counts as unsure; where that matters to its streamline, pvfiblets/engine/querying.py has it settled in float64.
//
// With `sampling`, positions between points are tested too: a segment of length L is cut into ceil(L / sampling) equal
// pieces. Where rounding may change their number, or they are more than SAMPLES, the segment is unsure as a whole.
//
// A byte per streamline, by rank from the chunk's first; pvfiblets/engine/querying.py has the same bits.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "culling/bounds.glsl"
#include "decode/sequential.glsl"
#include "regions/classify.glsl"
#include "compute/groups.glsl"

layout(std430, binding = 5) buffer Answers { uint answers[]; };
layout(std430, binding = 7) buffer Lists { uint counts[2]; uint lists[]; };  // the second one starts at batch_size

const uint CLASSIFY = 0u, SIFT = 1u, DECODE = 2u;

uniform uint stage;

uniform uint batch_first;
uniform uint batch_size;   // fiblets from batch_first on
uniform float sampling;  // mm; 0: points alone

const uint INSIDE = 1u, OUTSIDE = 2u, UNSURE = 4u, FIRST_INSIDE = 8u, FIRST_UNSURE = 16u, LAST_INSIDE = 32u, LAST_UNSURE = 64u;
const uint SETTLED = INSIDE | OUTSIDE;
const float EPSILON = 1.1920929e-7;
const float SAMPLES = 1024.0;

uint place_of(int side) { return side > 0 ? INSIDE : side < 0 ? OUTSIDE : UNSURE; }

// How far point i of the walk may lie from where float64 has it (mm). The anchor has three roundings, every addition to it
// half a unit of the last place; each product of frames turns all that follows by a few units (4 i (i + 1) in all, taken
// three times); exp2() of the lattice's edge may err by 40 units.
float walk_margin(uint i) {
    float n = float(i), run, drift;
    if (walk.kind == KIND_DIRECTION) {
        run = n * walk.step;
        drift = 12.0 * (n + 1.0) * run;
    } else {
        run = distance(walk_point, walk_anchor);
        drift = 40.0 * run;
    }
    return EPSILON * ((n + 8.0) * (length(walk_anchor) + run) + drift);
}

// Positions on a segment, its ends left out; `margin` is that of its ends.
uint between(vec3 a, vec3 b, float margin) {
    int whole = region_of_capsule(a, b, margin);
    if (whole != 0) return place_of(whole);
    float share = distance(a, b) / sampling, slack = 2.0 * margin / sampling + 1.0e-5 * share;
    float pieces = ceil(share - slack);
    if (!(pieces == ceil(share + slack) && pieces <= SAMPLES)) return UNSURE;
    float wider = margin + 8.0 * EPSILON * (length(a) + length(b));
    uint found = 0u;
    for (float k = 1.0; k < pieces && found != (SETTLED | UNSURE); k += 1.0) {
        found |= place_of(region_of_ball(mix(a, b, k / pieces), wider));
    }
    return found;
}

uint decoded_answer(uint f, uint known) {
    bool first = begins(f), last = ends(f), settled = (known & SETTLED) == SETTLED;
    walk_begin(f);
    uint found = 0u;
    float margin = 0.0;
    for (uint i = 0u; i <= walk.last; ++i) {
        vec3 before = walk_point;
        float margin_before = margin;
        if (i > 0u) walk_next(i);
        bool at_first = first && i == 0u, at_last = last && i == walk.last;
        if (settled && !at_first && !at_last) {
            if (last) continue;
            break;
        }
        margin = walk_margin(i);
        int side = region_of_ball(walk_point, margin);
        found |= place_of(side);
        if (at_first) found |= side > 0 ? FIRST_INSIDE : side == 0 ? FIRST_UNSURE : 0u;
        if (at_last) found |= side > 0 ? LAST_INSIDE : side == 0 ? LAST_UNSURE : 0u;
        if (sampling > 0.0 && i > 0u && !settled) found |= between(before, walk_point, max(margin, margin_before));
        settled = ((known | found) & SETTLED) == SETTLED;
    }
    if (sampling > 0.0 && !settled && !last) {
        vec3 next = anchor_local(f + 1u);
        found |= between(walk_point, next, max(margin, 8.0 * EPSILON * length(next)));
    }
    return found;
}

void main() {
    uint slot = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (slot >= (stage == CLASSIFY ? batch_size : counts[stage - 1u])) return;
    uint f = batch_first + slot;
    if (stage == SIFT) f = lists[slot];
    if (stage == DECODE) f = lists[batch_size + slot];
    uint rank = rank_of(f) - chunk_bases.x, shift = 8u * (rank & 3u);
    uint known = (answers[rank >> 2] >> shift) & 255u, found = 0u;
    if (stage == CLASSIFY) {
        Capsule c = capsule_of(f);
        int side = region_of_capsule(c.a, c.b, c.r);
        if (side == 0) lists[atomicAdd(counts[0], 1u)] = f;
        else found = side < 0 ? OUTSIDE : INSIDE | (begins(f) ? FIRST_INSIDE : 0u) | (ends(f) ? LAST_INSIDE : 0u);
    } else if (stage == SIFT) {
        if ((known & SETTLED) != SETTLED || begins(f) || ends(f)) lists[batch_size + atomicAdd(counts[1], 1u)] = f;
    } else {
        found = decoded_answer(f, known);
    }
    if ((found & ~known) != 0u) atomicOr(answers[rank >> 2], found << shift);
}
