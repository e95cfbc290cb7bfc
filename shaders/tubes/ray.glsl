// The ray of a pixel, beside the segment that it is tested against.
//
// Symbols
//   d            its direction, a unit vector away from the eye
//   o            its point next to the segment's centre, relative to that, over the segment's size
//   l            position along it from o, in sizes
//   D, E         see frame/tubes.glsl
//   U, W         see tubes/block.glsl
//
// Where the centre shows in the window the ray goes through, beside it, as many pixels away as the pixel is: float32 then
// rounds relative to the segment and not to its distance from the eye. Where the centre is in the window, and how deep, is
// found in float64 where OpenGL has it, and handed on in two parts. Where the centre lies beside or behind the eye, the eye
// itself is near.

#include "frame/blocks.glsl"

struct Ray {
    vec3 o;
    vec3 d;
    vec2 depth;     // of the point o: U and W
    vec2 shift;     // what o adds to those of the centre
    vec2 rise;      // of both by l
};

// The centre of a segment, as the camera sees it.
struct Seen {
    vec2 whole;     // pixel, and the part of one
    vec2 part;
    vec2 depth;     // U and W
};

Ray ray_through(vec2 pixel, vec3 centre, float size, Seen seen) {
    precise vec3 way = tube_ray + tube_perspective * (pixel.x * tube_ray_x + pixel.y * tube_ray_y);
    precise vec3 d = way / max(length(way), 1e-30);
    float w = seen.depth.y;
    precise vec3 o;
    if (tube_perspective > 0.0 && w < 0.25 * size * tube_w_reach) {
        o = (tube_eye - centre) / size;
    } else {
        precise vec2 off = (pixel - seen.whole) - seen.part;
        o = w / size * (off.x * tube_ray_x + off.y * tube_ray_y);
    }
    precise vec3 next = o - dot(o, d) * d;
    vec3 u_row = tube_window_rows[6].xyz * size, w_row = tube_window_rows[4].xyz * size;
    vec2 shift = vec2(dot(u_row, next), dot(w_row, next));
    return Ray(next, d, seen.depth + shift, shift, vec2(dot(u_row, d), dot(w_row, d)));
}

#if __VERSION__ >= 400
double row_at(int row, dvec3 p) {
    vec4 high = tube_window_rows[2 * row], low = tube_window_rows[2 * row + 1];
    return dot(dvec3(high.xyz) + dvec3(low.xyz), p) + (double(high.w) + double(low.w));
}

dvec3 exact_centre(Segment s) { return dvec3(s.place) * double(tube_place_scale) + dvec3(s.middle); }

Seen seen_centre(Segment s) {
    dvec3 p = exact_centre(s);
    double w = row_at(2, p), over = 1.0 / max(w, double(1e-30));
    dvec2 pixel = dvec2(row_at(0, p), row_at(1, p)) * over;
    vec2 whole = vec2(floor(clamp(pixel, dvec2(-1e7), dvec2(1e7))));
    return Seen(whole, vec2(pixel - dvec2(whole)), vec2(float(row_at(3, p)), float(w)));
}
#else
float row_at(int row, vec3 p) { return dot(tube_window_rows[2 * row].xyz, p) + tube_window_rows[2 * row].w; }

Seen seen_centre(Segment s) {
    float w = row_at(2, s.centre);
    vec2 pixel = vec2(row_at(0, s.centre), row_at(1, s.centre)) / max(w, 1e-30);
    return Seen(pixel, vec2(0.0), vec2(row_at(3, s.centre), w));
}
#endif

// 1 - depth.
float reversed_depth_along(Ray ray, float l) {
    precise vec2 at = ray.depth + l * ray.rise;
    precise float far = at.x / max(at.y, 1e-30);
    return far;
}

// Depth as a key of 32 bits (pvfiblets/engine/gbuffer.py): that of the centre, and how far from it l is: (dU - F dW) / W, F the
// centre's 1 - depth, which is small and has all of its digits.
uint key_along(Ray ray, Segment s, Seen seen, float l) {
    const float KEYS = 4294967296.0;
    float far = reversed_depth_along(ray, l);
    uint bits = uint(clamp(far * KEYS, 1.0, 4294967040.0));
#if __VERSION__ >= 400
    dvec3 p = exact_centre(s);
    double w = row_at(2, p), centre = row_at(3, p) / max(w, double(1e-30));
    precise vec2 off = ray.shift + l * ray.rise;
    precise float moved = (off.x - float(centre) * off.y) / max(seen.depth.y + off.y, 1e-30);
    if (w > 0.0 && abs(moved) < 0.25 && centre > 0.0 && centre < 1.0 && far > 1e-9 && far < 0.9999999) {
        bits = uint(centre * double(KEYS)) + uint(int(round(moved * KEYS)));      // a negative one wraps round, and back
    }
#endif
    return 0xFFFFFFFFu - bits;
}

// Narrows first..last to where start + l * rise is at least 0.
void narrow(float start, float rise, inout float first, inout float last) {
    if (abs(rise) <= 1e-30) {
        if (start < 0.0) last = -3e38;
    } else if (rise > 0.0) {
        first = max(first, -start / rise);
    } else {
        last = min(last, -start / rise);
    }
}
