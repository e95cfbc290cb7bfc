// The mean value on a ray, of samples at equal distances.

bool is_there(float value) { return value >= value_low && value <= value_high; }

// Adds up what is there, and says where the first of it is, or leaves that alone.
void add_up(Ray ray, float step, float start, inout float hit, inout float sum, inout float count) {
    for (float t = start; t <= ray.last; t += step) {
        float v = value_at(at(ray, t));
        if (!is_there(v)) continue;
        if (count == 0.0) hit = t;
        sum += v;
        count += 1.0;
    }
}
