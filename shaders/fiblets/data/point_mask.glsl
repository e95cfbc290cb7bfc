// Mask of kept points (pvfiblets/engine/fiblets/data/filter_textures.py): a bit for each, counted from the chunk's first, 32 to a texel, in
// rows of 2^{{ mask_bits }}. A segment is drawn where both of its points are kept, a streamline of one point where that one is.
//
// Use: begin_point_mask(f) once for a fiblet, whose bits are then at hand. Bit i stands for its point i; behind its last
// stand the next fiblet's, for the segment that joins both, and the one after it. At most
// FIBLET_MAX_POINTS + 2 bits matter: two words.
//
// Without the feature all points are kept, and nothing is left of this file but that.
//
// FEATURE_LINE_ENDS: drawn are the first and the last segment of a streamline only (fiblets/segments/ends.glsl), where the mask keeps them.

#include "fiblets/decode/words.glsl"
#include "fiblets/attributes/streamline_index.glsl"

#if FEATURE_POINT_MASK
uniform usampler2D point_mask;

uint mask_low;        // bits 0..31
uint mask_high;       // bits 32..63
uint mask_segments;   // of the fiblet, the joining one included; 0: a single point
bool mask_before;     // whether the point before the first one is kept, and of this streamline
bool mask_joined;     // whether the streamline goes on after this fiblet

uint mask_word(uint index) {
    return texelFetch(point_mask, ivec2(int(index & ((1u << {{ mask_bits }}) - 1u)), int(index >> {{ mask_bits }})), 0).x;
}

void begin_point_mask(uint f) {
    uint first = first_point_of(f), index = first >> 5u, shift = first & 31u;
    uint a = mask_word(index), b = mask_word(index + 1u), c = mask_word(index + 2u);
    mask_low = shift == 0u ? a : (a >> shift) | (b << (32u - shift));
    mask_high = shift == 0u ? b : (b >> shift) | (c << (32u - shift));
    mask_joined = !ends(f);
    mask_segments = fiblet_last(decoding_words(f)) + (mask_joined ? 1u : 0u);
    // In an earlier chunk: kept, as far as anybody can tell here.
    mask_before = !begins(f) && (first == 0u || ((mask_word((first - 1u) >> 5u) >> ((first - 1u) & 31u)) & 1u) != 0u);
}

// Segments, a bit each: both points kept.
uvec2 mask_pairs() {
    uint low = mask_low & ((mask_low >> 1u) | (mask_high << 31u)), high = mask_high & (mask_high >> 1u), n = mask_segments;
    if (n == 0u) return uvec2(mask_low & 1u, 0u);
    return uvec2(n >= 32u ? low : low & ((1u << n) - 1u), n <= 32u ? 0u : high & ((1u << (n - 32u)) - 1u));
}

bool any_point_shown() { return mask_pairs() != uvec2(0u); }

bool all_points_shown() {
    uint n = max(mask_segments, 1u);
    return mask_pairs() == uvec2(n >= 32u ? 0xFFFFFFFFu : (1u << n) - 1u, n <= 32u ? 0u : (1u << (n - 32u)) - 1u);
}

bool point_bit(uint i) { return (((i < 32u ? mask_low : mask_high) >> (i & 31u)) & 1u) != 0u; }

// Whether the segment before or after the fiblet's is hidden: its line starts, or ends, with the fiblet.
bool cut_beside(uint f) { return !begins(f) && !mask_before || mask_joined && !point_bit(mask_segments + 1u); }

// Whether segment i is drawn; where a neighbour is not, the line starts or ends here.
bool mask_segment(uint i, inout bool start, inout bool cap) {
    bool here = point_bit(i);
#if FEATURE_LINE_ENDS
    return (start || cap) && here && (mask_segments == 0u || point_bit(i + 1u));
#else
    start = start || !here || (i == 0u ? !mask_before : !point_bit(i - 1u));
    if (mask_segments == 0u) return here;
    bool there = point_bit(i + 1u), last = i + 1u >= mask_segments;
    cap = cap || !there || ((!last || mask_joined) && !point_bit(i + 2u));
    return here && there;
#endif
}

#else
void begin_point_mask(uint f) {}
bool all_points_shown() { return true; }
#if FEATURE_LINE_ENDS
bool mask_segment(uint i, inout bool start, inout bool cap) { return start || cap; }
#else
bool mask_segment(uint i, inout bool start, inout bool cap) { return true; }
#endif
#endif
