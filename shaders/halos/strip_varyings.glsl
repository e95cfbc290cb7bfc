// What a strip's vertices hand to its fragments only where it is asked for (halos/varyings.glsl): the part of the segment that is
// drawn, the share of depth cueing, the mask of tapered ends, the number that filters.

#if FEATURE_HALO_FILTER
uniform samplerBuffer filter_texels;

// How much the number changes per mm along a segment; x: that, y: 1, or both 0 where it is not known.
vec2 slope(float from, float to, vec3 way) {
    float s = abs(to - from) / length(way);
    return s < 3e38 ? vec2(s, 1.0) : vec2(0.0);
}

// The number at a vertex and its mean change per mm over the segments that meet there; one has a number other at its end.
vec2 filter_at(int vertex, vec3 here, float other, vec3 there, int next) {
    float a = texelFetch(filter_texels, vertex).x;
    vec2 slopes = slope(a, other, there - here);
    if (next != vertex) slopes += slope(a, texelFetch(filter_texels, next).x, local_place(next) - here);
    return vec2(a, slopes.x / max(slopes.y, 1.0));
}
#endif

void clear_optional_varyings() {
#if FEATURE_HALO_CUT
    varying_part = vec2(0.0);
#endif
#if FEATURE_HALO_TAPER
    varying_mask = vec2(0.0);
#endif
#if FEATURE_HALO_CUE
    varying_cue = vec2(0.0);
#endif
#if FEATURE_HALO_FILTER
    varying_filter = vec4(0.0);
#endif
}

// before, after: whether segments go on at the start and at the end.
void write_optional_varyings(int segment, vec3 start, vec3 stop, vec2 part, vec2 cue, bool before, bool after) {
#if FEATURE_HALO_CUT
    varying_part = part;
#endif
#if FEATURE_HALO_CUE
    varying_cue = cue;
#endif
#if FEATURE_HALO_TAPER
    vec2 u = vec2(float(texelFetch(mask_texels, segment).x), float(texelFetch(mask_texels, segment + 1).x)) / float(LAST);
    varying_mask = cut(u.x, u.y, part);
#endif
#if FEATURE_HALO_FILTER
    float number = texelFetch(filter_texels, segment).x, number_after = texelFetch(filter_texels, segment + 1).x;
    vec2 f0 = filter_at(segment, start, number_after, stop, before ? segment - 1 : segment);
    vec2 f1 = filter_at(segment + 1, stop, number, start, after ? segment + 2 : segment + 1);
    varying_filter = vec4(cut(f0.x, f1.x, part), cut(f0.y, f1.y, part));
#endif
}
