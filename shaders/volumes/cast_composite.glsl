// What a ray shows of light: the colour that comes through the volume, and where it begins.

#include "volumes/light.glsl"
#if FEATURE_CLIP_REGION
bool gather_in_parts(ivec2 pixel, Ray whole, float step, float late, out float hit, out vec4 light) {
    Ray part = whole;
    float begin, here;
    vec4 more;
    light = vec4(0.0);
    hit = -1.0;
    for (int number = 0; light.a < opaque_from && next_part(pixel, whole, number, begin, part.last);) {
        if (!gather(part, step, min(begin + late, part.last), here, more)) continue;
        if (light.a <= 0.0) hit = here;
        light += (1.0 - light.a) * more;
    }
    if (light.a >= opaque_from) light /= light.a;
    return light.a > 0.0;
}
#endif

layout(location = 4) out vec4 out_colour;

void clear_shown() { out_colour = vec4(0.0); }

bool cast_ray(ivec2 pixel, Ray ray, float step, float start, out float hit, out float value) {
    vec4 light;
    value = 0.0;
#if FEATURE_CLIP_REGION
    if (!gather_in_parts(pixel, ray, step, start - ray.first, hit, light)) return false;
#else
    if (!gather(ray, step, start, hit, light)) return false;
#endif
    out_colour = vec4(light.rgb / light.a, light.a);
    return true;
}
