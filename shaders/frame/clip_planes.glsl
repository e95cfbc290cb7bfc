// Planes of the caller's; pvfiblets/engine/clipping.py declares and packs them. Without the feature there are none.
//
// Symbols
//   plane        (n, d) with |n| = 1 per local millimetre; h(p) = n . p + d is the height of p, kept where h >= 0
//   tilt         gradient of h / w by pixel of the window, at constant depth: by how much h / w differs between a point
//                of a line and a pixel of its brush, which lies beside that point in the plane of the screen

#if FEATURE_CLIP_PLANES
#include "uniforms/ClipPlanes.glsl"

float clip_height_of(int plane, vec3 p) {
    precise float h = dot(clip_planes[plane].xyz, p) + clip_planes[plane].w;
    return h;
}

// Height above the nearest plane, negative on the far side of any.
float clip_height(vec3 p) {
    float least = clip_height_of(0, p);
    for (int plane = 1; plane < clip_plane_count; ++plane) least = min(least, clip_height_of(plane, p));
    return least;
}

// Whether a line inside a sphere, its brush included, may reach across a plane.
bool clip_touches(vec3 centre, float radius) {
    float margin = radius + 2.0 * clip_rounding;
    float w = window_from_local[0].w * centre.x + window_from_local[1].w * centre.y + window_from_local[2].w * centre.z;
    w = max(w + window_from_local[3].w + radius * w_per_mm, 0.0);
    for (int plane = 0; plane < clip_plane_count; ++plane) {
        if (clip_height_of(plane, centre) < margin + w * clip_brushes[plane]) return true;
    }
    return false;
}

// Narrows t to the part of the segment on the kept side of all planes, as clip_segment() of frame/project.glsl does for
// the view volume.
bool clip_by_planes(vec3 a, vec3 b, inout float t0, inout float t1) {
    for (int plane = 0; plane < clip_plane_count; ++plane) {
        precise float ha = clip_height_of(plane, a), hb = clip_height_of(plane, b);
        if (ha < 0.0 && hb < 0.0) return false;
        precise float t = ha / (ha - hb);
        if (ha < 0.0) t0 = max(t0, t);
        else if (hb < 0.0) t1 = min(t1, t);
    }
    return t0 <= t1;
}

bool on_kept_side(vec3 p) { return clip_height(p) >= 0.0; }
#else
bool clip_by_planes(vec3 a, vec3 b, inout float t0, inout float t1) { return true; }
bool on_kept_side(vec3 p) { return true; }
#endif
