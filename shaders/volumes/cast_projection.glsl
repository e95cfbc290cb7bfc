// What a ray shows of values: the greatest or least, the first peak, or their mean, and where that lies.

#if FEATURE_VOLUME_AVERAGE
#include "volumes/mean_projection.glsl"

void clear_shown() {}

bool cast_ray(ivec2 pixel, Ray ray, float step, float start, out float hit, out float value) {
    float sum = 0.0, count = 0.0;
    hit = start;
#if FEATURE_CLIP_REGION
    Ray part = ray;
    float begin;
    for (int number = 0; next_part(pixel, ray, number, begin, part.last);) {
        add_up(part, step, begin + start - ray.first, hit, sum, count);
    }
#else
    add_up(ray, step, start, hit, sum, count);
#endif
    value = sum / max(count, 1.0);
    return count > 0.0;
}
#else
#include "volumes/intensity_projection.glsl"
#if FEATURE_CLIP_REGION
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
        if (value >= peak_threshold) break;
#endif
    }
    return value > -3e38;
}
#endif

void clear_shown() {}

bool cast_ray(ivec2 pixel, Ray ray, float step, float start, out float hit, out float value) {
#if FEATURE_CLIP_REGION
    bool found = find_peak_in_parts(pixel, ray, step, start - ray.first, hit, value);
#else
    bool found = find_peak(ray, step, start, hit, value);
#endif
#if FEATURE_VOLUME_MINIMUM
    value = -value;
#endif
    return found;
}
#endif
