// Of each round of two-phase culling a bit for every fiblet of the chunk: whether its cluster may show. Bits, not lists, because the task stage
// takes fiblets in the order of coding: of two at the same depth the first that is drawn stays.

layout(std430, binding = {{ storage_open_fiblets }}) buffer OpenFiblets { uint open_fiblets[]; };

uint open_word(uint round, uint f) { return round * ((chunk_fiblets + 31u) >> 5) + (f >> 5); }

bool is_open(uint round, uint f) { return (open_fiblets[open_word(round, f)] >> (f & 31u) & 1u) != 0u; }
