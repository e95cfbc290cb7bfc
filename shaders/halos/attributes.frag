// What each pixel shows of the segment or point that won it: the textures of pvfiblets/engine/gbuffer.py.
//
// Pixels that show nothing do not come here (screen/near.vert). Halos have a depth and belong to nothing.

#version 430

#include "halos/vertices.glsl"
#include "codec/layout.glsl"
#include "frame/tangent.glsl"

uniform usampler2D hits;
uniform sampler2D depths;
#if !FEATURE_HALO_POINTS
uniform usamplerBuffer offset_texels;    // of each line's first vertex, and the number of all
uniform int lines;
#endif
#if FEATURE_HALO_VALUES
uniform samplerBuffer value_texels;
#endif
#if FEATURE_HALO_COLOURS
uniform usamplerBuffer colour_texels;
#endif

layout(location = 0) out uint out_depth;
layout(location = 1) out uint out_owner;
layout(location = 2) out uvec2 out_ids;
layout(location = 3) out vec2 out_position;
layout(location = 4) out float out_ink;
#if FEATURE_HALO_COLOURS
layout(location = 5) out vec4 out_colour;
#endif

#if !FEATURE_HALO_POINTS
// The last line that begins at a vertex or before it: those without vertices begin where the next one does.
int line_of(int vertex) {
    int low = 0, high = lines;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (int(texelFetch(offset_texels, middle).x) <= vertex) low = middle;
        else high = middle;
    }
    return low;
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec2 hit = texelFetch(hits, pixel, 0).xy;
    float far = texelFetch(depths, pixel, 0).x;
    int item = int(hit.x);
    float t = float(hit.y >> 16u) / 65535.0;
    out_depth = 0xFFFFFFFFu - uint(clamp(far * 4294967296.0, 1.0, 4294967040.0));
    out_owner = (hit.y & 1u) != 0u ? hit.x : 0xFFFFFFFFu;
    out_ink = float(hit.y >> 8u & 0xFFu) / 255.0;
#if FEATURE_HALO_POINTS
    int other = item;
    out_ids = uvec2(hit.x, packed_tangent(vec3(0.0), 0u));
    out_position = vec2(float(item), 0.0);
#else
    int other = item + 1, line = line_of(item);
    out_ids = uvec2(uint(line), packed_tangent(local_place(other) - local_place(item), 0u));
    out_position = vec2(float(item - int(texelFetch(offset_texels, line).x)) + t, 0.0);
#endif
#if FEATURE_HALO_VALUES
    out_position.y = mix(texelFetch(value_texels, item).x, texelFetch(value_texels, other).x, t);
#endif
#if FEATURE_HALO_COLOURS
    out_colour = mix(unpackUnorm4x8(texelFetch(colour_texels, item).x), unpackUnorm4x8(texelFetch(colour_texels, other).x), t);
#endif
}
