// Visibility bits and draw lists that the passes of one picture share, for a chunk's fiblets, in one buffer, because OpenGL promises no more than
// eight storage buffers to a shader. Each chunk has a range of its own, so that no driver's limit of a block limits the set.
//
//   bits         {{ visibility_words }} kinds, of each a word for 32 fiblets
//     ROUND_LOW, ROUND_HIGH   plan: the round of drawing, 1 and up; 0: not drawn. 1: seen in the last picture, 2: not seen in it,
//                             but probably not hidden, 3: the others
//     CLASS_LOW, CLASS_HIGH   plan: the class (fiblets/compute/cull.comp)
//     CANDIDATES   came nearest in some pixel, or tied
//     SEEN         may own a pixel
//     TIED         wrote a pixel that another fiblet may have written too; before that, of the others: not hidden (KEPT)
//   lists        of each class, the fiblets that a round has to draw: one in {{ list_share }} of the chunk's at most
//   lengths      of the lists, by round and class. One of more fiblets than fit is not used: groups go through the bits
//   arguments    of indirect dispatches, four words each, by round, class and slot. A slot is as much as one dispatch may draw

#include "uniforms/Chunk.glsl"

layout(std430, binding = {{ storage_visibility_bits }}) buffer VisibilityBits { uint visibility_bits[]; };

const uint KINDS = {{ visibility_words }}u, CLASSES = {{ classes }}u, ROUNDS = {{ rounds }}u;
const uint ROUND_LOW = 0u, ROUND_HIGH = 1u, CLASS_LOW = 2u, CLASS_HIGH = 3u, CANDIDATES = 4u, SEEN = 5u, TIED = 6u, KEPT = TIED;

// The lists of the passes: the plan's three rounds, candidates, fiblets whose pixels are to be written again, and the rest
// that refine.comp tests. Two more list clusters. pvfiblets/engine/fiblets/pipelines/compute.py numbers them the same.
const uint DRAW_SEEN = 0u, DRAW_PREDICTED = 1u, DRAW_REST = 2u, DRAW_CANDIDATES = 3u, DRAW_TIED = 4u, TEST_REST = 5u;  // 6, 7: of clusters

uniform uint drawing;          // which of these

uint chunk_words() { return (chunk_fiblets + 31u) >> 5; }

uint mark_at(uint kind, uint word) { return kind * chunk_words() + word; }

uint marks(uint kind, uint word) { return visibility_bits[mark_at(kind, word)]; }

void set_marks(uint kind, uint word, uint bits) { visibility_bits[mark_at(kind, word)] = bits; }

void mark(uint kind, uint f) { atomicOr(visibility_bits[mark_at(kind, f >> 5)], 1u << (f & 31u)); }

// Fiblets that are in the plan.
uint planned(uint word) { return marks(ROUND_LOW, word) | marks(ROUND_HIGH, word); }

// Fiblets of a round.
uint in_round(uint word) {
    if (drawing == DRAW_CANDIDATES) return marks(CANDIDATES, word) & planned(word);
    if (drawing == DRAW_TIED) return marks(TIED, word) & planned(word);
    uint low = marks(ROUND_LOW, word), high = marks(ROUND_HIGH, word);
    return drawing == DRAW_SEEN ? low & ~high : drawing == DRAW_PREDICTED ? high & ~low : low & high;
}

uint of_class(uint word, uint which) {
    uint low = marks(CLASS_LOW, word), high = marks(CLASS_HIGH, word);
    return ((which & 1u) != 0u ? low : ~low) & ((which & 2u) != 0u ? high : ~high);
}

uint list_room() { return (chunk_fiblets + {{ list_share }}u - 1u) / {{ list_share }}u; }

// Start of a class's list.
uint list_at(uint which) { return KINDS * chunk_words() + which * list_room(); }

// Place of a class's length in this round.
uint length_at(uint which) { return list_at(CLASSES) + drawing * CLASSES + which; }

// Start of all arguments, and of the arguments of a class in this round.
uint all_arguments_at() { return list_at(CLASSES) + ROUNDS * CLASSES; }
uint arguments_at(uint which, uint slots) { return all_arguments_at() + 4u * (drawing * CLASSES + which) * slots; }
