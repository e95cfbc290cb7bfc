// The greatest value on a ray, or the first peak above a threshold.
// Paper: Lesar 2015, section III.F, equation (9); local maxima after Sato et al. 1998.

bool is_there(float value) { return value >= value_low && value <= value_high; }

bool find_peak(Ray ray, float step, float start, out float hit, out float value) {
    float t = start, best = -3e38, found = -3e38;      // found: of a plateau, the first place counts, however values round
    hit = start;
    while (t <= ray.last) {
        float number, end = t + to_end_of_node(ray, t, best, number);
        bool skip = number <= best && end - t >= step;
#if FEATURE_VOLUME_LOCAL
        if (best >= peak_threshold) {               // all here is lower: the peak is over; or some of it may be as high
            if (skip && number < best - peak_rounding) break;
            skip = false;
        }
#endif
        if (skip) {
            t += floor((end - t) / step) * step;
            if (t > ray.last) break;
        }
        bool over = false;
        do {
            float v = value_at(at(ray, t));
            bool there = is_there(v);
#if FEATURE_VOLUME_MINIMUM
            v = -v;      // the greatest of these; nodes have the greatest of them, too
#endif
            if (there && v > best) {
                best = v;
                if (v > found + peak_rounding) {
                    found = v;
                    hit = t;
                }
            }
#if FEATURE_VOLUME_LOCAL
            over = v < best - peak_rounding && best >= peak_threshold;
#endif
            t += step;
        } while (!over && t < end && t <= ray.last);
        if (over) break;
    }
    value = best;
    return best > -3e38;
}
