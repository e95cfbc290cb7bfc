// The lights of a scene, as VTK's own shaders count them; directions and places in view coordinates.
//
//   light_colour   colour times intensity
//   light_place    xyz: direction to a light that is far away (w = 0), or its place (w = 1)

const int MOST_LIGHTS = 8;

#include "frame/gentle_light.glsl"

uniform int light_count;
uniform vec3 light_colour[MOST_LIGHTS];
uniform vec4 light_place[MOST_LIGHTS];
uniform vec3 light_sum;                // of all colours
uniform float light_standing;          // 1: one of them stands in the scene

vec3 to_light(int i, vec3 place) { return normalize(light_place[i].xyz - light_place[i].w * place); }

vec3 light_on_line(vec3 own, vec3 tangent, vec3 place, bool illuminated, vec4 reflects, vec3 sheen) {
    vec3 sight = normalize(-place), normal = sight - tangent * dot(tangent, sight);
    normal = length(normal) > 1e-3 ? normalize(normal) : sight;
    vec3 diffuse = vec3(0.0), shine = vec3(0.0);
    for (int i = 0; i < light_count; ++i) {
        vec3 l = to_light(i, place);
        float along = dot(tangent, l), sine = sqrt(max(0.0, 1.0 - along * along));
        diffuse += light_colour[i] * (illuminated ? sine : across_line(tangent, l));
        if (reflects.z > 0.0) {
            float spread = illuminated ? sine : sqrt(max(0.0, 1.0 - along * along));
            vec3 back = -along * tangent + spread * normal;
            shine += light_colour[i] * pow(max(1e-5, dot(back, sight)), reflects.w);
        }
    }
    vec3 on;
    if (illuminated) on = diffuse / max(1.0, max(light_sum.r, max(light_sum.g, light_sum.b)));
    else {
        float share = min(dot(diffuse, vec3(1.0)) / max(dot(light_sum, vec3(1.0)), 1e-6), 1.0);
        on = vec3(gentle_light(light_standing > 0.0 ? share : across_line(tangent, SHOULDER)));
    }
    return reflects.x * own + reflects.y * on * own + reflects.z * sheen * shine;
}

vec3 light_on_surface(vec3 own, vec3 normal, vec3 place, vec4 reflects, vec3 sheen) {
    vec3 diffuse = vec3(0.0), shine = vec3(0.0), sight = normalize(-place);
    for (int i = 0; i < light_count; ++i) {
        vec3 l = to_light(i, place);
        float facing = max(0.0, dot(normal, l));
        diffuse += facing * light_colour[i];
        if (reflects.z > 0.0 && facing > 0.0) shine += light_colour[i] * pow(max(0.0, dot(reflect(-l, normal), sight)), reflects.w);
    }
    return reflects.x * own + reflects.y * diffuse * own + reflects.z * sheen * shine;
}
