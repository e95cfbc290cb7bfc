// What the passes of one picture tell each other about fiblets, in one buffer, because OpenGL promises no more than eight
// storage buffers to a shader: {{ visibility_words }} words for 32 fiblets, a bit for each; behind them, lists of those groups of 32 that have
// something to draw; behind these, the lists' lengths as the arguments of indirect dispatches.
//
//   words 0..3   plan: seen in the last picture. By class: inside the view volume, crossing its sides, crossing more;
//                and, inside, those drawn as one segment
//   words 4..7   plan: not seen in it, but probably not hidden; the same four classes
//   words 8..11  plan: the others
//   word 12      candidates: came nearest in some pixel, or tied
//   word 13      seen: may own a pixel
//   word 14      tied: wrote a pixel that another fiblet may have written too; before that, of the others: not hidden
//
// Lists: of each class, as many words as there are groups of 32, a chunk's at its own first. Arguments: of each round of
// drawing, chunk and class, four words: work groups along x and y, 1, length of the list.

layout(std430, binding = {{ storage_visibility_bits }}) buffer VisibilityBits { uint visibility_bits[]; };

const uint WORDS = {{ visibility_words }}u, CLASSES = 4u, PREDICTED = 4u, REST = 8u, CANDIDATES = 12u, SEEN = 13u, TIED = 14u, KEPT = TIED;

// What a pass works on: the plan's three parts, candidates, fiblets whose pixels are to be written again, or those of the
// rest that refine.comp tests. pvfiblets/engine/fiblets/pipelines/compute.py numbers them the same.
const uint DRAW_SEEN = 0u, DRAW_PREDICTED = 1u, DRAW_REST = 2u, DRAW_CANDIDATES = 3u, DRAW_TIED = 4u, TEST_REST = 5u;

uniform uint drawing;          // which of these
uniform uint list_base;        // where lists start
uniform uint list_length;      // groups of 32 in all chunks
uniform uint argument_base;    // where the arguments of this round start

uint visibility_word(uint word, uint part) { return visibility_bits[word * WORDS + part]; }

// Fiblets of a class that are in the plan.
uint planned(uint word, uint which) {
    return visibility_word(word, which) | visibility_word(word, PREDICTED + which) | visibility_word(word, REST + which);
}

// Of a class, those fiblets that the passes after the first draw.
uint taken_again(uint word, uint which) {
    return visibility_word(word, drawing == DRAW_CANDIDATES ? CANDIDATES : TIED) & planned(word, which);
}

// Where entry k of a class's list stands; `before`: groups of 32 in earlier chunks.
uint list_entry(uint which, uint before, uint k) { return list_base + which * list_length + before + k; }

// Where the arguments of a chunk's class start.
uint argument_of(uint chunk, uint which) { return argument_base + 4u * (chunk * CLASSES + which); }
