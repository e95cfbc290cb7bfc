// What a ray shows of surfaces: the first that it meets, its normal and the direction along it.

#include "volumes/surface.glsl"

bool find_first(Ray ray, float begin, float step, float start, out float hit, out float value) {
#if FEATURE_VOLUME_CLOSED
    hit = box_enter;
    value = begin == box_enter ? closed_value(value_at(at(ray, begin))) : -3e38;
    if (value > -3e38) return true;
#endif
    if (find_surface(ray, step, start, hit, value)) return true;
#if FEATURE_VOLUME_CLOSED
    hit = box_leave;      // seen from within
    value = ray.last == box_leave ? closed_value(value_at(at(ray, hit))) : -3e38;
    return value > -3e38;
#else
    return false;
#endif
}

#if FEATURE_CLIP_REGION
bool find_surface_in_parts(ivec2 pixel, Ray whole, float step, float late, out float hit, out float value) {
    Ray part = whole;
    float begin;
    for (int number = 0; next_part(pixel, whole, number, begin, part.last);) {
        if (find_first(part, begin, step, min(begin + late, part.last), hit, value)) return true;
    }
    return false;
}
#endif

layout(location = 4) out uint out_normal;

void clear_shown() { out_normal = 0u; }

bool cast_ray(ivec2 pixel, Ray ray, float step, float start, out float hit, out float value) {
#if FEATURE_CLIP_REGION
    if (!find_surface_in_parts(pixel, ray, step, start - ray.first, hit, value)) return false;
#else
    if (!find_first(ray, ray.first, step, start, hit, value)) return false;
#endif
#if FEATURE_VOLUME_NEAREST
    vec3 g = gradient_at(floor(at(ray, hit) + 0.5));      // of the voxel, whichever of its sides shows
#else
    vec3 g = gradient_at(at(ray, hit));
#endif
#if FEATURE_VOLUME_CLOSED
    if (hit == box_enter || hit == box_leave) g = gradient_from_voxels * axis_of_face(at(ray, hit));
#endif
    vec3 way = mm_from_voxels * ray.d;
    float size = max(abs(g.x), max(abs(g.y), abs(g.z)));
    vec3 normal = size > 0.0 ? g / size : -way;
    out_normal = packed_direction(dot(normal, way) > 0.0 ? -normal : normal);
    out_ids.y = packed_tangent(way - normal * dot(way, normal) / dot(normal, normal), 0u);      // along the surface, away
    return true;
}
