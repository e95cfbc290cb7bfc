// The oriented boxes of spline tubes by vertex pulling: eight vertices a box, two boxes a segment, by an index buffer.
// Paper: Russig et al. 2020, section 3.2, "Silhouettes"; its conclusion asks for other ways than the geometry stage.

#version 430

#include "tubes/write_varyings.glsl"
#include "tubes/box.glsl"

uniform int first_segment;

void main() {
    int index = first_segment + (gl_VertexID >> 4);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    varying_centre = varying_seen = varying_a1 = varying_a2 = varying_b2 = varying_b3 = vec4(0.0);
    varying_depth = vec2(0.0);
    varying_ids = uvec2(0u);
    if (index >= tube_segments) return;
    Segment s = segment_of(index);
    if (!has_turn(s)) return;
    vec4 middle = junction(s);
    bool second = (gl_VertexID & 8) != 0;
    Box box = second ? box_of_half(middle, s.b2, s.b3) : box_of_half(s.a1, s.a2, middle);
    vec3 corner = vec3(float(gl_VertexID & 1), float(gl_VertexID >> 1 & 1), float(gl_VertexID >> 2 & 1));
    write_varyings(s, index, second ? 2u : 1u);
    gl_Position = clip_of(s.centre + s.size * box_corner(box, corner));
}
