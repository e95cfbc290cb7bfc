// Mask of kept streamlines (pvfiblets/engine/fiblets/data/filter_textures.py): a bit for each by rank, 32 to a texel, in rows of
// 2^{{ mask_bits }}.

#if FEATURE_STREAMLINE_MASK
uniform usampler2D streamline_mask;

bool streamline_shown(uint f) {
    uint rank = rank_of(f), index = rank >> 5u;
    ivec2 at = ivec2(int(index & ((1u << {{ mask_bits }}) - 1u)), int(index >> {{ mask_bits }}));
    return ((texelFetch(streamline_mask, at, 0).x >> (rank & 31u)) & 1u) != 0u;
}
#endif
