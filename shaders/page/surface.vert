// Surfaces: triangles, each with three vertices of its own or with shared ones.

#version 430

layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 own;
layout(location = 3) in float value;
layout(location = 4) in float edges;   // of a triangle, whose corners are its own: a bit for each side, opposite the same corner

uniform mat4 clip_from_data;
uniform mat4 view_from_data;
uniform mat3 normal_to_view;

out vec3 view_place;
out vec3 view_normal;
out vec4 own_colour;
out vec3 data_place;
out float own_value;
out vec3 sides;                        // 0 on a side that has an edge

void main() {
    gl_Position = clip_from_data * vec4(place, 1.0);
    view_place = (view_from_data * vec4(place, 1.0)).xyz;
    view_normal = normal_to_view * normal;
    own_colour = own;
    data_place = place;
    own_value = value;
    int corner = gl_VertexID % 3, shown = int(edges);
    sides = max(vec3(corner == 0, corner == 1, corner == 2), vec3((shown & 1) == 0, (shown & 2) == 0, (shown & 4) == 0));
}
