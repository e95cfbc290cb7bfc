// Baseline `tessellated`: a circle swept along the cubic Hermite curve of a segment (Russig et al. 2020, section 4).
//
// The circle stands across the tangent; its zero is that of the ends, blended and projected onto the circle's plane.

#version 430

layout(quads, equal_spacing, ccw) in;

const float TAU = 6.28318530717959;

uniform mat4 to_clip;

in Node { vec4 place; vec4 slope; vec3 across; } ends[];

out vec3 surface_place;
out vec3 surface_normal;

vec3 any_across(vec3 tangent) {
    vec3 axis = abs(tangent.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    return normalize(cross(tangent, axis));
}

void main() {
    float v = gl_TessCoord.y, w = 1.0 - v;
    vec4 p0 = ends[0].place, p3 = ends[1].place;
    vec4 p1 = p0 + ends[0].slope / 3.0, p2 = p3 - ends[1].slope / 3.0;
    vec4 place = w * w * (w * p0 + 3.0 * v * p1) + v * v * (3.0 * w * p2 + v * p3);
    vec4 slope = 3.0 * (w * w * (p1 - p0) + 2.0 * v * w * (p2 - p1) + v * v * (p3 - p2));
    float radius = max(place.w, 0.0), speed = length(slope.xyz);
    vec3 chord = p3.xyz - p0.xyz;
    vec3 tangent = speed > 0.0 ? slope.xyz / speed : dot(chord, chord) > 0.0 ? normalize(chord) : vec3(1.0, 0.0, 0.0);

    vec3 across = mix(ends[0].across, ends[1].across, v);
    across -= tangent * dot(tangent, across);
    across = dot(across, across) > 1e-8 ? normalize(across) : any_across(tangent);
    float angle = gl_TessCoord.x < 1.0 ? TAU * gl_TessCoord.x : 0.0;  // both edges of the seam are the same points
    vec3 outwards = cos(angle) * across + sin(angle) * cross(tangent, across);
    surface_place = place.xyz + radius * outwards;
    surface_normal = outwards * max(speed, 1e-30) - tangent * slope.w;  // leans where the radius changes
    gl_Position = to_clip * vec4(surface_place, 1.0);
}
