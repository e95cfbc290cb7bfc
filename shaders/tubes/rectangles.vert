// A rectangle of the window around each segment of a spline tube: four vertices, one for each corner, by an index buffer.

#version 430

#include "tubes/write_varyings.glsl"
#include "tubes/bounds.glsl"

#if FEATURE_TUBE_LISTED
uniform usamplerBuffer listed_texels;    // segments to draw; OpenGL is told how many
#endif
uniform int first_segment;

void main() {
    int index = first_segment + (gl_VertexID >> 2);
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
    varying_centre = varying_seen = varying_a1 = varying_a2 = varying_b2 = varying_b3 = vec4(0.0);
    varying_depth = vec2(0.0);
    varying_ids = uvec2(0u);
    if (index >= tube_segments) return;
#if FEATURE_TUBE_LISTED
    index = int(texelFetch(listed_texels, index).x);
#endif
    Segment s = segment_of(index);
    Bounds box;
    if (!has_turn(s) || !bounds_of(s, box)) return;
    vec2 place = mix(box.low, box.high, vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1 & 1)));
    write_varyings(s, index, 3u);
    vec2 pixel = box.start + place.x * box.along + place.y * turned(box.along);
    gl_Position = vec4(2.0 * pixel / viewport - 1.0, 0.0, 1.0);
}
