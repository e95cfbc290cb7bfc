// Where a streamline comes from before a fiblet, and where it goes on after it, in mm: for the tangents at the fiblet's ends
// (fiblets/attributes/tangent.glsl), and for the joints of wide lines (fiblets/segments/joint.glsl). None where the streamline begins
// or ends, and where the neighbour lies in another chunk.
//
// From far enough fiblets are one segment each (culling/bounds.glsl): `whole` asks for those segments.

#include "fiblets/decode/words.glsl"
#include "culling/bounds.glsl"

// The first segment, as the fiblet itself decodes it.
vec3 first_segment(uint f) {
    uvec3 words = decoding_words(f);
    if (fiblet_last(words) == 0u) return ends(f) ? vec3(0.0) : anchor_local(f + 1u) - anchor_local(f);
#if FEATURE_SPLINE
    if (coded_kind(words) == KIND_SPLINE) {
        return lattice_edge * exp2(-float(fiblet_cap(words))) * spline_point(begin_spline(words, first_code(f, words)), 1u);
    }
#endif
#if FEATURE_LATTICE
    if (fiblet_kind(words) != KIND_DIRECTION) {
        uint byte = first_code(f, words), width;
        uvec2 n;
        ivec3 lo;
        lattice_box(words, byte, lo, n, width);
        return lattice_edge * exp2(-float(fiblet_cap(words))) * vec3(lattice_cell(byte, width, lo, n));
    }
#endif
#if FEATURE_DIRECTION
    return step_length(words) * rotated_x(first_frame(fiblet_shape(words)));
#else
    return vec3(0.0);
#endif
}

// Whether the fiblet after this one is drawn as this one is: as one segment, or not. Of one that may be drawn as one segment it is not
// known which of its points are hidden.
bool alike_after(uint f, bool whole) {
    if (ends(f) || f + 1u >= chunk_fiblets) return false;
    bool next = is_one_segment(capsule_of(f + 1u));
#if FEATURE_POINT_MASK
    return !whole && !next;
#else
    return next == whole;
#endif
}

vec3 direction_before(uint f, bool whole) {
    return !whole || f == 0u || begins(f) ? vec3(0.0) : anchor_local(f) - anchor_local(f - 1u);
}

vec3 direction_after(uint f, bool whole) {
    if (ends(f) || f + 1u >= chunk_fiblets) return vec3(0.0);
    if (!whole) return first_segment(f + 1u);
    return ends(f + 1u) ? end_vector(f + 1u) : anchor_local(f + 2u) - anchor_local(f + 1u);
}
