// Tubes: a segment is a capsule, all points no farther than r from it, and a pixel shows where the ray through its centre
// enters that body. Exact, for perspective and for parallel views: no quadric is projected and no depth is interpolated.
//
//            ________________              The half sphere at a segment's start is left out where another segment ends: it is
//     ray  /t_in            _\ t_out        that one's. The tube of a streamline is the union of its segments', and pixels of
//   o----->*---------------/--*             several keep the nearest: joints are round and closed, and tubes cut into each
//         |a ...... u ......b |             other as bodies.
//          \________________/
//
// Symbols
//   a, b, u      ends of the axis; its unit vector, none for a single point; all relative to a, local mm
//   o, d         the ray: o is its point in the plane W of a, next to a, so that float32 loses nothing to the
//                distance from the camera; d is its unit vector, away from the eye. Where a is beside or behind the eye, o is the eye
//   o', d'       parts perpendicular to u
//   y            where on the axis, mm from a
//
// Algorithm
//   1. Infinite cylinder: the ray comes nearest to the axis at t = -o'.d' / d'.d', and is within r of it for
//      sqrt((r^2 - |o' + t d'|^2) / d'.d') before and after.
//   2. Where it enters, or leaves, beyond an end, it does so through that end's sphere, or not at all: a capsule is convex.
//   3. Planes of the caller's narrow the range from t_in to t_out. What they cut is closed: the cut shows as a flat disc.
//      What the near plane cuts is left open: one looks through it.
//
// What a region cuts (FEATURE_CLIP_REGION) is left open, too: a ray may begin within the tube. So a half sphere shows only where no
// other segment is: of its points those are within the next one that lie on the side to which that runs.
//
// A tube thinner than a pixel would be hit by few rays. Pixels at most half_line_width away from the axis belong to it too, as to
// a line of twice that width (a pixel of the finished picture); where no ray hits, they show the axis.
//
// Outline: which pixels are tested. A ball of radius r around p reaches |J v| / (W + grad W . v), |v| <= r, pixels away from
// the pixel of p, where J = (grad X - x grad W, grad Y - y grad W): no more than r |J| / (W - r |grad W|), nor than
// r |J| / W_near for the part of it that can show. |J| is convex along the axis, so that the larger of both ends' serves.
// Next to the eye, where that says little: a box around the capsule in X, Y and W, from W_near on.

#include "frame/pixel_derivative.glsl"
#include "frame/clip_planes.glsl"

struct Outline {
    vec4 a;        // ends of the part of the axis that may show: window x, y; depth; W
    vec4 b;
    float t0;      // where on the segment they lie
    float t1;
    float reach;   // pixels away from that part
    bool thin;     // may be thinner than 2 half_line_width
};

struct Tube {
    vec3 a;
    vec3 axis;     // u
    float size;    // |b - a|
    vec4 from;     // a: window x, y; depth; W
    bool start;    // the half sphere at a is this segment's
    bool cap;      // the line ends at b
    bool beside;   // a is not in front of the eye
#if FEATURE_CLIP_REGION
    vec3 ahead;    // unit vector of the next segment; none where nothing follows
#endif
};

// The hit of a pixel.
struct Hit {
    float z;       // depth
    float t;       // position along the segment
    vec3 normal;   // unit vector, local mm
    bool side;     // that of the body's side, where the line goes on; not of a cut, nor of the line's round ends
};

// A chain of capsules bends at its joints, the line does not: a normal of its side is turned to be perpendicular to the line's
// tangent (fiblets/attributes/tangent.glsl), which is continuous, and so are lights on it. Depth stays that of the capsules. On
// the outer side of the sharpest bends normals nearly point along the tangent, and are left where they are.
vec3 smooth_normal(Hit hit, vec3 tangent) {
    vec3 t = normalize(tangent);
    float along = dot(t, hit.normal), share = clamp((1.0 - along * along - 0.1) / 0.3, 0.0, 1.0);
    return hit.side ? normalize(hit.normal - share * along * t) : hit.normal;
}

const float OUTLINE_ROUNDING = 0.05;

// What a box around the part of a tube between a and b takes of the window; false if nothing.
bool box_of(vec4 a, vec4 b, out Outline outline) {
    vec2 size = tube_radius * vec2(length(window_gradient(0)), length(window_gradient(1)));
    vec2 low = min(a.xy, b.xy) - size, high = max(a.xy, b.xy) + size, first = vec2(0.0), last = viewport;
    vec2 near = vec2(tube_near_w), far = vec2(max(max(a.w, b.w) + tube_w_reach, tube_near_w));
    if (tube_near_w > 0.0) {
        first = low / mix(near, far, greaterThanEqual(low, vec2(0.0)));
        last = high / mix(far, near, greaterThanEqual(high, vec2(0.0)));
    }
    bool any_part = all(lessThanEqual(first, viewport)) && all(greaterThanEqual(last, vec2(0.0)));
    first = clamp(first, vec2(0.0), viewport);
    last = clamp(last, vec2(0.0), viewport);
    vec4 middle = vec4(0.5 * (first + last), 0.0, 1.0);
    outline = Outline(middle, middle, 0.0, 1.0, 0.5 * distance(first, last) + 1.0, false);
    return any_part;
}

// False if nothing of the tube can show. c0, c1: homogeneous window coordinates of both ends.
bool outline_of(vec4 c0, vec4 c1, out Outline outline) {
    float low = min(c0.w, c1.w), high = max(c0.w, c1.w), nearest = tube_near_w - tube_w_reach, t0 = 0.0, t1 = 1.0;
    vec4 a = c0, b = c1;
    outline = Outline(a, b, t0, t1, 0.0, false);
    if (high < nearest) return false;
    if (low < nearest) {
        float t = clamp((nearest - c0.w) / (c1.w - c0.w), 0.0, 1.0);
        vec4 cut = mix(c0, c1, t);
        cut.w = nearest;
        if (c0.w < c1.w) { a = cut; t0 = t; }
        else { b = cut; t1 = t; }
    }
    float close = max(min(a.w, b.w) - tube_w_reach, tube_near_w);
    if (min(a.w, b.w) <= max(0.25 * max(tube_w_reach, tube_near_w), 1e-30) || close <= 0.0) return box_of(a, b, outline);
    vec4 c = a, d = b;
    a = to_window(a);
    b = to_window(b);
    float at_a = tube_radius * pixel_derivative_at(a.xy), at_b = tube_radius * pixel_derivative_at(b.xy);
    float reach = max(max(at_a, at_b) / close, half_line_width) + OUTLINE_ROUNDING + 1e-5 * (length(a.xy) + length(b.xy));
    if (!(reach < viewport.x + viewport.y)) return box_of(c, d, outline);
    vec2 least = min(a.xy, b.xy) - reach, most = max(a.xy, b.xy) + reach;
    if (any(greaterThan(least, viewport)) || any(lessThan(most, vec2(0.0)))) return false;
    outline = Outline(a, b, t0, t1, reach, min(at_a, at_b) < 2.0 * half_line_width * max(a.w, b.w));
    return true;
}

// Of the radius: so near to the joint a half sphere lies within a thousandth of it of the next segment's side, and rounding must not
// part them.
const float WITHIN = 0.05;

// ahead: the next segment's run, mm; none where nothing follows.
Tube tube_of(vec3 a, vec3 b, vec4 c0, bool start, bool cap, vec3 ahead) {
    precise vec3 run = b - a;
    precise float size = length(run);
    Tube t;
    t.a = a;
    t.axis = size > 0.0 ? run / size : vec3(0.0);
    t.size = size;
    t.from = to_window(c0);
    t.start = start;
    t.cap = cap;
    t.beside = c0.w < max(0.25 * tube_w_reach, 1e-30);
#if FEATURE_CLIP_REGION
    t.ahead = ahead / max(length(ahead), 1e-30);
#endif
    return t;
}

vec2 sphere_range(vec3 o, vec3 d) {
    precise float middle = -dot(o, d);
    precise vec3 away = o + middle * d;
    precise float h = tube_radius * tube_radius - dot(away, away);
    if (h < 0.0) return vec2(3.0e38, -3.0e38);
    precise float s = sqrt(h);
    return vec2(middle - s, middle + s);
}

// Depth of a point v away from a.
float depth_at(Tube t, vec4 c0, vec3 v) {
    precise float z = c0.z + dot(window_gradient(2), v), w = c0.w + dot(window_gradient(3), v);
    precise float depth = z / max(w, 1e-30);
    return depth;
}

bool body_at(Tube t, vec4 c0, vec2 pixel, out Hit hit) {
    hit = Hit(0.0, 0.0, vec3(0.0), false);
    vec2 off = pixel - t.from.xy;
    precise vec3 way = tube_ray + tube_perspective * (pixel.x * tube_ray_x + pixel.y * tube_ray_y);
    precise vec3 d = way / max(length(way), 1e-30);
    precise vec3 o = t.from.w * (off.x * tube_ray_x + off.y * tube_ray_y);
    if (t.beside) o = tube_eye - t.a;
    precise float ou = dot(o, t.axis), du = dot(d, t.axis);
    precise vec3 op = o - ou * t.axis, dp = d - du * t.axis;
    precise float dd = max(dot(dp, dp), 1e-12), middle = -dot(op, dp) / dd;
    precise vec3 away = op + middle * dp;
    precise float h = tube_radius * tube_radius - dot(away, away);
    if (h < 0.0) return false;
    precise float s = sqrt(h / dd), first = middle - s, last = middle + s;
    precise float y0 = ou + first * du, y1 = ou + last * du;
    if (y0 < 0.0) {
#if !FEATURE_CLIP_PLANES
        if (!t.start) return false;
#endif
        first = sphere_range(o, d).x;
    } else if (y0 > t.size) {
        first = sphere_range(o - t.size * t.axis, d).x;
    }
    if (first > 1e38) return false;
    if (y1 < 0.0) last = sphere_range(o, d).y;
    else if (y1 > t.size) last = sphere_range(o - t.size * t.axis, d).y;
    vec3 face = vec3(0.0);
#if FEATURE_CLIP_PLANES
    for (int plane = 0; plane < clip_plane_count; ++plane) {
        precise float height = clip_height_of(plane, t.a) + dot(clip_planes[plane].xyz, o);
        float rise = dot(clip_planes[plane].xyz, d);
        if (abs(rise) < 1e-9) {
            if (height < 0.0) return false;
        } else if (rise > 0.0) {
            precise float enter = -height / rise;
            if (enter > first) { first = enter; face = -clip_planes[plane].xyz; }
        } else {
            last = min(last, -height / rise);
        }
    }
    if (first > last) return false;
#endif
    precise vec3 v = o + first * d;
    if (c0.w + dot(window_gradient(3), v) <= 0.0) return false;
    hit.z = depth_at(t, c0, v);
    if (!(hit.z >= 0.0 && hit.z <= 1.0)) return false;
    precise float y = dot(v, t.axis);
#if FEATURE_CLIP_PLANES
    if (y < 0.0 && !t.start) return false;  // only now: a plane may have cut the ball off, and the tube behind it shows
#endif
#if FEATURE_CLIP_REGION
    if (face == vec3(0.0) && y > t.size && dot(v - t.size * t.axis, t.ahead) > WITHIN * tube_radius) return false;
#endif
    hit.side = face == vec3(0.0) && t.size > 0.0 && (y >= 0.0 || !t.start) && (y <= t.size || !t.cap);
    y = clamp(y, 0.0, t.size);
    hit.t = y < t.size ? y / t.size : float(t.size > 0.0);      // exactly 1 at the end, which cards that divide by reciprocals miss
    hit.normal = face != vec3(0.0) ? face : normalize(v - y * t.axis);
    return true;
}

// A pixel that no ray makes part of a thin tube, but half a pixel's distance from its axis does.
bool brush_at(Tube t, Outline outline, vec2 pixel, out Hit hit) {
    hit = Hit(0.0, 0.0, vec3(0.0), false);
    vec2 run = outline.b.xy - outline.a.xy, centre = pixel - outline.a.xy;
    float foot = dot(centre, run) / max(dot(run, run), 1e-12);
    precise float s = clamp(foot, 0.0, 1.0);
    vec2 away = centre - s * run;
    if (foot < 0.0 && !t.start && outline.t0 == 0.0 || dot(away, away) > half_line_width * half_line_width) return false;
    precise float z = outline.a.z + (outline.b.z - outline.a.z) * s;
    if (!(z >= 0.0 && z <= 1.0)) return false;
    precise float u = s < 1.0 ? clamp(s * outline.a.w / max((1.0 - s) * outline.b.w + s * outline.a.w, 1e-30), 0.0, 1.0) : 1.0;
    hit.z = z;
    hit.t = mix(outline.t0, outline.t1, u);
#if FEATURE_CLIP_PLANES
    if (clip_height(t.a + hit.t * t.size * t.axis) < 0.0) return false;
#endif
    vec3 d = normalize(tube_ray + tube_perspective * (pixel.x * tube_ray_x + pixel.y * tube_ray_y));
    vec3 n = dot(d, t.axis) * t.axis - d;
    hit.normal = dot(n, n) > 1e-6 ? normalize(n) : -d;
    return true;
}

// What the pixel with that centre shows of a tube.
bool tube_at(Tube t, vec4 c0, Outline outline, vec2 pixel, out Hit hit) {
    if (body_at(t, c0, pixel, hit)) return true;
    return outline.thin && brush_at(t, outline, pixel, hit);
}

// The same where the outline is not known yet: c1, homogeneous window coordinates of the segment's end.
bool tube_found(Tube t, vec4 c0, vec4 c1, vec2 pixel, out Hit hit) {
    if (body_at(t, c0, pixel, hit)) return true;
    Outline outline;
    return outline_of(c0, c1, outline) && outline.thin && brush_at(t, outline, pixel, hit);
}
