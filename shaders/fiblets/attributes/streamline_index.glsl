// The streamline of a fiblet, and the number of its points before the fiblet.
//
// Records hold no index along the streamline: the fiblets of a streamline are consecutive and ranks never fall, so the
// first one is found by doubling steps backwards and halving them again, and the difference of both first points is
// the answer. Most streamlines take three loads or fewer.

uint streamline_of(uint f) {
    uint rank = rank_of(f);
#if FEATURE_RANK_TO_ID
    return id_of_rank(rank);
#else
    return rank;
#endif
}

// First point of fiblet f, counted from the chunk's first.
uint first_point_of(uint f) { return page_words(f >> FIBLET_PAGE_BITS).z + fiblet_point(decoding_words(f)); }

uint points_before(uint f) {
    if (begins(f)) return 0u;
    uint rank = rank_of(f), stride = 1u, high = f;  // `high` has this rank
    while (high > 0u) {
        uint low = high - min(stride, high);
        if (rank_of(low) == rank) { high = low; stride <<= 1u; }
        else {
            // the first fiblet of the streamline lies in (low, high]
            while (high - low > 1u) {
                uint middle = (low + high) >> 1u;
                if (rank_of(middle) == rank) high = middle;
                else low = middle;
            }
            break;
        }
    }
    uint before = begins(high) ? 0u : chunk_points_before;  // begun in an earlier chunk
    return first_point_of(f) - first_point_of(high) + before;
}
