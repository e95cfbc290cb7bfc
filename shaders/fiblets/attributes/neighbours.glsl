// Where a streamline comes from before a fiblet, and where it goes after it: directions of any length, for the tangents at the
// fiblet's ends (fiblets/attributes/tangent.glsl). None where the streamline begins or ends, and where the neighbour lies in
// another chunk.
//
// From far enough all fiblets of a streamline are one segment (culling/bounds.glsl): `whole` asks for those segments.

#include "fiblets/decode/words.glsl"
#include "culling/bounds.glsl"

// Of the first segment that has a length, as the fiblet itself decodes it.
vec3 first_direction(uint f) {
    if (f >= chunk.x) return vec3(0.0);
    uvec3 words = decoding_words(f);
    uint last = fiblet_last(words);
#if FEATURE_DIRECTION
    if (last > 0u && fiblet_kind(words) == KIND_DIRECTION) return rotated_x(first_frame(fiblet_shape(words)));
#endif
#if FEATURE_LATTICE
    if (last > 0u && fiblet_kind(words) != KIND_DIRECTION) {
        uint byte = first_code(f, words), width;
        uvec2 n;
        ivec3 lo;
        lattice_box(words, byte, lo, n, width);
        for (uint i = 0u; i < last; ++i) {
            ivec3 cell = lattice_cell(byte + i * width, width, lo, n);
            if (cell != ivec3(0)) return vec3(cell);
        }
    }
#endif
    return ends(f) ? vec3(0.0) : anchor_local(f + 1u) - anchor_local(f);
}

vec3 direction_before(uint f, bool whole) {
    if (!whole || f == 0u || begins(f)) return vec3(0.0);
    return anchor_local(f) - anchor_local(f - 1u);
}

vec3 direction_after(uint f, bool whole) {
    if (ends(f)) return vec3(0.0);
    if (!whole) return first_direction(f + 1u);
    if (f + 1u >= chunk.x) return vec3(0.0);
    return ends(f + 1u) ? end_vector(f + 1u) : anchor_local(f + 2u) - anchor_local(f + 1u);
}
