// Baseline `tessellated`: one light at the eye, diffuse and specular.

#version 430

uniform vec3 eye;

in vec3 surface_place;
in vec3 surface_normal;

out vec4 colour;

void main() {
    float facing = abs(dot(normalize(surface_normal), normalize(eye - surface_place)));
    colour = vec4(vec3(0.1, 0.5, 0.9) * (0.15 + 0.85 * facing) + 0.3 * pow(facing, 40.0), 1.0);
}
