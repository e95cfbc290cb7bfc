// Asks of every streamline where it lies. Three passes over a batch of fiblets, one invocation each:
//   CLASSIFY     whole fiblets by their capsules. Those that this leaves undecided are listed. A streamline's first point is an
//                anchor; its last is no farther from the rounded end vector than the rounding (Capsule.slip), or must be decoded
//   SIFT         of those, list the ones whose streamline's answer is still open: not where it has points inside and points
//                outside by now, unless its last point is needed
//   DECODE       the points of these, until the streamline's answer is settled
// Lists keep neighbouring invocations busy alike.
//
// Points are tested as balls of the radius of float32's rounding (walk_margin). A point that remains undecided
// counts as unsure; where that matters to its streamline, pvfiblets/engine/fiblets/region_query.py has it settled in float64.
//
// With `lines`, the segments between points are tested too, as capsules of that radius: first whole, then in PIECES. A piece
// that this leaves undecided counts as unsure.
//
// A byte per streamline, by rank from the chunk's first; pvfiblets/engine/fiblets/region_query.py has the same bits.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "culling/bounds.glsl"
#include "fiblets/decode/sequential.glsl"
#include "regions/classify.glsl"
#include "frame/groups.glsl"

layout(std430, binding = {{ storage_answers }}) buffer Answers { uint answers[]; };
layout(std430, binding = {{ storage_lists }}) buffer Lists { uint counts[2]; uint lists[]; };  // the second one starts at batch_size; an entry may have the bit

const uint LAST_ASKED = 0x80000000u;  // a chunk has fewer fiblets
const uint CLASSIFY = 0u, SIFT = 1u, DECODE = 2u;

uniform uint stage;

uniform uint batch_first;
uniform uint batch_size;   // fiblets from batch_first on
uniform uint lines;  // 0: points alone

const uint INSIDE = 1u, OUTSIDE = 2u, UNSURE = 4u, FIRST_INSIDE = 8u, FIRST_UNSURE = 16u, LAST_INSIDE = 32u, LAST_UNSURE = 64u;
const uint SETTLED = INSIDE | OUTSIDE;
const float EPSILON = 1.1920929e-7;
const float PIECES = 8.0;

uint place_of(int side) { return side > 0 ? INSIDE : side < 0 ? OUTSIDE : UNSURE; }

// How far point i of the walk may lie from where float64 has it (mm). The anchor has three roundings, every addition to it
// half a unit of the last place; each product of frames turns all that follows by a few units (4 i (i + 1) in all, taken
// three times); exp2() of the lattice's edge may err by 40 units.
float walk_margin(uint i) {
    float n = float(i), run, drift;
    if (walk.kind == KIND_DIRECTION) {
        run = n * walk.step;
        drift = 12.0 * (n + 1.0) * run;
#if FEATURE_SPLINE
    } else if (walk.kind == KIND_SPLINE) {
        run = walk.path;
        drift = 160.0 * (run + walk.step);
#endif
    } else {
        run = distance(walk_point, walk_anchor);
        drift = 40.0 * run;
    }
    return EPSILON * ((n + 8.0) * (length(walk_anchor) + run) + drift);
}

// A segment whose ends do not settle it, in pieces; `margin` is that of its ends.
uint pieces(vec3 a, vec3 b, float margin) {
    float wider = margin + 8.0 * EPSILON * (length(a) + length(b));
    uint found = 0u;
    vec3 p = a;
    for (float k = 1.0; k <= PIECES && found != (SETTLED | UNSURE); k += 1.0) {
        vec3 q = mix(a, b, k / PIECES);
        found |= place_of(region_of_capsule(p, q, wider));
        p = q;
    }
    return found;
}

uint decoded_answer(uint f, bool last, uint known) {
    bool settled = (known & SETTLED) == SETTLED;
    walk_begin(f);
    uint found = 0u;
    float margin = 0.0;
    for (uint i = 0u; i <= walk.last; ++i) {  // the anchor was tested before, but its margin is needed
        vec3 before = walk_point;
        float margin_before = margin;
        if (i > 0u) walk_next(i);
        bool at_last = last && i == walk.last;
        if (settled && !at_last) {
            if (last) continue;
            break;
        }
        margin = walk_margin(i);
        if (i == 0u && !at_last) continue;
        bool joined = lines != 0u && i > 0u && !settled;
        float wider = max(margin, margin_before);
        int side = joined ? region_of_capsule(before, walk_point, wider) : 0;
        if (side == 0) {
            side = region_of_ball(walk_point, margin);
            if (joined) found |= pieces(before, walk_point, wider);
        }
        found |= place_of(side);
        if (at_last) found |= side > 0 ? LAST_INSIDE : side == 0 ? LAST_UNSURE : 0u;
        settled = ((known | found) & SETTLED) == SETTLED;
    }
    if (lines != 0u && !settled && !ends(f)) {
        vec3 next = anchor_local(f + 1u);
        float wider = max(margin, 8.0 * EPSILON * length(next));
        int side = region_of_capsule(walk_point, next, wider);
        found |= side != 0 ? place_of(side) : pieces(walk_point, next, wider);
    }
    return found;
}

void main() {
    uint slot = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (slot >= (stage == CLASSIFY ? batch_size : counts[stage - 1u])) return;
    uint f = stage == CLASSIFY ? batch_first + slot : lists[(stage == SIFT ? 0u : batch_size) + slot];
    bool last_asked = (f & LAST_ASKED) != 0u;
    f &= ~LAST_ASKED;
    uint rank = rank_of(f) - chunk_first_rank, shift = 8u * (rank & 3u);
    uint known = (answers[rank >> 2] >> shift) & 255u, found = 0u;
    bool open = (known & SETTLED) != SETTLED || last_asked;
    if (stage == CLASSIFY) {
        Capsule c = capsule_of(f);
        int side = region_of_capsule(c.a, c.b, c.r);
        bool first = begins(f), last = ends(f);
        if (side != 0) {
            found = side < 0 ? OUTSIDE : INSIDE | (first ? FIRST_INSIDE : 0u) | (last ? LAST_INSIDE : 0u);
        } else {
            float margin = 8.0 * EPSILON * (length(c.a) + length(c.b));
            side = region_of_ball(c.a, margin);
            found = place_of(side);
            if (first) found |= side > 0 ? FIRST_INSIDE : side == 0 ? FIRST_UNSURE : 0u;
            if (last && (side = region_of_ball(c.b, c.slip + margin)) != 0) {
                found |= place_of(side) | (side > 0 ? LAST_INSIDE : 0u);
                last = false;
            }
            lists[atomicAdd(counts[0], 1u)] = last ? f | LAST_ASKED : f;
        }
    } else if (stage == SIFT) {
        if (open) lists[batch_size + atomicAdd(counts[1], 1u)] = lists[slot];
    } else if (open) {
        found = decoded_answer(f, last_asked, known);
    }
    if ((found & ~known) != 0u) atomicOr(answers[rank >> 2], found << shift);
}
