// One bit per fiblet, and how a work group shares out the fiblets whose bit is set.
//
// A group of {{ group_size }} invocations serves {{ group_words }} * 32 consecutive fiblets. Invocation t takes the set bits number
// t, t + {{ group_size }}, ...: lanes stay full however few fiblets a cull left over, with no list, no counter and no barrier.
//
// The including pass defines, before it includes this: uint bits_of(uint word), `word` counted over all chunks

const uint NO_FIBLET = 0xFFFFFFFFu;

// Index of the k-th set bit of word: halves the word five times.
uint nth_bit(uint word, uint k) {
    uint at = 0u;
    for (uint width = 16u; width > 0u; width >>= 1u) {
        uint below = uint(bitCount(bitfieldExtract(word, int(at), int(width))));
        if (k >= below) { k -= below; at += width; }
    }
    return at;
}

// The k-th fiblet of this group, or NO_FIBLET.
uint nth_fiblet(uint k) {
    uint word = group_index() * {{ group_words }}u, words = (chunk.x + 31u) >> 5u, before = chunk.y >> 5u;
    uint end = min(word + {{ group_words }}u, words);
    for (; word < end; ++word) {
        uint bits = bits_of(before + word), here = uint(bitCount(bits));
        if (k < here) return word * 32u + nth_bit(bits, k);
        k -= here;
    }
    return NO_FIBLET;
}
