// The greatest value on a ray, or the first peak above a threshold.
// Paper: Lesar 2015, section III.F, equation (9); local maxima after Sato et al. 1998.

bool is_there(float value) { return value >= value_low && value <= value_high; }

#if FEATURE_VOLUME_CELLS
float best, found, found_at;      // found: of a plateau, the first place counts, however values round

bool is_over(float value) {
#if FEATURE_VOLUME_LOCAL
    return best >= peak_threshold && value < best - peak_rounding;
#else
    return false;
#endif
}

float node_threshold() {
#if FEATURE_VOLUME_LOCAL
    if (best >= peak_threshold) return -3e38;      // of what is lower, all must be looked at until the peak is over
#endif
    return best;
}

bool ends_before(float number) { return is_over(number); }

void take(float value, float t) {
    if (value <= best) return;
    best = value;
    if (value <= found + peak_rounding) return;
    found = value;
    found_at = t;
}

// Between the places at which its cubic turns the field rises or falls: its peaks lie there, or where it passes the highest that is there.
bool show_cell(Ray ray, inout Walk walk, float first, float bottom, float top) {
#if FEATURE_VOLUME_MINIMUM
    float low = -value_high, high = -value_low, most = -bottom;
#else
    float low = value_low, high = value_high, most = top;
#endif
    if (is_over(most)) return true;
    if (most <= best && !is_over(-3e38)) return false;
    vec4 b = bernstein(walk, first);
#if FEATURE_VOLUME_MINIMUM
    b = -b;
#endif
    vec3 turns = vec3(turns_of(b), 1.0);
    float before = b.x, from = 0.0;
    if (before >= low && before <= high) take(before, first);
    if (is_over(before)) return true;
    for (int k = 0; k < 3; ++k) {
        float value = k == 2 ? b.w : cubic_at(b, turns[k]).x;
        if ((before > high) != (value > high) && max(before, value) > best) {
            take(high, mix(first, walk.t, crossing_between(b - high, from, turns[k], before <= high)));
        }
        if (value >= low && value <= high) take(value, mix(first, walk.t, turns[k]));
        if (is_over(value)) return true;
        before = value;
        from = turns[k];
    }
    return false;
}

bool find_peak(Ray ray, float step, float start, out float hit, out float value) {
    best = found = -3e38;
    found_at = start;
    walk_cells(ray, start);
    hit = found_at;
    value = best;
    return best > -3e38;
}
#else
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
#endif
