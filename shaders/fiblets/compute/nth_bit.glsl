// Finds one of the bits that are set in a word.

// Index of the k-th set bit of word: halves the word five times.
uint nth_bit(uint word, uint k) {
    uint at = 0u;
    for (uint width = 16u; width > 0u; width >>= 1u) {
        uint below = uint(bitCount(bitfieldExtract(word, int(at), int(width))));
        if (k >= below) { k -= below; at += width; }
    }
    return at;
}
