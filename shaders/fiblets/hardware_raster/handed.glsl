// The streamline of a fiblet, and the index of its first point, where fragments are handed them (fiblets/hardware_raster/varyings.glsl).

#include "fiblets/attributes/streamline_index.glsl"

uint handed_streamline(uint f) {
#if FEATURE_PAINTED || FEATURE_WIDE_LINES && (FEATURE_PEEL || FEATURE_GATHER_SLICES)
    return streamline_of(f);
#else
    return 0u;
#endif
}

float handed_first(uint f) {
#if FEATURE_WIDE_LINES && (FEATURE_PEEL || FEATURE_GATHER_SLICES)
    return float(points_before(f));
#else
    return 0.0;
#endif
}
