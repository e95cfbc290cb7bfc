// The ray of a pixel, beside the segment that it is tested against.
//
// Symbols
//   d            its direction, a unit vector away from the eye
//   o            its point next to the segment's centre, relative to that, over the segment's size
//   l            position along it from o, in sizes
//   D, E         see frame/tubes.glsl
//
// Where the centre shows in the window the ray goes through, beside it, as many pixels away as the pixel is: float32 then
// rounds relative to the segment and not to its distance from the eye. Where the centre lies beside or behind the eye, the
// eye itself is near.

#include "frame/blocks.glsl"

struct Ray {
    vec3 o;
    vec3 d;
    vec2 depth;     // of the point o: homogeneous Z and W
    vec2 rise;      // of both by l
};

vec3 window_row(int row) {
    return vec3(window_from_local[0][row], window_from_local[1][row], window_from_local[2][row]);
}

Ray ray_through(vec2 pixel, vec3 centre, float size, vec4 seen) {
    precise vec3 way = tube_ray.xyz + tube.w * (pixel.x * tube_ray_x.xyz + pixel.y * tube_ray_y.xyz);
    precise vec3 d = way / max(length(way), 1e-30);
    float w = seen.w;
    precise vec3 o;
    if (tube.w > 0.0 && w < 0.25 * size * tube.y) {
        o = (tube_eye.xyz - centre) / size;
    } else {
        vec2 off = pixel - seen.xy;
        o = w / size * (off.x * tube_ray_x.xyz + off.y * tube_ray_y.xyz);
    }
    precise vec3 next = o - dot(o, d) * d;
    vec3 z_row = window_row(2) * size, w_row = window_row(3) * size;
    return Ray(next, d, vec2(seen.z + dot(z_row, next), seen.w + dot(w_row, next)), vec2(dot(z_row, d), dot(w_row, d)));
}

// Window coordinates of a segment's centre: pixels (where it is in front of the eye), then homogeneous Z and W.
vec4 seen_centre(vec3 p) {
    precise vec4 c = window_from_local[0] * p.x + window_from_local[1] * p.y + window_from_local[2] * p.z
                   + window_from_local[3];
    precise float r = 1.0 / max(c.w, 1e-30);
    return vec4(c.xy * r, c.zw);
}

float depth_along(Ray ray, float l) {
    precise vec2 at = ray.depth + l * ray.rise;
    precise float depth = at.x / max(at.y, 1e-30);
    return depth;
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
