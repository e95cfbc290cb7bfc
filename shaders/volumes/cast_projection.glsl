// What a ray shows of peaks: the greatest value, or the first peak, and where it lies.

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
    return find_peak_in_parts(pixel, ray, step, start - ray.first, hit, value);
#else
    return find_peak(ray, step, start, hit, value);
#endif
}
