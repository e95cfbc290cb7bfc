// One bit per fiblet, and how a work group shares out the fiblets whose bit is set.
//
// A group of {{ group_size }} invocations serves {{ group_words }} entries of a list of groups of 32 fiblets. Invocation t takes the set bits
// number t, t + {{ group_size }}, ...: lanes stay full however few fiblets a cull left over.
//
// The including pass defines bits_of(word), `word` counted over all chunks

#include "frame/groups.glsl"
#include "fiblets/compute/nth_bit.glsl"

const uint NO_FIBLET = 0xFFFFFFFFu;

uniform uint part;  // class of fiblets

uint bits_of(uint word);

// The k-th fiblet of this group, or NO_FIBLET.
uint nth_fiblet(uint k) {
    uint before = chunk_first >> 5u, entry = group_index() * {{ group_words }}u;
    uint end = min(entry + {{ group_words }}u, visibility_bits[argument_of(chunk_number, part) + 3u]);
    for (; entry < end; ++entry) {
        uint word = visibility_bits[list_entry(part, before, entry)];
        uint bits = bits_of(before + word), here = uint(bitCount(bits));
        if (k < here) return word * 32u + nth_bit(bits, k);
        k -= here;
    }
    return NO_FIBLET;
}
