// Whether a cluster may show: whether its box lies in the view volume, not wholly beyond the caller's planes or outside the caller's region,
// and not hidden behind a depth pyramid (culling/hidden.glsl has the test of a capsule, by the same symbols).
//
// A cluster is {{ cluster_size }} fiblets that lie near each other (pvfiblets/engine/fiblets/data/clusters.py).
//
// Invariant: a box holds the capsules of its fiblets, so that no fiblet of a cluster that is left out has a pixel in front of the pyramid.

#include "culling/hidden.glsl"
#include "culling/frustum.glsl"
#include "culling/cut.glsl"
#include "fiblets/compute/clusters.glsl"

struct Box { vec3 middle; vec3 reach; };

Box box_of(uint cluster) {
    uvec3 words = uvec3(clusters[3u * cluster], clusters[3u * cluster + 1u], clusters[3u * cluster + 2u]);
    uvec3 low = uvec3(words.x & 0xFFFFu, words.x >> 16, words.y & 0xFFFFu), high = uvec3(words.y >> 16, words.z & 0xFFFFu, words.z >> 16);
#if FEATURE_ANCHORS_LOW
    const float UNIT = 65536.0;
#else
    const float UNIT = 1.0;
#endif
    vec3 begin = UNIT * {{ cluster_bias }} + vec3(reference);
    vec3 a = (UNIT * {{ cluster_step }} * vec3(low) - begin) * anchor_scale, b = (UNIT * {{ cluster_step }} * vec3(high) - begin) * anchor_scale;
    a = mix(a, vec3(-1e9), equal(low, uvec3(0u)));   // unbounded
    b = mix(b, vec3(1e9), equal(high, uvec3(65535u)));
#if FEATURE_TUBES
    a -= tube_radius;
    b += tube_radius;
#endif
    return Box(0.5 * (a + b), 0.5 * (b - a));
}

bool beyond_planes(Box box) {
    bool outside = false;
    for (int side = 0; side < 6; ++side) {
        vec4 plane = view_planes[side];
        outside = outside || dot(plane.xyz, box.middle) + plane.w < -dot(abs(plane.xyz), box.reach);
    }
    return outside;
}

bool cut_away(Box box) {
    bool away = false;
#if FEATURE_CLIP_PLANES
    for (int plane = 0; plane < clip_plane_count; ++plane) {
        away = away || clip_height_of(plane, box.middle) + clip_rounding < -dot(abs(clip_planes[plane].xyz), box.reach);
    }
#endif
#if FEATURE_CLIP_REGION
    float ball = length(box.reach);
    away = away || region_of_lines(box.middle, box.middle, ball, ball) < 0;
#endif
    return away;
}

bool box_hidden(Box box) {
    vec4 middle = to_homogeneous(box.middle);
    vec4 x = window_from_local[0] * box.reach.x, y = window_from_local[1] * box.reach.y, z = window_from_local[2] * box.reach.z;
    vec4 corners[8];
    vec3 low = vec3(3.0e38), high = vec3(-3.0e38);
    float least = 3.0e38, most = 0.0;
    for (int i = 0; i < 8; ++i) {
        vec4 c = middle + ((i & 1) == 0 ? -x : x) + ((i & 2) == 0 ? -y : y) + ((i & 4) == 0 ? -z : z);
        corners[i] = c;
        least = min(least, c.w);
        most = max(most, c.w);
        low = min(low, c.xyz / c.w);
        high = max(high, c.xyz / c.w);
    }
    if (least <= 1e-3 * most) return false;  // beside or behind the camera
    low.xy -= half_line_width + MARGIN;
    high.xy += half_line_width + MARGIN;
    bool beside = any(greaterThanEqual(low.xy, viewport)) || any(lessThan(high.xy, vec2(0.0)));
    ivec2 first = ivec2(clamp(low.xy, vec2(0.0), viewport - 1.0)), last = ivec2(clamp(high.xy, vec2(0.0), viewport - 1.0));
    float m = farthest_in(first, last);
    bool deep = m > 1.0;
    if (half_line_width <= 0.0) m += max(CELL_SHIFT.x, CELL_SHIFT.y) * (high.z - low.z);
    float slack = slack_of(Capsule(abs(box.middle) + box.reach, vec3(0.0), 0.0, 0.0));
    bool behind = true;
    for (int i = 0; i < 8; ++i) behind = behind && corners[i].z - m * corners[i].w > slack;
    return beside || !deep && behind;
}

bool cluster_left(uint cluster) {
    if (cluster >= cluster_count()) return false;
    Box box = box_of(cluster);
    return !beyond_planes(box) && !cut_away(box) && !box_hidden(box);
}
