// To which sum of its pixel a line adds: without FEATURE_GATHER_SLICES there is one, of all lines. Else the nearest line is in
// none, and the others are sorted by the depths at which slices begin (fiblets/gather/slice_keys.frag).
//
//   slice_keys   depth keys of the nearest line, and of where the second, the third and the fourth slice begin

#if FEATURE_GATHER_SLICES
#if FEATURE_TEXTURE_DATA || FEATURE_PER_PRIMITIVE
uniform usampler2D slice_keys;
uniform usampler2D nearest_owner;
uvec4 keys_of(ivec2 pixel) { return texelFetch(slice_keys, pixel, 0); }
uint owner_of(ivec2 pixel) { return texelFetch(nearest_owner, pixel, 0).x; }
#else
layout(rgba32ui, binding = {{ image_slice_keys }}) readonly uniform uimage2D slice_keys;
layout(r32ui, binding = {{ image_nearest_owner }}) readonly uniform uimage2D nearest_owner;
uvec4 keys_of(ivec2 pixel) { return imageLoad(slice_keys, pixel); }
uint owner_of(ivec2 pixel) { return imageLoad(nearest_owner, pixel).x; }
#endif
#endif
#if FEATURE_GATHER_OUTSIDE
uniform usampler2D outside_depth;  // of what hides lines, keys
#endif

// -1: to none.
int slice_of(ivec2 pixel, uint key, uint owner) {
#if FEATURE_GATHER_OUTSIDE
    if (key > texelFetch(outside_depth, pixel, 0).x) return -1;
#endif
#if FEATURE_GATHER_SLICES
    uvec4 keys = keys_of(pixel);
    if (key == keys.x && owner == owner_of(pixel)) return -1;
    return int(key >= keys.y) + int(key >= keys.z) + int(key >= keys.w);
#else
    return 0;
#endif
}
