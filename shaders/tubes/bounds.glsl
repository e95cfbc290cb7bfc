// Where in the window a segment of a spline tube can be: a rectangle around the balls around its control points.
//
// A tube lies in the hull of those balls: curves do in the hull of their control points, and radii lie between theirs. A ball
// of radius r around p reaches r |J| / (W - r |grad W|) pixels from the pixel of p at most (fiblets/segments/line_tube.glsl has J). The
// rectangle holds all four; its long side runs from the first to the last.
//
// Next to the eye, where that says little: the box of all balls in X, Y and W, cut off at W of the near plane.

#include "frame/pixel_derivative.glsl"

struct Bounds {
    vec2 start;         // a point of the window, and the direction of the long side
    vec2 along;
    vec2 low;           // from there, along it and across
    vec2 high;
    vec2 middle;        // of the rectangle, and how far it reaches in x and y
    vec2 reach;
    float least;        // W of the nearest ball's near end
    vec4 balls[4];      // local mm
    vec4 seen[4];       // homogeneous window coordinates of their middles
};

vec2 turned(vec2 v) { return vec2(-v.y, v.x); }

// False where nothing of it shows.
bool bounds_of(Segment s, out Bounds box) {
    box.balls = vec4[4](s.a1, s.a2, s.b2, s.b3);
    float slope = tube_w_reach, most = -3e38;
    box.least = 3e38;
    for (int k = 0; k < 4; ++k) {
        box.balls[k] = vec4(s.centre, 0.0) + s.size * box.balls[k];
        box.seen[k] = to_homogeneous(box.balls[k].xyz);
        box.least = min(box.least, box.seen[k].w - box.balls[k].w * slope);
        most = max(most, box.seen[k].w + box.balls[k].w * slope);
    }
    box.low = vec2(3e38);
    box.high = vec2(-3e38);
    box.along = vec2(1.0, 0.0);
    box.start = vec2(0.0);
    if (most < tube_near_w || most <= 0.0) return false;
    if (box.least > max(0.25 * tube_near_w, 1e-4 * most)) {
        box.start = box.seen[0].xy / box.seen[0].w;
        vec2 run = box.seen[3].xy / box.seen[3].w - box.start;
        float size = length(run);
        if (size > 1.0 && size < 1e5) box.along = run / size;
        for (int k = 0; k < 4; ++k) {
            vec2 at = box.seen[k].xy / box.seen[k].w, off = at - box.start;
            float reach = box.balls[k].w * pixel_derivative_at(at) / (box.seen[k].w - box.balls[k].w * slope) + 0.01 + 1e-6 * length(at);
            vec2 place = vec2(dot(off, box.along), dot(off, turned(box.along)));
            box.low = min(box.low, place - reach);
            box.high = max(box.high, place + reach);
        }
    } else {
        vec2 sides = vec2(length(window_gradient(0)), length(window_gradient(1))), low = box.low, high = box.high;
        for (int k = 0; k < 4; ++k) {
            low = min(low, box.seen[k].xy - box.balls[k].w * sides);
            high = max(high, box.seen[k].xy + box.balls[k].w * sides);
        }
        vec2 near = vec2(max(box.least, tube_near_w)), far = vec2(most);
        if (near.x <= 0.0) {
            low = vec2(0.0);
            high = viewport;
        } else {
            vec2 first = low / mix(near, far, greaterThanEqual(low, vec2(0.0)));
            high = high / mix(far, near, greaterThanEqual(high, vec2(0.0)));
            low = first;
        }
        box.low = clamp(low, vec2(-8.0), viewport + 8.0);
        box.high = clamp(high, vec2(-8.0), viewport + 8.0);
    }
    vec2 centre = 0.5 * (box.low + box.high), half_size = 0.5 * (box.high - box.low);
    box.middle = box.start + centre.x * box.along + centre.y * turned(box.along);
    box.reach = abs(half_size.x * box.along) + abs(half_size.y * turned(box.along));
    return all(lessThan(box.middle - box.reach, viewport)) && all(greaterThan(box.middle + box.reach, vec2(0.0)));
}
