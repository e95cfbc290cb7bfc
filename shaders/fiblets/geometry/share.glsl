// The fiblet of an invocation, and the first segment of its share; SHARE is the number of segments. Leaves the walk at its
// beginning (fiblets/segments/polyline.glsl).

flat in uint shown[];  // fiblets/hardware_raster/survivors.vert

uniform uint shares;

bool begin_share(out uint f, out uint first) {
    uint vertex = shown[0] - 1u;
    f = vertex / shares;
#if FEATURE_WIDE_LINES
    first = (shares - 1u - vertex % shares) * SHARE;  // backwards: of two segments with the same depth the later one stays
#else
    first = vertex % shares * SHARE;
#endif
    if (shown[0] == 0u || first > fiblet_last(decoding_words(f))) return false;
    begin_pixels(f);
    begin_polyline(f);
    return first < polyline.count;
}
