// With atomics of 64 bits: depth key and fiblet of every pixel in one word, the key in its upper half. The
// least word of a pixel is its nearest fiblet, and of several at the same depth the one with the smallest index: ties need no
// thought, and owners no second search.
//
// A ninth storage buffer, but no shader has more than eight. Drivers with these atomics have the bindings.

layout(std430, binding = {{ storage_nearest }}) coherent buffer Nearest { uint64_t nearest[]; };  // row by row

uint pixel_index(ivec2 pixel) { return uint(pixel.y) * uint(viewport.x) + uint(pixel.x); }

uint64_t nearest_word(uint key, uint fiblet) { return (uint64_t(key) << 32) | uint64_t(fiblet); }

uint key_of(uint64_t word) { return uint(word >> 32); }

uint fiblet_of(uint64_t word) { return uint(word); }
