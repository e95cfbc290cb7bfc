// Two-phase culling of spline tubes: lists the segments to draw. The first round lists those that the last picture showed; the
// second, of the others, those that the depth of the first does not hide (culling/hidden.glsl says why nothing is lost).
//
// Symbols
//   m            farthest depth in the squares of pixels that a half's rectangle touches
//   h(p)         Z - m W: positive behind depth m. A half-space that holds the balls around its control points holds their hull,
//                and so the half
//
// One invocation per segment.

#version 430
layout(local_size_x = 64) in;

#include "tubes/segment.glsl"
#include "tubes/ray.glsl"
#include "tubes/bounds.glsl"
#include "culling/pyramid_lookup.glsl"
#include "frame/groups.glsl"

layout(std430, binding = {{ items_seen }}) readonly buffer SeenBits { uint seen[]; };
layout(std430, binding = {{ items_listed }}) writeonly buffer Listed { uint listed[]; };
layout(std430, binding = {{ items_counts }}) buffer Counts { uint counts[]; };      // how many are listed

uniform int second_round;

const float ROUNDING = 1e-6;

// Whether the hull of three balls is behind what is drawn. Its rectangle has its sides along the window's: squares have too.
bool half_hidden(Bounds box, int first_ball) {
    vec4 middle = 0.5 * (box.balls[1] + box.balls[2]);
    vec4 balls[3] = vec4[3](box.balls[first_ball], box.balls[first_ball + 1], middle);
    vec2 low = vec2(3e38), high = vec2(-3e38);
    vec4 seen[3];
    for (int k = 0; k < 3; ++k) {
        seen[k] = to_homogeneous(balls[k].xyz);
        vec2 at = seen[k].xy / seen[k].w;
        vec2 reach = balls[k].w / (seen[k].w - balls[k].w * tube_w_reach)
            * vec2(length(window_gradient(0) - at.x * window_gradient(3)), length(window_gradient(1) - at.y * window_gradient(3)));
        low = min(low, at - reach);
        high = max(high, at + reach);
    }
    ivec2 first = ivec2(clamp(low - 0.6, vec2(0.0), viewport - 1.0)), last = ivec2(clamp(high + 0.6, vec2(0.0), viewport - 1.0));
    float m = farthest_in(first, last);
    if (m > 1.0) return false;
    float steep = length(window_gradient(2) - m * window_gradient(3)), terms = abs(window_from_local[3].z) + abs(window_from_local[3].w);
    for (int k = 0; k < 3; ++k) {
        float slack = ROUNDING * (dot(abs(window_gradient(2)) + abs(window_gradient(3)), abs(balls[k].xyz) + balls[k].w) + terms);
        if (seen[k].z - m * seen[k].w <= balls[k].w * steep + slack) return false;
    }
    return true;
}

bool is_hidden(Bounds box) {
    if (box.least <= 1e-4 * abs(box.seen[0].w)) return false;      // beside the eye
    return half_hidden(box, 0) && half_hidden(box, 2);
}

void main() {
    uint index = group_index() * 64u + gl_LocalInvocationIndex;
    if (index >= uint(tube_segments)) return;
    bool early = (seen[index >> 5u] >> (index & 31u) & 1u) != 0u;
    if (early == (second_round != 0)) return;
    Segment s = segment_of(int(index));
    Bounds box;
    if (!bounds_of(s, box)) return;
    if (second_round != 0 && is_hidden(box)) return;
    listed[atomicAdd(counts[0], 1u)] = index;
}
