// Asks questions about fiblets, whose answers are kept 32 to a word. The including pass defines
//   uint asked(uint word)     which fiblets of a word it asks about
//   uint answers(uint f)      up to four answers about a fiblet, a bit each
//
// Use: all invocations call find_answers(); where it returns true, the invocation goes on with `word`: answer k of its fiblets is answered[k].
//
// An invocation asks about the 32 fiblets of its word. FEATURE_PER_FIBLET: about one at a time, so that neighbours read neighbours;
// a work group has {{ group_words }} words. Graphics cards take that form; software OpenGL pays more for the barriers than it gains.
// FEATURE_CLUSTERS: of most words no fiblet is asked about, and reading these is all there is to do.

#include "frame/groups.glsl"
#include "fiblets/compute/visibility_bits.glsl"

uint asked(uint word);
uint answers(uint f);

uint word;
uvec4 answered;

#if FEATURE_PER_FIBLET && !FEATURE_CLUSTERS
shared uint collected[{{ group_words }}][4];

bool find_answers() {
    const uint WORDS = {{ group_words }}u;
    uint thread = gl_LocalInvocationIndex, first = group_index() * WORDS;
    for (uint i = thread; i < 4u * WORDS; i += gl_WorkGroupSize.x) collected[i >> 2][i & 3u] = 0u;
    barrier();
    for (uint i = thread; i < 32u * WORDS; i += gl_WorkGroupSize.x) {
        uint at = first + (i >> 5), bit = 1u << (i & 31u);
        if (at >= chunk_words() || (asked(at) & bit) == 0u) continue;
        uint found = answers(32u * first + i);
        for (uint k = 0u; k < 4u; ++k) {
            if ((found >> k & 1u) != 0u) atomicOr(collected[i >> 5][k], bit);
        }
    }
    barrier();
    word = first + thread;
    if (thread >= WORDS || word >= chunk_words()) return false;
    answered = uvec4(collected[thread][0], collected[thread][1], collected[thread][2], collected[thread][3]);
    return true;
}
#else
bool find_answers() {
    word = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (word >= chunk_words()) return false;
    answered = uvec4(0u);
    for (uint rest = asked(word); rest != 0u; rest &= rest - 1u) {
        uint i = uint(findLSB(rest));
        answered |= (uvec4(answers(32u * word + i)) >> uvec4(0u, 1u, 2u, 3u) & 1u) << i;
    }
    return true;
}
#endif
