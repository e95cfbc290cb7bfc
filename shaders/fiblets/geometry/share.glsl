// The fiblet of an invocation, and the first segment of its share; SHARE is the number of segments. Leaves the walk at its
// beginning (fiblets/segments/polyline.glsl).

#include "fiblets/hardware_raster/handed.glsl"

flat in uint shown[];  // fiblets/hardware_raster/survivors.vert

uniform uint shares;

#if FEATURE_CLIPPING && !FEATURE_WIDE_LINES
flat in uint uncut[];
#endif

// One of a fiblet's shares has all segments where none can be cut: they share vertices.
bool begin_share(out uint f, out uint first, out uint end) {
    uint vertex = shown[0] - 1u;
    f = vertex / shares;
#if FEATURE_WIDE_LINES
    first = (shares - 1u - vertex % shares) * SHARE;  // backwards: of two segments with the same depth the later one stays
#else
    first = vertex % shares * SHARE;
#endif
    end = first + SHARE;
#if FEATURE_CLIPPING && !FEATURE_WIDE_LINES
    if (uncut[0] != 0u) {
        if (first > 0u) return false;
        end = FIBLET_MAX_POINTS;
    }
#endif
    if (shown[0] == 0u || first > fiblet_last(decoding_words(f))) return false;
    begin_values(f);
    begin_polyline(f);
    end = min(end, polyline.count);
    return first < polyline.count;
}
