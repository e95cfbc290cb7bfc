// Projection of local millimetres to pixels, and the part of a segment in the view volume.
//
// Symbols
//   c            homogeneous window coordinates (X, Y, Z, W), see frame/blocks.glsl
//   s            window: x, y in pixels with the lower left corner at (0, 0); z is the depth in 0..1; w is W
//   volume       -h W <= X <= (width + h) W, likewise Y, and 0 <= Z <= W: the caller's view volume, widened by half a
//                line's width h
//
// A point in the volume has W > 0, or it is the centre of projection itself, which to_window() keeps finite.

#include "frame/blocks.glsl"

vec4 to_homogeneous(vec3 p) {
    precise vec4 c = window_from_local[0] * p.x + window_from_local[1] * p.y + window_from_local[2] * p.z
                   + window_from_local[3];
    return c;
}

// Signed distances, times something positive, from the three lower and from the three upper planes of the volume.
vec3 above_lower(vec4 c) {
    precise vec3 d = c.xyz + vec3(vec2(half_line_width), 0.0) * c.w;
    return d;
}

vec3 below_upper(vec4 c) {
    precise vec3 d = vec3(viewport + half_line_width, 1.0) * c.w - c.xyz;
    return d;
}

bool in_volume(vec4 c) {
    return all(greaterThanEqual(above_lower(c), vec3(0.0))) && all(greaterThanEqual(below_upper(c), vec3(0.0)));
}

vec4 to_window(vec4 c) {
    precise float r = 1.0 / max(c.w, 1e-30);
    precise vec4 window = vec4(c.xyz * r, c.w);
    return window;
}

// Liang and Barsky's clipping in homogeneous coordinates: narrows t to the part of the segment inside the volume.
bool clip_segment(vec4 a, vec4 b, out float t0, out float t1) {
    t0 = 0.0;
    t1 = 1.0;
    vec3 a_low = above_lower(a), a_high = below_upper(a), b_low = above_lower(b), b_high = below_upper(b);
    for (int side = 0; side < 6; ++side) {
        int axis = side >> 1;
        float da = (side & 1) == 0 ? a_low[axis] : a_high[axis], db = (side & 1) == 0 ? b_low[axis] : b_high[axis];
        if (da < 0.0 && db < 0.0) return false;
        precise float t = da / (da - db);
        if (da < 0.0) t0 = max(t0, t);
        else if (db < 0.0) t1 = min(t1, t);
    }
    return t0 <= t1;
}

// The same for a segment in front of the camera, in the window and against its four edges only.
bool clip_window(vec2 a, vec2 b, out float t0, out float t1) {
    vec2 margin = vec2(half_line_width), run = b - a;
    precise vec2 inverse = 1.0 / mix(run, vec2(1e-20), equal(run, vec2(0.0)));
    precise vec2 low = (-margin - a) * inverse, high = (viewport + margin - a) * inverse;
    vec2 enter = min(low, high), leave = max(low, high);
    t0 = clamp(max(enter.x, enter.y), 0.0, 1.0);
    t1 = clamp(min(leave.x, leave.y), 0.0, 1.0);
    return max(enter.x, enter.y) <= min(leave.x, leave.y) && min(leave.x, leave.y) >= 0.0 && max(enter.x, enter.y) <= 1.0;
}

// Window depth as the G-buffer's fixed-point key. 2^32 (1 - 2^-23) is the largest drawn; all ones means empty.
uint depth_key(float z) { return uint(int(clamp(z, 0.0, 0.99999988) * 2147483648.0)) << 1u; }

// Thin lines run from pixel centre to pixel centre, moved by this: see fiblets/segments/thin_line_rule.glsl.
const vec2 CELL_SHIFT = vec2(23.0, 23.0) / 256.0;
