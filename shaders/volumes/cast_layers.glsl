// What a ray shows of translucent surfaces: all that it meets, one behind the other.
// Paper: Lesar 2015, section III.B, whose first crossing is the nearest of these.
//
// Crossings within a step come in the order of the line through its ends, each refined by itself. Normals point to the viewer, and the
// scene's lamps shine on them as on other surfaces.

#include "volumes/surface.glsl"
#include "volumes/shading.glsl"

uniform vec4 surface_colours[{{ surfaces }}];      // of isovalues

layout(location = 4) out vec4 out_colour;

void clear_shown() { out_colour = vec4(0.0); }

vec3 towards_viewer(Ray ray, float t) {
#if FEATURE_VOLUME_CLOSED
    if (t == box_enter || t == box_leave) {
        vec3 axis = axis_of_face(at(ray, t));
        return dot(axis, ray.d) > 0.0 ? -axis : axis;
    }
#endif
#if FEATURE_VOLUME_NEAREST
    vec3 p = floor(at(ray, t) + 0.5);
#else
    vec3 p = at(ray, t);
#endif
    vec3 low = max(p - 1.0, 0.0), high = min(p + 1.0, volume_shape - 1.0);
    vec3 g = vec3(value_at(vec3(high.x, p.yz)) - value_at(vec3(low.x, p.yz)),
                  value_at(vec3(p.x, high.y, p.z)) - value_at(vec3(p.x, low.y, p.z)),
                  value_at(vec3(p.xy, high.z)) - value_at(vec3(p.xy, low.z))) / (high - low);
    float size = max(abs(g.x), max(abs(g.y), abs(g.z)));
    // By voxels, as gradients are: its product with a direction by voxels has the sign of the angle in mm.
    if (size == 0.0) return -transpose(mm_from_voxels) * (mm_from_voxels * ray.d);
    return (dot(g, ray.d) > 0.0 ? -g : g) / size;
}

void add_surface(Ray ray, float at_t, int k, inout float hit, inout float value, inout vec4 light) {
    vec4 colour = surface_colours[k];
    if (colour.a <= 0.0) return;
    if (light.a <= 0.0) {
        hit = at_t;
        value = isovalues[k];
    }
    vec3 lit = lit_surface(colour.rgb, at(ray, at_t), towards_viewer(ray, at_t));
    light += (1.0 - light.a) * colour.a * vec4(lit, 1.0);
}

#if FEATURE_VOLUME_CLOSED
void add_face(Ray ray, float at_t, inout float hit, inout float value, inout vec4 light) {
    float at_face = value_at(at(ray, at_t));
    for (int k = 0; k < isovalue_count && light.a < opaque_from; ++k) {
        if (isovalues[k] <= at_face) add_surface(ray, at_t, k, hit, value, light);
    }
}
#endif

#if FEATURE_VOLUME_CELLS
float shown_at, shown_value;
vec4 shown_light;

bool show_stretch(Ray ray, Stretch found) {
    float last = -1.0;
    int last_of = -1;
    while (shown_light.a < opaque_from) {
        float best = 2.0;
        int best_of = -1;
        for (int k = 0; k < isovalue_count; ++k) {
            vec3 places = crossings(found.b - isovalues[k], (found.sides >> k & 1u) != 0u);
            for (int i = 0; i < 3; ++i) {
                if (places[i] < best && (places[i] > last || (places[i] == last && k > last_of))) {
                    best = places[i];
                    best_of = k;
                }
            }
        }
        if (best_of < 0) break;
        last = best;
        last_of = best_of;
        add_surface(ray, place_of(found, best), best_of, shown_at, shown_value, shown_light);
    }
    return shown_light.a >= opaque_from;
}

void add_surfaces(Ray ray, float step, float start, inout float hit, inout float value, inout vec4 light) {
    shown_at = hit;
    shown_value = value;
    shown_light = light;
    walk_surfaces(ray, start);
    hit = shown_at;
    value = shown_value;
    light = shown_light;
}
#else
void add_surfaces(Ray ray, float step, float start, inout float hit, inout float value, inout vec4 light) {
    float t = start, before = value_at(at(ray, t));
    while (t < ray.last && light.a < opaque_from) {
        float number, end = t + to_end_of_node(ray, t, 0.5, number);
        if (number <= 0.5 && end - t >= step) {
            t += floor((end - t) / step) * step;
            if (t >= ray.last) return;
            before = value_at(at(ray, t));
        }
        do {
            float next = min(t + step, ray.last), after = value_at(at(ray, next)), last = -1.0;
            int last_of = -1;
            while (light.a < opaque_from) {
                float best = 2.0;
                int best_of = -1;
                for (int k = 0; k < isovalue_count; ++k) {
                    float a = before - isovalues[k], b = after - isovalues[k];
                    float share = (a < 0.0) != (b < 0.0) ? a / (a - b) : 2.0;
                    if (share < best && (share > last || (share == last && k > last_of))) {
                        best = share;
                        best_of = k;
                    }
                }
                if (best_of < 0) break;
                last = best;
                last_of = best_of;
                float mu = isovalues[best_of], at_t = refined(ray, mu, t, before - mu, next, after - mu);
                add_surface(ray, at_t, best_of, hit, value, light);
            }
            before = after;
            t = next;
        } while (t < end && t < ray.last && light.a < opaque_from);
    }
}

#endif

void add_all(Ray ray, float begin, float step, float start, inout float hit, inout float value, inout vec4 light) {
#if FEATURE_VOLUME_CLOSED
    if (begin == box_enter) add_face(ray, begin, hit, value, light);
#endif
    if (light.a < opaque_from) add_surfaces(ray, step, start, hit, value, light);
#if FEATURE_VOLUME_CLOSED
    if (ray.last == box_leave && light.a < opaque_from) add_face(ray, ray.last, hit, value, light);
#endif
}

bool cast_ray(ivec2 pixel, Ray ray, float step, float start, out float hit, out float value) {
    vec4 light = vec4(0.0);
    hit = start;
    value = 0.0;
#if FEATURE_CLIP_REGION
    Ray part = ray;
    float begin, late = start - ray.first;
    for (int number = 0; light.a < opaque_from && next_part(pixel, ray, number, begin, part.last);) {
        add_all(part, begin, step, min(begin + late, part.last), hit, value, light);
    }
#else
    add_all(ray, ray.first, step, start, hit, value, light);
#endif
    if (light.a >= opaque_from) light /= light.a;
    if (!(light.a > 0.0)) return false;
    out_colour = vec4(light.rgb / light.a, light.a);
    return true;
}
