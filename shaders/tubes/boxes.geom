// The oriented boxes of spline tubes by the geometry stage: a point comes in for each segment, two boxes go out.
// Paper: Russig et al. 2020, section 3.2, "Algorithm" and "Silhouettes".

#version 430

layout(points) in;
layout(triangle_strip, max_vertices = 28) out;

#include "tubes/write_varyings.glsl"
#include "tubes/box.glsl"

flat in int passed_segment[];

// A cube as one strip of triangles: bits x, y, z of the corners.
const int STRIP[14] = int[14](3, 2, 7, 6, 4, 2, 0, 3, 1, 7, 5, 4, 1, 0);

void emit_box(Segment s, int index, Box box, uint which) {
    vec4 corners[8];
    for (int k = 0; k < 8; ++k) {
        corners[k] = clip_of(s.centre + s.size * box_corner(box, vec3(float(k & 1), float(k >> 1 & 1), float(k >> 2))));
    }
    for (int k = 0; k < 14; ++k) {
        write_varyings(s, index, which);
        gl_Position = corners[STRIP[k]];
        EmitVertex();
    }
    EndPrimitive();
}

void main() {
    int index = passed_segment[0];
    Segment s = segment_of(index);
    if (!has_turn(s)) return;
    vec4 middle = junction(s);
    emit_box(s, index, box_of_half(s.a1, s.a2, middle), 1u);
    emit_box(s, index, box_of_half(middle, s.b2, s.b3), 2u);
}
