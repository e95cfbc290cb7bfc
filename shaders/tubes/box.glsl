// The oriented box around one half of a segment. Paper: Russig et al. 2020, section 3.2, "Silhouettes", figure 2.
//
// Symbols
//   x, y, z      axes: from the first to the last control point; the tangent's part across that; their cross product
//   q(t), r(t)   centre and radius of the swept sphere along one axis: a quadratic each
//
// Algorithm: along every axis q - r and q + r have their extremes at t = 0, at t = 1, or where their derivative, which is
// linear, is zero. The box goes from the least q - r to the greatest q + r.

#include "frame/project.glsl"

struct Box {
    vec3 x;
    vec3 y;
    vec3 z;
    vec3 low;
    vec3 high;
};

// Least and greatest value of the quadratic with these control values.
vec2 extremes(float v0, float v1, float v2) {
    float a = v0 - 2.0 * v1 + v2, t = (v0 - v1) / a;
    vec2 range = vec2(min(v0, v2), max(v0, v2));
    if (t > 0.0 && t < 1.0) {
        float v = mix(mix(v0, v1, t), mix(v1, v2, t), t);
        range = vec2(min(range.x, v), max(range.y, v));
    }
    return range;
}

vec3 any_across(vec3 x) { return abs(x.x) < 0.6 ? normalize(vec3(0.0, -x.z, x.y)) : normalize(vec3(-x.y, x.x, 0.0)); }

Box box_of_half(vec4 p0, vec4 p1, vec4 p2) {
    vec3 run = p2.xyz - p0.xyz, tangent = p1.xyz - p0.xyz;
    float size = length(run);
    if (size < 1e-6) {                     // the half returns to where it began, or never leaves
        run = tangent;
        size = length(run);
    }
    Box box;
    box.x = size < 1e-6 ? vec3(1.0, 0.0, 0.0) : run / size;
    vec3 rest = tangent - box.x * dot(tangent, box.x);
    box.y = length(rest) > 1e-4 * length(tangent) + 1e-12 ? normalize(rest) : any_across(box.x);
    box.y = normalize(box.y - box.x * dot(box.x, box.y));
    box.z = cross(box.x, box.y);
    mat3 axes = mat3(box.x, box.y, box.z);
    for (int k = 0; k < 3; ++k) {
        float v0 = dot(axes[k], p0.xyz), v1 = dot(axes[k], p1.xyz), v2 = dot(axes[k], p2.xyz);
        box.low[k] = extremes(v0 - p0.w, v1 - p1.w, v2 - p2.w).x;
        box.high[k] = extremes(v0 + p0.w, v1 + p1.w, v2 + p2.w).y;
    }
    vec3 margin = vec3(2e-6) + 1e-6 * (box.high - box.low);      // float32 rounds, and sizes are about 1
    box.low -= margin;
    box.high += margin;
    return box;
}

// A corner of the box, relative to the segment's centre, over its size.
vec3 box_corner(Box box, vec3 corner) {
    vec3 at = mix(box.low, box.high, corner);
    return box.x * at.x + box.y * at.y + box.z * at.z;
}

vec4 clip_of(vec3 local) {
    vec4 c = to_homogeneous(local);
    return vec4(2.0 * c.xy / viewport - c.w, 2.0 * c.z - c.w, c.w);
}
