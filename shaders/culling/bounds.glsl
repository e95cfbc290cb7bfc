// Bounds of a fiblet: a capsule, all points no farther than r from the segment a b. The paper (Schertzer et al. 2022,
// section 3.4.1) takes a sphere of radius N delta around the first point; the capsule is as long and a tenth as thick.
//
//   a, b         the fiblet's first point and the next fiblet's; where the streamline ends, b comes from its end vector
//   r            of `bounds`, rounded up by the encoder, so that it covers the points that a shader decodes
//   slip         how far b may lie beyond the last point, where it comes from an end vector: half a unit along each axis
//
// Far views (section 3.4.4): a fiblet that takes only a few pixels is drawn as the one segment a b. So is one that no pixel
// can tell from it: whose capsule is thinner than segment_deviation pixels, and whose end slips no further. The nearest end decides.

#include "fiblets/decode/record.glsl"

struct Capsule { vec3 a; vec3 b; float r; float slip; };

float radius_of(uint f) { return float(bitfieldExtract(bound_word(f >> 1), int(f & 1u) * 16, 16)) * radius_scale; }

vec3 end_vector(uint f) {
    uint word = bound_word(chunk_end_words + rank_of(f) - chunk_first_rank);
    precise vec3 v = end_vector_scale * vec3(fiblet_end_vector(word));
    return v;
}

Capsule capsule_of(uint f) {
    precise vec3 a = anchor_local(f), b;
    bool end = ends(f);
    if (end) b = a + end_vector(f);
    else b = anchor_local(f + 1u);
    return Capsule(a, b, radius_of(f), end ? 0.867 * end_vector_scale : 0.0);
}

// How far from a b anything of the fiblet may be drawn, but for pixels of a line's width: tubes are thicker than their axes.
float body_of(Capsule c) {
#if FEATURE_TUBES
    return c.r + tube_radius;
#else
    return c.r;
#endif
}

// W of the nearest point of a capsule.
float nearest_w(Capsule c) {
    vec4 row = vec4(window_from_local[0].w, window_from_local[1].w, window_from_local[2].w, window_from_local[3].w);
    precise float wa = dot(row.xyz, c.a) + row.w, wb = dot(row.xyz, c.b) + row.w;
    return min(wa, wb) - c.r * w_per_mm;
}

bool is_one_segment(Capsule c) {
    precise float scale = most_pixels_per_mm, w = nearest_w(c), length = distance(c.a, c.b);
    return w > 0.0 && (max(c.r, c.slip) * scale <= segment_deviation * w || (length + 2.0 * c.r) * scale <= segment_size * w);
}
