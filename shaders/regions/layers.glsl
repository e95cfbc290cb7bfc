// Crossings of a pixel's ray with closed surfaces, as pvfiblets/engine/regions/surface_crossings.py has drawn them (regions/peel.frag).
//
// Symbols
//   layer j      of a surface: its outermost crossings without the layers before; even layers lie in one texture
//                array, odd ones in the other, so that none is read while the same array is drawn into
//   ends         (-nearest front, farthest front, -nearest back, count of fragments: front + 4096 back)
//   end          farthest back; LAYERS_NONE where there is none
//   winding      number about the ray's position. Beyond all crossings it is 0, and it falls by 1 where the ray leaves
//                through a back face; so at the near plane it is the number of back faces less that of front faces.
//
// Where faces coincide, a depth stands for several fragments: `tallies` then counts them, front nearest, front farthest, back
// nearest, back farthest.

#if FEATURE_PEEL
uniform sampler2DArray layers_even, layers_even_end, layers_odd, layers_odd_end, tallies;

const float LAYERS_NONE = -3.0;
const float LAYERS_BEYOND = 3.0;
const float LAYERS_BACK = 4096.0;

// Fragments of front and of back faces.
ivec2 layers_counts(float count) {
    int whole = int(count), base = int(LAYERS_BACK);
    return ivec2(whole % base, whole / base);
}

// Nearest and farthest front, nearest and farthest back; the farthest is LAYERS_NONE where it is the nearest or there is none.
vec4 layers_ends(vec4 ends, float end) {
    vec4 depths = vec4(-ends.x, ends.y, -ends.z, end);
    if (depths.x == depths.y) depths.y = LAYERS_NONE;
    if (depths.z == depths.w) depths.w = LAYERS_NONE;
    return depths;
}

// 1 for each depth that there is.
ivec4 layers_there(vec4 depths) { return ivec4(greaterThan(depths, vec4(0.0))) * ivec4(lessThan(depths, vec4(2.0))); }

// The first layer of a surface, which is always an even one.
void layers_first(ivec3 at, out vec4 ends, out float end) {
    ivec3 place = ivec3(at.xy, at.z >> 1);
    ends = texelFetch(layers_even, place, 0);
    end = texelFetch(layers_even_end, place, 0).x;
}

void layers_fetch(ivec3 at, out vec4 ends, out float end) {
    ivec3 place = ivec3(at.xy, at.z >> 1);
    if ((at.z & 1) == 0) {
        ends = texelFetch(layers_even, place, 0);
        end = texelFetch(layers_even_end, place, 0).x;
    } else {
        ends = texelFetch(layers_odd, place, 0);
        end = texelFetch(layers_odd_end, place, 0).x;
    }
}
#endif
