// A rectangle of the window around each segment of a spline tube: four vertices, one for each corner, by an index buffer.
//
// A tube lies in the hull of the balls around its control points: those of curves within the hull of their control
// points, and radii between theirs. A ball of radius r around p reaches r |J| / (W - r |grad W|) pixels from the pixel of
// p at most (raster/tube.glsl has J). The rectangle holds all four; its long side runs from the first to the last.
//
// Next to the eye, where that says little: the box of all balls in X, Y and W, cut off at W of the near plane.

#version 430

#include "splines/hand_over.glsl"

uniform int first_segment;

// |J|, the largest stretch of a step in space to a step in the window, at W = 1.
float stretch_at(vec2 s) {
    vec3 w = window_row(3), x = window_row(0) - s.x * w, y = window_row(1) - s.y * w;
    float p = dot(x, x), q = dot(y, y), m = dot(x, y), half_difference = 0.5 * (p - q);
    return sqrt(0.5 * (p + q) + sqrt(half_difference * half_difference + m * m));
}

vec4 homogeneous(vec3 p) {
    return window_from_local[0] * p.x + window_from_local[1] * p.y + window_from_local[2] * p.z + window_from_local[3];
}

// A corner of the rectangle around four balls; false where nothing of it shows.
bool corner_of(Segment s, vec2 corner, out vec2 pixel) {
    vec4 balls[4] = vec4[4](s.a1, s.a2, s.b2, s.b3);
    vec4 seen[4];
    float slope = tube.y, least = 3e38, most = -3e38;
    pixel = vec2(0.0);
    for (int k = 0; k < 4; ++k) {
        balls[k] = vec4(s.centre, 0.0) + s.size * balls[k];
        seen[k] = homogeneous(balls[k].xyz);
        least = min(least, seen[k].w - balls[k].w * slope);
        most = max(most, seen[k].w + balls[k].w * slope);
    }
    if (most < tube.z || most <= 0.0) return false;
    vec2 low = vec2(3e38), high = vec2(-3e38), along = vec2(1.0, 0.0), start = vec2(0.0);
    if (least > max(0.25 * tube.z, 1e-4 * most)) {
        start = seen[0].xy / seen[0].w;
        vec2 run = seen[3].xy / seen[3].w - start;
        float size = length(run);
        if (size > 1.0 && size < 1e5) along = run / size;
        for (int k = 0; k < 4; ++k) {
            vec2 at = seen[k].xy / seen[k].w, off = at - start;
            float reach = balls[k].w * stretch_at(at) / (seen[k].w - balls[k].w * slope) + 0.01 + 1e-6 * length(at);
            vec2 place = vec2(dot(off, along), dot(off, vec2(-along.y, along.x)));
            low = min(low, place - reach);
            high = max(high, place + reach);
        }
    } else {
        vec2 sides = vec2(length(window_row(0)), length(window_row(1)));
        for (int k = 0; k < 4; ++k) {
            low = min(low, seen[k].xy - balls[k].w * sides);
            high = max(high, seen[k].xy + balls[k].w * sides);
        }
        vec2 near = vec2(max(least, tube.z)), far = vec2(most);
        if (near.x <= 0.0) {
            low = vec2(0.0);
            high = viewport.xy;
        } else {
            vec2 first = low / mix(near, far, greaterThanEqual(low, vec2(0.0)));
            high = high / mix(far, near, greaterThanEqual(high, vec2(0.0)));
            low = first;
        }
        low = clamp(low, vec2(-8.0), viewport.xy + 8.0);
        high = clamp(high, vec2(-8.0), viewport.xy + 8.0);
    }
    vec2 place = mix(low, high, corner);
    pixel = start + place.x * along + place.y * vec2(-along.y, along.x);
    vec2 middle = 0.5 * (low + high), half_size = 0.5 * (high - low);
    vec2 centre = start + middle.x * along + middle.y * vec2(-along.y, along.x);
    vec2 reach = abs(half_size.x * along) + abs(half_size.y * vec2(-along.y, along.x));
    return all(lessThan(centre - reach, viewport.xy)) && all(greaterThan(centre + reach, vec2(0.0)));
}

void main() {
    int index = first_segment + (gl_VertexID >> 2);
    vec2 pixel = vec2(0.0);
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
    handed_centre = handed_seen = handed_a1 = handed_a2 = handed_b2 = handed_b3 = vec4(0.0);
    handed_ids = uvec2(0u);
    if (index >= spline_counts.y) return;
    Segment s = segment_of(index);
    if (!has_turn(s) || !corner_of(s, vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1 & 1)), pixel)) return;
    hand_over(s, index, 3u);
    gl_Position = vec4(2.0 * pixel / viewport.xy - 1.0, 0.0, 1.0);
}
