// The solver alone: where given rays meet given halves, one a pixel, for tests and for the error against run time.
// pvfiblets/report/studies/tubes/solver_probe.py moves both to the half's own place and size, as tubes/segment.glsl does.

#version 430

#include "tubes/block.glsl"
#include "tubes/functions.glsl"
#if FEATURE_TUBE_CHAIN
#include "tubes/solver.glsl"
#else
#include "tubes/quick.glsl"
#endif
#include "tubes/orthonormal_basis.glsl"

uniform samplerBuffer cases;     // control points; o and `first`; d, and 1 where a plane made `first`
uniform int row;                 // pixels of a row
uniform int count;

out vec4 met;                    // l, t, kind

void main() {
    int at = int(gl_FragCoord.y) * row + int(gl_FragCoord.x);
    met = vec4(0.0);
    if (at >= count) return;
    vec4 p0 = texelFetch(cases, 5 * at), p1 = texelFetch(cases, 5 * at + 1), p2 = texelFetch(cases, 5 * at + 2);
    vec4 o = texelFetch(cases, 5 * at + 3), d = texelFetch(cases, 5 * at + 4);
    vec3 y_axis, z_axis;
    across(d.xyz, y_axis, z_axis);
    Found best = Found(3e38, 0.0, MISS);
    meet_half(in_ray_space(p0, o.xyz, d.xyz, y_axis, z_axis), in_ray_space(p1, o.xyz, d.xyz, y_axis, z_axis),
              in_ray_space(p2, o.xyz, d.xyz, y_axis, z_axis), o.w, d.w > 0.0, bvec2(false), best);
    met = vec4(best.l, best.t, float(best.kind), 0.0);
}
