// Light on a surface, as VTK has it: flat ones by the slope of their triangles.

#version 430

#include "page/lights.glsl"
#include "colour/table.glsl"

in vec3 view_place;
in vec3 view_normal;
in vec4 own_colour;
in vec3 data_place;
in float own_value;
in vec3 sides;

uniform int smooth_normals;
uniform int lighting;
uniform int by_value;
uniform float parallel;
uniform float opacity;
uniform vec4 reflects;
uniform vec3 sheen;
uniform float edge_width;              // pixels; 0: no edges
uniform vec4 edge_colour;
uniform int plane_count;
uniform vec4 planes[6];
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 weight;   // mixed.frag; nothing where it is not blended by it

// As VTK has it: how much of the edge's colour, which no light falls on.
float edge_share() {
    if (edge_width == 0.0) return 0.0;
    vec3 d = sides / max(sqrt(dFdx(sides) * dFdx(sides) + dFdy(sides) * dFdy(sides)), vec3(1e-9));
    return edge_colour.a * clamp(0.5 + 0.5 * edge_width - min(min(d.x, d.y), d.z), 0.0, 1.0);
}

void main() {
    float edge = edge_share();
    for (int i = 0; i < plane_count; ++i) if (dot(planes[i].xyz, data_place) + planes[i].w < 0.0) discard;
    vec3 normal = smooth_normals == 1 ? normalize(view_normal) : normalize(cross(dFdx(view_place), dFdy(view_place)));
    vec3 sight = parallel == 1.0 ? vec3(0.0, 0.0, 1.0) : normalize(-view_place);
    if (dot(normal, sight) < 0.0) normal = -normal;
    vec4 own = by_value == 1 ? table_colour(own_value) : own_colour;
    own.rgb *= 1.0 - edge;
    vec3 lit = lighting == 1 ? light_on_surface(own.rgb, normal, view_place, reflects, sheen) : own.rgb;
    colour = vec4(lit + edge * edge_colour.rgb, own.a * opacity);
    weight = vec4(1.0, 0.0, 0.0, colour.a);
}
