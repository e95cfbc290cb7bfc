// Contents of a fiblet's record (paper: Schertzer et al. 2022, section 3.2.2). The bit fields come from
// pvfiblets/codec/layout.py by way of "codec/layout.glsl", so that a shader cannot disagree with the encoder.

#include "codec/layout.glsl"
#include "fiblets/data/culling.glsl"

#if FEATURE_RANK_TO_ID
// Streamlines by rank stand behind the pages, four a row.
uint id_of_rank(uint rank) {
    uint index = rank - chunk_first_rank;
    return page_words(chunk_pages + (index >> 2))[index & 3u];
}
#endif
#if FEATURE_ANCHORS_LOW
uint anchor_low(uint index) { return bitfieldExtract(anchor_low_word(index >> 1), int(index & 1u) * 16, 16); }
#endif

float difference(uint a, uint b) { return a >= b ? float(a - b) : -float(b - a); }

// First point of fiblet f, in local millimetres.
vec3 anchor_local(uint f) {
    uvec2 words = anchor_words(f);
    uvec3 q = uvec3(fiblet_anchor_x(words), fiblet_anchor_y(words), fiblet_anchor_z(words));
#if FEATURE_ANCHORS_LOW
    q = (q << 16u) | uvec3(anchor_low(3u * f), anchor_low(3u * f + 1u), anchor_low(3u * f + 2u));
    vec3 d = vec3(difference(q.x, reference.x), difference(q.y, reference.y), difference(q.z, reference.z));
#else
    vec3 d = vec3(ivec3(q) - ivec3(reference));
#endif
    precise vec3 p = d * anchor_scale;
    return p;
}

bool begins(uint f) { return fiblet_begin(anchor_words(f)) != 0u; }

bool ends(uint f) { return fiblet_end(anchor_words(f)) != 0u; }

uint rank_of(uint f) { return page_words(f >> FIBLET_PAGE_BITS).x + fiblet_rank(anchor_words(f)); }
