// Distribution of a round's fiblets to work groups.
//
// A group of {{ group_size }} invocations takes that number of entries of its class's list: only the last group has idle lanes. If the list was too
// short for the fiblets, there are many: then a group serves {{ group_words }} words of bits, and invocation t takes the set bits number t,
// t + {{ group_size }}, ...

#include "frame/groups.glsl"
#include "fiblets/compute/nth_bit.glsl"

const uint NO_FIBLET = 0xFFFFFFFFu;

uniform uint part;  // class of fiblets

// The k-th fiblet of this group, or NO_FIBLET.
uint nth_fiblet(uint k) {
    uint count = visibility_bits[length_at(part)], group = group_index();
    if (count <= list_room()) {
        uint entry = group * gl_WorkGroupSize.x + k;
        return k < gl_WorkGroupSize.x && entry < count ? visibility_bits[list_at(part) + entry] : NO_FIBLET;
    }
    uint word = group * {{ group_words }}u, end = min(word + {{ group_words }}u, chunk_words());
    for (; word < end; ++word) {
        uint bits = in_round(word) & of_class(word, part), here = uint(bitCount(bits));
        if (k < here) return word * 32u + nth_bit(bits, k);
        k -= here;
    }
    return NO_FIBLET;
}
