// Which fiblets the pipelines draw that OpenGL's rasteriser draws for. Two-phase culling: the first round draws what the last
// picture showed and what will probably show now, the second all others that nothing drawn so far hides. With the coverage buffer, and without either, there
// is but one round.

#include "culling/criteria.glsl"
#if FEATURE_CULL_PYRAMID || FEATURE_CULL_COVERAGE
#include "culling/occlusion.glsl"
#endif

#if FEATURE_CULL_PYRAMID
#include "culling/visibility_prediction.glsl"

uniform int second_round;
uniform usampler2D seen;  // a texel for each fiblet of all chunks
uniform int seen_bits;    // its width is 2^seen_bits

bool was_seen(uint f) {
    int index = int(chunk_first + f);
    return texelFetch(seen, ivec2(index & ((1 << seen_bits) - 1), index >> seen_bits), 0).x != 0u;
}
#endif

#if FEATURE_OPEN_FIBLETS
#include "fiblets/mesh/open_fiblets.glsl"
#else
bool is_open(uint round, uint f) { return true; }
#endif

bool survives(uint f) {
#if FEATURE_CULL_PYRAMID
    bool second = second_round != 0, before = was_seen(f), likely = is_open(0u, f);
    if (second ? before || !is_open(1u, f) : !before && !likely) return false;
#endif
    Capsule c = capsule_of(f);
    if (outside_view(f, c)) return false;
#if FEATURE_CULL_PYRAMID
    bool first = before || (likely && predicted_visible(c));
    if (first == second || (second && hidden(c))) return false;
#elif FEATURE_CULL_COVERAGE
    if (hidden(c)) return false;
#endif
    return true;
}
