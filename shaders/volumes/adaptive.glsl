// Light of a stretch of a ray, halved until what its halves give off is what the whole does.
// Paper: Lesar 2015, section III.E, equations (6) to (8), of values that are linear between samples.
//
// Symbols
//   u            place of a value in the table, in entries: alpha and c are linear between whole numbers, and go on beyond the ends
//   kappa        -ln(1 - alpha) / unit
//   K(u)         integral of kappa over u from 0: what lies in entries before in two floats, so that differences keep their digits,
//                and the part within u's own place
//
// Between two samples A and B the optical depth is mm (K(B) - K(A)) / (B - A), exactly, however steep and narrow what lies between
// is; the mean colour is that of the table of segments, of which only quotients are taken, or within an entry that of its ends.
//
// A stretch is looked at in its middle too, M. It is halved if the light of both halves is not that of the whole; or if the value
// may have turned between the samples and met there what it does not meet at them. A tent or a parabola through A, M, B
// reaches no farther beyond the three than |A - 2 M + B|.
//
// What is halved begins and ends where the field bends, at the faces between cells of eight voxels: turns of two faces between three
// samples can cancel in them, however far the value reaches between.

uniform sampler2D media;          // at places of the table: (c, kappa); below, (K in two floats, by how much it grows to the next, 0)
uniform float places_per_entry;

const int FINEST = {{ finest }};            // parts of a stretch
const float ALLOWED = {{ adaptive_error }};      // that the light of halves differs

struct Look {
    float u;                      // in places
    vec4 medium;                  // c, kappa
    vec3 depth;                   // K: three floats, the last of which lies within u's own place
};

float u_of(float value) {
    return (value - transfer_low) * (float(textureSize(media, 0).x - 1) / max(transfer_high - transfer_low, 1e-30));
}

Look look_at(float u) {
    // What lies beyond the thresholds has no extinction: K stays as it is.
    float kept = clamp(u, u_of(value_low), u_of(value_high)), i = clamp(floor(kept), 0.0, float(textureSize(media, 0).x - 2));
    vec4 low = texelFetch(media, ivec2(int(i), 0), 0), high = texelFetch(media, ivec2(int(i) + 1, 0), 0);
    vec3 before = texelFetch(media, ivec2(int(i), 1), 0).xyz;
    float f = kept - i, inside = clamp(f, 0.0, 1.0);
    vec4 medium = mix(low, high, inside);
    // Hermite's cubic: both ends' kappa, but no more of it than K can grow by, and all of K's growth.
    float rise = inside * inside * (3.0 - 2.0 * inside), to_end = 1.0 - inside, most = 2.0 * before.z;
    float part = rise * before.z + inside * to_end * (to_end * min(low.a, most) - inside * min(high.a, most)) + (f - inside) * medium.a;
    if (u != kept) medium.a = 0.0;
    return Look(u, medium, vec3(before.xy, part));
}

Look look_along(Ray ray, float t) { return look_at(u_of(value_at(at(ray, t)))); }

float depth_between(Look a, Look b) {
    vec3 change = b.depth - a.depth;
    return (change.x + change.y) + change.z;
}

float opacity_of(float x) { return x < 0.01 ? x * (1.0 - x * (0.5 - x / 6.0)) : 1.0 - exp(-x); }

// Mean colour within an entry: it weighs by extinction, and where it is dense the front counts more.
vec3 colour_between(vec4 a, vec4 b, float x) {
    float share = (a.a + 2.0 * b.a) / max(3.0 * (a.a + b.a), 1e-30) * (6.0 + x) / (6.0 + x * (2.0 + 0.5 * x));
    return mix(a.rgb, b.rgb, share);
}

// Premultiplied colour and opacity of some mm between two looks.
vec4 light_between(Look a, Look b, float mm) {
    float change = b.u - a.u, wide = abs(change);
    float x = mm * (wide > 0.25 ? max(depth_between(a, b) / change, 0.0) : 0.5 * (a.medium.a + b.medium.a));
    float alpha = opacity_of(x);
    vec3 c = colour_between(a.medium, b.medium, x);
    if (wide > places_per_entry) {
        // The rest of the entry that it begins in by itself: only from whole entries on is the table of segments exact.
        float last = float(textureSize(media, 0).x - 1);
        float low = clamp(u_of(value_low), 0.0, last), high = clamp(u_of(value_high), 0.0, last);
        float entry = floor(a.u / places_per_entry) + 1.0;
        if (change < 0.0) entry = ceil(a.u / places_per_entry) - 1.0;
        float next = clamp(entry * places_per_entry, low, high);
        Look turn = look_at(next);
        float head = mm * max(depth_between(a, turn) / change, 0.0), shown = min(opacity_of(head), alpha);
        vec2 ends = vec2(next, clamp(b.u, low, high)) / last;
        vec4 whole = entry_at(segments, ends * float(textureSize(segments, 0).x - 1));        // of the table of whole steps
        vec3 rest = whole.a > 0.0 ? whole.rgb / whole.a : c;
        c = mix(rest, colour_between(a.medium, turn.medium, head), shown / max(alpha, 1e-30));
    }
    return vec4(c * alpha, alpha);
}

float largest(vec4 v) { return max(max(v.x, v.y), max(v.z, v.w)); }

// Mm to the end of the cell that the ray is about to be in.
float to_end_of_cell(Ray ray, float t, float step) {
#if FEATURE_VOLUME_NEAREST
    vec3 p = at(ray, t) + 0.5;      // a cell of its own around each voxel
#else
    vec3 p = at(ray, t);
#endif
    vec3 cell = floor(p + 1e-3 * step * ray.d), out_of = (cell + vec3(greaterThanEqual(ray.d, vec3(0.0))) - p) * ray.inverse;
    return max(min(out_of.x, min(out_of.y, out_of.z)), 1e-3 * step);
}

// Of a stretch from t on, of some mm, the look at whose beginning is known, before which a part of the light is left.
vec4 adaptive_stretch(Ray ray, float t, float mm, float step, float left, inout Look a) {
    int place = 0, size = FINEST;
    vec4 light = vec4(0.0);
    float last = t + mm, within = min(to_end_of_cell(ray, t, step), mm), part = within / float(FINEST);
    Look m = look_along(ray, t + 0.5 * within);
    Look b = look_along(ray, t + within);
    for (;;) {
        float length = part * float(size);
        vec4 first = light_between(a, m, 0.5 * length), second = light_between(m, b, 0.5 * length);
        vec4 halves = first + (1.0 - first.a) * second;
        bool fine = size == 1;
        if (!fine) {
            float bend = a.u - 2.0 * m.u + b.u, reach = abs(bend);
            float error = largest(abs(halves - light_between(a, b, length)));
            if (reach > 0.016) {
                Look edge = bend < 0.0 ? (a.u > b.u ? a : b) : (a.u < b.u ? a : b);
                if (bend < 0.0 ? m.u > edge.u : m.u < edge.u) edge = m;
                Look tip = look_at(edge.u - bend);
                error = max(error, min(length * abs(depth_between(edge, tip) / bend + edge.medium.a) , 1.0));
            }
            fine = error * left * (1.0 - light.a) <= ALLOWED;
        }
        if (fine) {
            light += (1.0 - light.a) * halves;
            place += size;
            a = b;
            if (light.a >= opaque_from) break;
            if (place >= FINEST) {
                t += within;
                if (last - t < 1e-3 * step) break;
                within = min(to_end_of_cell(ray, t, step), last - t);
                part = within / float(FINEST);
                place = 0;
                size = FINEST / 2;      // twice that below
            }
            if ((place & (2 * size - 1)) == 0) size *= 2;
            m = look_along(ray, t + part * (float(place) + 0.5 * float(size)));
            b = look_along(ray, t + part * float(place + size));
        } else {
            size /= 2;
            b = m;
            m = look_along(ray, t + part * (float(place) + 0.5 * float(size)));
        }
    }
    return light;
}
