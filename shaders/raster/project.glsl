// From local millimetres to pixels, and the part of a segment that the view volume holds.
//
// Symbols
//   c            clip coordinates (x, y, z, w)
//   s            window: x, y in pixels with the lower left corner at (0, 0); z is the depth in 0..1; w is clip w
//   volume       |x| <= guard.x w, |y| <= guard.y w, |z| <= w: the caller's view volume, widened by half a line's width
//
// A point in the volume has w > 0, or it is the centre of projection itself, which to_window() keeps finite.

#include "frame/blocks.glsl"

vec4 to_clip(vec3 p) {
    precise vec4 c = clip_from_local[0] * p.x + clip_from_local[1] * p.y + clip_from_local[2] * p.z + clip_from_local[3];
    return c;
}

bool in_volume(vec4 c) { return all(lessThanEqual(abs(c.xyz), vec3(guard.xy, 1.0) * c.w)); }

vec4 to_window(vec4 c) {
    precise float r = 1.0 / max(c.w, 1e-30);
    precise vec3 s = c.xyz * r * 0.5 + 0.5;
    precise vec4 window = vec4(s.xy * viewport.xy, s.z, c.w);
    return window;
}

// Liang and Barsky's clipping in homogeneous coordinates: narrows t to the part of the segment inside the volume.
bool clip_segment(vec4 a, vec4 b, out float t0, out float t1) {
    t0 = 0.0;
    t1 = 1.0;
    vec3 g = vec3(guard.xy, 1.0);
    for (int side = 0; side < 6; ++side) {
        int axis = side >> 1;
        float s = (side & 1) == 0 ? 1.0 : -1.0;
        precise float da = g[axis] * a.w + s * a[axis], db = g[axis] * b.w + s * b[axis];
        if (da < 0.0 && db < 0.0) return false;
        if (da < 0.0) t0 = max(t0, da / (da - db));
        else if (db < 0.0) t1 = min(t1, da / (da - db));
    }
    return t0 <= t1;
}

// The same for a segment in front of the camera, in the window and against its four edges only.
bool clip_window(vec2 a, vec2 b, out float t0, out float t1) {
    vec2 margin = vec2(viewport.z), run = b - a;
    precise vec2 inverse = 1.0 / mix(run, vec2(1e-20), equal(run, vec2(0.0)));
    precise vec2 low = (-margin - a) * inverse, high = (viewport.xy + margin - a) * inverse;
    vec2 enter = min(low, high), leave = max(low, high);
    t0 = clamp(max(enter.x, enter.y), 0.0, 1.0);
    t1 = clamp(min(leave.x, leave.y), 0.0, 1.0);
    return max(enter.x, enter.y) <= min(leave.x, leave.y) && min(leave.x, leave.y) >= 0.0 && max(enter.x, enter.y) <= 1.0;
}

// Window depth as the G-buffer's fixed-point key. 2^32 (1 - 2^-23) is the largest drawn; all ones means empty.
uint depth_key(float z) { return uint(int(clamp(z, 0.0, 0.99999988) * 2147483648.0)) << 1u; }
