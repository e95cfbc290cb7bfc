// Four boundaries of a pixel (regions/boundaries.glsl), from the first that this pass is to give on: all leaves' crossings
// along the ray in ascending order, of which those are boundaries where the region's expression turns.
//
// Written for one form of region, that is, for its kinds of leaves and its expression: numbers of leaves are constants once
// loops are unrolled, and their rows lie at known places.
//
// FEATURE_PEEL: closed surfaces are among the leaves, with their crossings in layers (regions/surfaces.glsl).

#version 430

#include "regions/rays.glsl"
#include "regions/surfaces.glsl"

uniform int first;  // number of the first boundary to give

out vec4 boundaries;

const int LEAVES = {{ leaves }};
const int KINDS[LEAVES] = int[LEAVES]({{ kinds }});
const int PLANES[LEAVES] = int[LEAVES]({{ planes }});  // of which a leaf is made
const float NO_MORE = 2.0;

vec2 spans[LEAVES];

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
            inside = surface_holds(k, ivec2(gl_FragCoord.xy), z, next);
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
    }
    float z = 0.0, next;  // what begins before the near plane, begins there
    boundaries = vec4(NO_MORE);
    int place = -first;
    bool kept = holds(leaves_at(z, next));
    if (kept) {
        if (place == 0) boundaries.x = -1.0;
        ++place;
    }
    while (next <= 1.0 && place < 4) {
        z = next;
        bool now = holds(leaves_at(z, next));
        if (now == kept) continue;
        kept = now;
        boundaries = mix(boundaries, vec4(z), equal(ivec4(place), ivec4(0, 1, 2, 3)));
        ++place;
    }
}
