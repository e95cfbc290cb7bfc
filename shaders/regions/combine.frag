// Boundaries of a pixel (regions/boundaries.glsl), from the first of this pass: all leaves' crossings along
// the ray in ascending order; the ones where the region's expression changes are boundaries.
//
// Written for one form of region, that is, for its kinds of leaves and its expression, and for a number of layers: numbers
// of leaves are constants once loops are unrolled, and their rows lie at known places.
//
// Where a pixel has more boundaries than there are layers at all, OVERFLOW stands last.
//
// FEATURE_PEEL: closed surfaces are among the leaves, with their crossings in layers (regions/surfaces.glsl).

#version 430

#include "regions/rays.glsl"
#include "regions/surfaces.glsl"

uniform int first;  // number of the first boundary to give
uniform int room;   // for boundaries in all layers

const int OUTPUTS = {{ outputs }};  // layers drawn at once

layout(location = 0) out vec4 layer_0;
#if {{ outputs }} > 1
layout(location = 1) out vec4 layer_1;
#endif
#if {{ outputs }} > 2
layout(location = 2) out vec4 layer_2;
layout(location = 3) out vec4 layer_3;
#endif
#if {{ outputs }} > 4
layout(location = 4) out vec4 layer_4;
layout(location = 5) out vec4 layer_5;
layout(location = 6) out vec4 layer_6;
layout(location = 7) out vec4 layer_7;
#endif

const int LEAVES = {{ leaves }};
const int KINDS[LEAVES] = int[LEAVES]({{ kinds }});
const int PLANES[LEAVES] = int[LEAVES]({{ planes }});  // that make a leaf
const float NO_MORE = 2.0;
const float OVERFLOW = -9.0;  // as in overflow.frag

vec2 spans[LEAVES];
#if FEATURE_PEEL
SurfaceHere surfaces[LEAVES];
#endif

#define LEAF(k) (((leaves >> k) & 1u) == 1u)
bool holds(uint leaves) { return {{ expression }}; }

// Bits of the leaves that hold z; `next` is the nearest crossing of any leaf beyond z.
uint leaves_at(float z, out float next) {
    uint bits = 0u;
    next = NO_MORE;
    for (int k = 0; k < LEAVES; ++k) {
        bool inside;
#if FEATURE_PEEL
        if (KINDS[k] == RAYS_SURFACE) {
            inside = surface_holds(k, surfaces[k], ivec2(gl_FragCoord.xy), z, next);
        } else
#endif
        {
            vec2 span = spans[k];
            inside = span.x <= z && z < span.y;
            next = min(next, span.x > z ? span.x : span.y > z ? span.y : NO_MORE);
        }
        bits |= inside ? 1u << uint(k) : 0u;
    }
    return bits;
}

void main() {
    for (int k = 0; k < LEAVES; ++k) {
        if (KINDS[k] == RAYS_PLANES) spans[k] = rays_planes(k, PLANES[k], gl_FragCoord.xy);
        else if (KINDS[k] == RAYS_SPHERE) spans[k] = rays_sphere(k, gl_FragCoord.xy);
#if FEATURE_PEEL
        else surfaces[k] = surface_at(k, ivec2(gl_FragCoord.xy));
#endif
    }
    vec4 boundaries[OUTPUTS];
    for (int i = 0; i < OUTPUTS; ++i) boundaries[i] = vec4(NO_MORE);
    float z = 0.0, next;  // what begins before the near plane, begins there
    int place = -first;
    bool kept = holds(leaves_at(z, next));
    if (kept) {
        if (place == 0) boundaries[0].x = -1.0;
        ++place;
    }
    while (next <= 1.0 && place < 4 * OUTPUTS) {
        z = next;
        bool now = holds(leaves_at(z, next));
        if (now == kept) continue;
        kept = now;
        for (int i = 0; i < OUTPUTS; ++i) {
            boundaries[i] = mix(boundaries[i], vec4(z), equal(ivec4(place - 4 * i), ivec4(0, 1, 2, 3)));
        }
        ++place;
    }
    if (room - first == 4 * OUTPUTS && place == 4 * OUTPUTS && next <= 1.0) boundaries[OUTPUTS - 1].w = OVERFLOW;
    layer_0 = boundaries[0];
#if {{ outputs }} > 1
    layer_1 = boundaries[1];
#endif
#if {{ outputs }} > 2
    layer_2 = boundaries[2];
    layer_3 = boundaries[3];
#endif
#if {{ outputs }} > 4
    layer_4 = boundaries[4];
    layer_5 = boundaries[5];
    layer_6 = boundaries[6];
    layer_7 = boundaries[7];
#endif
}
