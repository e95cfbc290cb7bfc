// What a ray shows of its parts inside the caller's region, from the eye on.
//
// This work is based on: Schertzer et al. 2022, section 5.1, which cuts by one front and one back depth of a mesh. Here the region
// may begin and end any number of times along a ray: pvfiblets/engine/regions/ray_intervals.py draws the depths at which it does.
//
// Symbols
//   boundary     window depth from which on the region holds, or no longer holds (regions/boundaries.glsl)
//   part         from a boundary where it begins to hold to the next; a ray's samples begin anew in each
//
// Light is that of the parts, one behind the other; a peak is the highest of all; a surface is the first. Where a part begins or
// ends there is no surface: as with planes, one sees into the volume.

#include "regions/boundaries.glsl"

float boundary_of(ivec2 pixel, int number) {
    if ((number >> 2) >= region_layers) return 2.0;
    return texelFetch(region_boundaries, ivec3(pixel, number >> 2), 0)[number & 3];
}

// Places at which the part begins that has this number or is the first behind it that is longer than nothing, and where it ends.
bool next_part(ivec2 pixel, Ray whole, inout int number, out float begin, out float end) {
    for (;;) {
        float enter = boundary_of(pixel, 2 * number), leave = boundary_of(pixel, 2 * number + 1);
        begin = enter < 0.0 ? whole.first : enter > 1.0 ? 3e38 : max(where_far(whole, 1.0 - enter), whole.first);
        end = leave > 1.0 ? whole.last : min(where_far(whole, 1.0 - leave), whole.last);
        ++number;
        if (!(begin < whole.last)) return false;
        if (begin < end) return true;
    }
}

#if FEATURE_VOLUME_SURFACE
bool find_surface_in_parts(ivec2 pixel, Ray whole, float step, float late, out float hit, out float value) {
    Ray part = whole;
    float begin;
    for (int number = 0; next_part(pixel, whole, number, begin, part.last);) {
        if (find_surface(part, step, min(begin + late, part.last), hit, value)) return true;
    }
    return false;
}
#elif FEATURE_VOLUME_LIGHT
bool gather_in_parts(ivec2 pixel, Ray whole, float step, float late, out float hit, out vec4 light) {
    Ray part = whole;
    float begin, here;
    vec4 more;
    light = vec4(0.0);
    hit = -1.0;
    for (int number = 0; light.a < ray_high.w && next_part(pixel, whole, number, begin, part.last);) {
        if (!gather(part, step, min(begin + late, part.last), here, more)) continue;
        if (light.a <= 0.0) hit = here;
        light += (1.0 - light.a) * more;
    }
    if (light.a >= ray_high.w) light /= light.a;
    return light.a > 0.0;
}
#else
bool find_peak_in_parts(ivec2 pixel, Ray whole, float step, float late, out float hit, out float value) {
    Ray part = whole;
    float begin, here, peak;
    value = -3e38;
    hit = whole.first;
    for (int number = 0; next_part(pixel, whole, number, begin, part.last);) {
        if (find_peak(part, step, min(begin + late, part.last), here, peak) && peak > value) {
            value = peak;
            hit = here;
        }
#if FEATURE_VOLUME_LOCAL
        if (value >= ray_table.w) break;
#endif
    }
    return value > -3e38;
}
#endif
